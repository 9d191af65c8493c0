"""Scree beside LIGGGHTS and LAMMPS on the same particles: what `bench/run --peers` runs. See bench/README.md.

Every measurement is taken once a round, one after the other, so that a slow spell of the machine meets both sides of a
ratio; a ratio is the median, over the rounds, of the quotient of a round's two values.
"""

import argparse
import datetime
import json
import os
import platform
import statistics
import sys
import tempfile
from pathlib import Path

import lattice_mesh
from codes import CORES, LAMMPS, LIGGGHTS, RunFailed, prepare_state, run_scree
from inputs import read_state, tiled, write_data

TILE_SIDE = 25 * 4e-4  # m, bench/scenes.cpp
TILE_HEIGHT = 4 * 16 * 4e-4
PAPER_SKIN = 800e-6  # m, Kaur et al. 2023
BED_SKINS = [5e-6, 10e-6, 20e-6, 40e-6, 80e-6, 160e-6]
DRAIN_SKINS = [20e-6, 40e-6, 80e-6, 160e-6]
BED_WARM_UP, DRAIN_WARM_UP = 20, 200  # steps, as bench/steps.cpp
DRAIN_STEPS = 1000
BYTES_OF_10M = 6e9  # that the 10M bed needs at its peak, this program's own copy of the particles included

# Within a round: a ratio's two measurements are close in time.
ORDER = ["lammps_bed_paper_skin", "lammps_bed", "liggghts_bed_paper_skin", "liggghts_bed", "scree_bed", "scree_bed_10M",
         "scree_bed_1_thread", "scree_polydisperse_bed", "liggghts_drain", "scree_drain"]

# ratio: numerator, denominator
RATIOS = {
    "bed_1M_vs_liggghts_best": ("scree_bed", "liggghts_bed"),
    "bed_1M_vs_liggghts_paper_skin": ("scree_bed", "liggghts_bed_paper_skin"),
    "drain_vs_liggghts": ("scree_drain", "liggghts_drain"),
    "bed_10M_vs_1M": ("scree_bed_10M", "scree_bed"),
    "poly_vs_mono": ("scree_polydisperse_bed", "scree_bed"),
    "threads_2_vs_1": ("scree_bed", "scree_bed_1_thread"),
}
FURTHER_RATIOS = {
    "bed_1M_vs_lammps_best": ("scree_bed", "lammps_bed"),
    "bed_1M_vs_lammps_paper_skin": ("scree_bed", "lammps_bed_paper_skin"),
}


def say(text):
    print(text, file=sys.stderr, flush=True)


def memory_available():
    for line in Path("/proc/meminfo").read_text().splitlines():
        if line.startswith("MemAvailable"):
            return 1024 * int(line.split()[1])
    return 0


def machine():
    lines = Path("/proc/cpuinfo").read_text().splitlines()
    models = [line.split(":")[1].strip() for line in lines if line.startswith("model name")]
    return {
        "cpu": models[0] if models else platform.machine(),
        "cores": os.cpu_count(),
        "system": platform.platform(),
        "load_at_start": os.getloadavg()[0],
        "memory_available_bytes": memory_available(),
    }


class Comparison:
    def __init__(self, options, work):
        self.quick, self.rounds, self.work = options.quick, options.rounds, work
        self.tiles = 3 if self.quick else 10
        self.takes = {}  # by name: a function that measures once
        self.settings = {}  # by name: what the input was given (skin, processor grid)
        self.reasons = {}  # by name: why there is no measurement
        self.values = {}
        self.searches = {}
        self.warnings = []

    # ---- set-up

    def add(self, name, take, **settings):
        self.takes[name], self.settings[name] = take, settings

    def leave_out(self, name, reason):
        self.reasons[name] = reason
        say(f"without {name}: {reason}")

    def write_bed(self, tile, tiles):
        path = self.work / f"bed_{tiles}.data"
        side = TILE_SIDE * tiles
        write_data(path, tiled(tile, TILE_SIDE, tiles), [(0.0, side), (0.0, side), (-1e-3, TILE_HEIGHT)])
        return path

    def search(self, name, run, candidates):
        """The fastest of the candidates, each given to `run` once."""
        speeds = []
        for candidate in candidates:
            speeds.append(run(**candidate)["particle_steps_per_second"])
            say(f"{name}: {text_of(candidate)}: {speeds[-1] / 1e6:.3g} M particle-steps/s")
        self.searches[name] = [{**c, "particle_steps_per_second": s} for c, s in zip(candidates, speeds)]
        best = candidates[speeds.index(max(speeds))]
        if edge := skin_at_edge(best, candidates):
            self.warnings.append(f"{name}: the best skin, {best['skin'] * 1e6:g} um, is the {edge} of those tried: "
                                 "a better one may lie beyond")
            say(f"warning: {self.warnings[-1]}")
        return best

    def add_peer_beds(self, peer, bed_files):
        name, kind = f"{peer.name.lower()}_bed", peer.name.lower()
        if reason := peer.missing():
            self.leave_out(name, reason)
            self.leave_out(f"{name}_paper_skin", reason)
            return

        def run(skin, data=bed_files["small"], steps=200):
            variables = {"data": data, "skin": skin, "warm_up": BED_WARM_UP, "steps": steps}
            return peer.run(f"bed.{kind}", variables, self.work)

        best = self.search(f"{peer.name}, small bed", run, [{"skin": s} for s in BED_SKINS])
        data, steps = bed_files["timed"], 400 if self.quick else 100
        self.add(name, lambda: run(**best, data=data, steps=steps), **best)
        self.add(f"{name}_paper_skin", lambda: run(PAPER_SKIN, data, 100 if self.quick else 30), skin=PAPER_SKIN)

    def add_peer_drain(self):
        if reason := LIGGGHTS.missing():
            self.leave_out("liggghts_drain", reason)
            return
        data = self.work / "drain.data"
        write_data(data, read_state(prepare_state("drain_in_flow", self.work)),
                   [(-0.012, 0.012), (-0.012, 0.012), (-0.033, 0.036)])
        lattice_mesh.write_all(self.work)

        def run(skin, grid, steps=DRAIN_STEPS):
            px, py, pz = grid
            variables = {"data": data, "skin": skin, "px": px, "py": py, "pz": pz, "warm_up": DRAIN_WARM_UP}
            return LIGGGHTS.run("drain.liggghts", {**variables, "steps": steps}, self.work)

        side_by_side, stacked = [CORES, 1, 1], [1, 1, CORES]
        short = lambda **c: run(**c, steps=400)
        skin = self.search("LIGGGHTS, drain", short, [{"skin": s, "grid": side_by_side} for s in DRAIN_SKINS])["skin"]
        grids = [{"skin": skin, "grid": g} for g in (side_by_side, stacked)]
        best = self.search("LIGGGHTS, drain, processor grid", short, grids)
        self.add("liggghts_drain", lambda: run(**best), **best)

    def add_scree(self, name, benchmark, threads=CORES):
        self.add(name, lambda: run_scree(benchmark, threads, self.work))

    def prepare(self):
        say("settling the beds' tiles and letting the drain reach its flow ...")
        tile = read_state(prepare_state("settled_tile", self.work))
        prepare_state("polydisperse_tile", self.work)
        prepare_state("drain_in_flow", self.work)
        bed_files = {"small": self.write_bed(tile, 3)}
        bed_files["timed"] = bed_files["small"] if self.quick else self.write_bed(tile, self.tiles)
        self.add_peer_beds(LIGGGHTS, bed_files)
        self.add_scree("scree_bed", f"settled_bed/tiles:{self.tiles}")
        self.add_peer_beds(LAMMPS, bed_files)
        self.add_scree("scree_bed_1_thread", f"settled_bed/tiles:{self.tiles}", 1)
        self.add_scree("scree_polydisperse_bed", f"polydisperse_bed/tiles:{self.tiles}")
        self.add_peer_drain()
        self.add_scree("scree_drain", "lattice_drain")
        if self.quick:
            self.leave_out("scree_bed_10M", "left out by --quick")
        elif memory_available() < BYTES_OF_10M:
            free = memory_available() / 1e9
            self.leave_out("scree_bed_10M", f"needs {BYTES_OF_10M / 1e9:.0f} GB, {free:.1f} GB are free")
        else:
            self.add_scree("scree_bed_10M", "settled_bed/tiles:31")

    # ---- rounds

    def measure(self):
        for k in range(self.rounds):
            for name in ORDER:
                if name in self.takes:
                    self.take(name, k)

    def take(self, name, k):
        try:
            value = self.takes[name]()
        except RunFailed as error:
            del self.takes[name]
            self.leave_out(name, str(error))
            return
        self.values.setdefault(name, []).append(value)
        speed = value["particle_steps_per_second"] / 1e6
        say(f"round {k + 1} of {self.rounds}: {name}: {speed:.4g} M particle-steps/s")

    # ---- results

    def figure(self, name):
        values = self.values[name]
        speeds = [v["particle_steps_per_second"] for v in values]
        hashes = {v.get("state_hash") for v in values}
        if len(hashes) > 1:
            raise SystemExit(f"{name}: the state after the same steps differs from round to round: {sorted(hashes)}")
        return {**values[0], **self.settings[name], "particle_steps_per_second": statistics.median(speeds),
                "rounds": len(speeds), "values": speeds, "cpu": machine()["cpu"]}

    def ratios(self, pairs, figures):
        """Each ratio, or None and the reason why; and the quotients of the rounds."""
        ratios, rounds, reasons = {}, {}, {}
        for ratio, pair in pairs.items():
            absent = [name for name in pair if name not in figures]
            if absent:
                ratios[ratio], reasons[ratio] = None, self.reasons[absent[0]]
            else:
                rounds[ratio] = [over / under for over, under in zip(*(figures[name]["values"] for name in pair))]
                ratios[ratio] = statistics.median(rounds[ratio])
        return ratios, rounds, reasons

    def results(self):
        figures = {name: self.figure(name) for name in ORDER if name in self.takes}
        ratios, by_round, reasons = self.ratios(RATIOS, figures)
        further, further_by_round, further_reasons = self.ratios(FURTHER_RATIOS, figures)
        return {"ratios": ratios, "further_ratios": further, "by_round": by_round | further_by_round,
                "reasons": reasons | further_reasons,
                "behind": RATIOS | FURTHER_RATIOS, "figures": figures, "searches": self.searches,
                "warnings": self.warnings, "quick": self.quick,
                "rounds": self.rounds}


def skin_at_edge(best, candidates):
    """Which end of the skins tried the best one is, or nothing."""
    skins = sorted({c["skin"] for c in candidates})
    if len(skins) < 2:
        return None
    return {skins[0]: "smallest", skins[-1]: "largest"}.get(best["skin"])


def text_of(candidate):
    return ", ".join(f"{name} {v * 1e6:g} um" if name == "skin" else f"{name} {v}" for name, v in candidate.items())


def print_results(results):
    print(f"\n{'measurement':<26} {'M particle-steps/s':>18}  {'lowest':>7} {'highest':>7}  {'skin um':>7}  state hash")
    for name, f in results["figures"].items():
        skin = f"{f['skin'] * 1e6:g}" if "skin" in f else ""
        low, high = (x / 1e6 for x in (min(f["values"]), max(f["values"])))
        speed = f["particle_steps_per_second"] / 1e6
        print(f"{name:<26} {speed:18.4g}  {low:7.4g} {high:7.4g}  {skin:>7}  {f.get('state_hash', '')}")
    print(f"\n{'ratio':<32} {'median':>8}  of the rounds")
    for name, ratio in (results["ratios"] | results["further_ratios"]).items():
        rounds = ", ".join(f"{r:.3g}" for r in results["by_round"].get(name, []))
        value = f"{ratio:8.3g}  {rounds}" if ratio is not None else f"       -  ({results['reasons'][name]})"
        print(f"{name:<32} {value}")
    for warning in results["warnings"]:
        print(f"warning: {warning}")
    if results["quick"]:
        print("--quick: the beds are of 94,536 grains, not of a million")


def options():
    p = argparse.ArgumentParser(prog="bench/run --peers", description=__doc__,
                                formatter_class=argparse.RawTextHelpFormatter)
    p.add_argument("--out", "--json", metavar="FILE.json", help="write ratios, figures and all single values there")
    p.add_argument("--rounds", type=int, default=3, help="times that everything is measured (default 3)")
    p.add_argument("--quick", action="store_true", help="beds of 94,536 grains instead of 1,050,400; none of 10 M")
    p.add_argument("--work", metavar="FOLDER", help="keep prepared states and input files there and use them again")
    return p.parse_args()


def main():
    given = options()
    if given.rounds < 1:
        raise SystemExit("--rounds must be at least 1")
    with tempfile.TemporaryDirectory(prefix="scree_peers_") as temporary:
        work = Path(given.work or temporary).resolve()
        work.mkdir(parents=True, exist_ok=True)
        now = datetime.datetime.now(datetime.timezone.utc)
        started = {"date": now.isoformat(timespec="seconds"), "machine": machine()}
        comparison = Comparison(given, work)
        comparison.prepare()
        comparison.measure()
        results = {**comparison.results(), **started}
    print_results(results)
    if given.out:
        Path(given.out).write_text(json.dumps(results, indent=2) + "\n")


if __name__ == "__main__":
    try:
        main()
    except RunFailed as error:
        raise SystemExit(str(error))
