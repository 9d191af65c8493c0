"""What LIGGGHTS and LAMMPS read: the constants of cases/olhx/common.toml, and Scree's particles as a data file."""

import csv
import math
import tomllib
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
NOMINAL_OVERLAP = 2e-7  # m, of a contact under a few millimetres of grains: what LAMMPS's rolling stiffness is taken at


def constants():
    """The variables of the input files, by name. Material 1: carbobead (grains), 2: steel (walls)."""
    case = tomllib.loads((TOP / "cases/olhx/common.toml").read_text())
    material = {m["name"]: m for m in case["material"]}
    pair = {tuple(p["materials"]): p for p in case["pair"]}
    v = {"dt": case["time"]["step"]}
    for number, name in ((1, "carbobead"), (2, "steel")):
        v[f"youngs_{number}"] = material[name]["youngs_modulus"]
        v[f"poisson_{number}"] = material[name]["poisson_ratio"]
    for number, names in ((11, ("carbobead", "carbobead")), (12, ("carbobead", "steel"))):
        v[f"restitution_{number}"] = pair[names]["restitution"]
        v[f"sliding_{number}"] = pair[names]["sliding_friction"]
        v[f"rolling_{number}"] = pair[names]["rolling_friction"]
    v["rolling_stiffness"] = tangential_stiffness(v["youngs_1"], v["poisson_1"], case["particles"][0]["diameter"])
    return v


def tangential_stiffness(youngs, poisson, diameter):
    """k_t = 8 G* sqrt(R* overlap) of two equal spheres, N/m: EPSD2's rolling spring is k_t R*^2."""
    shear = youngs / (4 * (2 - poisson) * (1 + poisson))
    return 8 * shear * math.sqrt(diameter / 4 * NOMINAL_OVERLAP)


def density():
    case = tomllib.loads((TOP / "cases/olhx/common.toml").read_text())
    return case["material"][0]["density"]


def read_state(path):
    """Rows (x, y, z, r, vx, vy, vz) of a state that scree_bench wrote."""
    with open(path, newline="") as f:
        rows = csv.reader(f)
        assert next(rows) == ["x", "y", "z", "r", "vx", "vy", "vz"], path
        return [tuple(map(float, row)) for row in rows]


def tiled(tile, side, tiles):
    """As bench/scenes.cpp tiles a bed: the same sums, so the same bits."""
    for y in range(tiles):
        for x in range(tiles):
            dx, dy = x * side, y * side
            for p in tile:
                yield (p[0] + dx, p[1] + dy, *p[2:])


def write_data(path, particles, box):
    """A data file for read_data, of LIGGGHTS's atom style "granular" and LAMMPS's "sphere". Returns the number."""
    particles = list(particles)
    rho = density()
    with open(path, "w") as f:
        f.write(f"grains\n\n{len(particles)} atoms\n2 atom types\n\n")
        for axis, (low, high) in zip("xyz", box):
            f.write(f"{low!r} {high!r} {axis}lo {axis}hi\n")
        f.write("\nAtoms\n\n")
        for k, (x, y, z, r, *_) in enumerate(particles, 1):
            f.write(f"{k} 1 {2 * r!r} {rho} {x!r} {y!r} {z!r}\n")
        f.write("\nVelocities\n\n")
        for k, (*_, vx, vy, vz) in enumerate(particles, 1):
            f.write(f"{k} {vx!r} {vy!r} {vz!r} 0 0 0\n")
    return len(particles)

