"""Runs one code once and says how fast it was: Scree's benchmark program, LIGGGHTS, LAMMPS."""

import json
import os
import re
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path

from inputs import TOP, constants

CORES = 2  # MPI ranks of a peer, threads of Scree
BENCH = TOP / "build/bench/scree_bench"
FOLDER = Path(__file__).resolve().parent
LOOP_TIME = re.compile(r"Loop time of (\S+) on (\d+) procs for (\d+) steps with (\d+) atoms")


class RunFailed(Exception):
    pass


def output_of(command, cwd, environment=None):
    done = subprocess.run(command, cwd=cwd, env={**os.environ, **(environment or {})}, text=True, errors="replace",
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode:
        raise RunFailed(f"{' '.join(map(str, command))}\nended with {done.returncode}:\n{done.stdout[-2000:]}")
    return done.stdout


@dataclass(frozen=True)
class Peer:
    name: str
    command: str
    package: str

    def missing(self):
        """Why it cannot run, or nothing."""
        for command, package in ((self.command, self.package), ("mpirun", "openmpi-bin")):
            if not shutil.which(command):
                return f"{command} is not installed: apt-get install {package}"
        return None

    def run(self, input_file, variables, work):
        """Particle-steps per second of the input's last `run`, by the code's own loop time, and the code's version."""
        command = ["mpirun", "--oversubscribe", *(["--allow-run-as-root"] if os.geteuid() == 0 else []), "-np",
                   str(CORES), self.command, "-in", str(FOLDER / input_file), "-log", "none"]
        for name, value in {**constants(), **variables}.items():
            command += ["-var", name, str(value)]
        text = output_of(command, work, {"OMP_NUM_THREADS": "1"})
        loops = LOOP_TIME.findall(text)
        if len(loops) < 2:
            raise RunFailed(f"{self.name} printed no loop times:\n{text[-2000:]}")
        (_, _, _, atoms_before), (seconds, ranks, steps, atoms_after) = loops[-2:]
        particles = (int(atoms_before) + int(atoms_after)) / 2  # some leave a drain
        version = re.search(r"^(LIGGGHTS|LAMMPS) \((.*)\)", text, re.M)
        return {
            "particle_steps_per_second": particles * int(steps) / float(seconds),
            "code": version.group(0) if version else self.name,
            "ranks": int(ranks),
            "particles": round(particles),
            "steps": int(steps),
        }


LIGGGHTS = Peer("LIGGGHTS", "liggghts", "liggghts")
LAMMPS = Peer("LAMMPS", "lmp", "lammps")


def prepare_state(name, work):
    """Has Scree make a state; returns its file."""
    output_of([BENCH, "--states=states", f"--prepare={name}"], work)
    return work / "states" / f"{name}.csv"


def run_scree(benchmark, threads, work):
    """One benchmark of Scree from the prepared states: all of its steps, rebuilds and checks included."""
    out = work / "scree.json"
    name = f"{benchmark}/threads:{threads}"
    output_of([BENCH, "--states=states", f"--benchmark_filter=^{name}/", f"--benchmark_out={out}",
               "--benchmark_out_format=json"], work, {"OMP_NUM_THREADS": str(CORES)})
    found = json.loads(out.read_text())["benchmarks"]
    if len(found) != 1:
        raise RunFailed(f"{len(found)} benchmarks are named {name}")
    run = found[0]
    isa, state_hash = run["label"].split()
    return {
        "particle_steps_per_second": run["particle_steps/s"],
        "code": f"Scree, {isa} kernels",
        "threads": threads,
        "particles": round(run["particles"]),
        "steps": run["iterations"] * 50,
        "state_hash": state_hash,
        "copy_share": run["copy_share"],
    }
