"""The small Octet lattice of cases/olhx/mini_liggghts.toml, its channel and hopper as triangles in STL files.

Fibres are 14-sided tubes of the circle's cross-section area, node to node, 8 pieces long; triangles wholly outside the
channel are left out. Frame: z up, exit at z = -30 mm, lattice entrance at z = 0, hopper above. SI units.

    python3 lattice_mesh.py FOLDER      writes lattice.stl, channel.stl, hopper.stl
"""

import math
import sys
from pathlib import Path

CELL = 10e-3  # m
LAYERS = 3
HALF = 0.5 * CELL  # of the channel's width
DEPTH = LAYERS * CELL
FIBRE_RADIUS = 0.5e-3
SIDES, PIECES = 14, 8


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def scaled(s, a):
    return tuple(s * x for x in a)


def minus(a, b):
    return add(a, scaled(-1, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return scaled(1 / math.sqrt(sum(x * x for x in a)), a)


def nodes():
    """Corners and face centres of the cells, in half cells from the lattice's lowest corner."""
    found = set()
    for layer in range(LAYERS):
        corners = [(x, y, z) for x in (0, 2) for y in (0, 2) for z in (0, 2)]
        faces = [(1, 1, 0), (1, 1, 2), (1, 0, 1), (1, 2, 1), (0, 1, 1), (2, 1, 1)]
        found |= {(x, y, z + 2 * layer) for x, y, z in corners + faces}
    return sorted(found)


def fibres():
    """Each distinct fibre once, as its two ends in m: nodes half a face diagonal apart."""
    at = nodes()
    place = lambda n: minus(scaled(0.5 * CELL, n), (HALF, HALF, DEPTH))
    return [
        (place(p), place(q))
        for i, p in enumerate(at)
        for q in at[i + 1 :]
        if sum((x - y) ** 2 for x, y in zip(p, q)) == 2
    ]


def tube(start, end):
    """Triangles of a polygonal tube with the area of the fibre's circle."""
    radius = FIBRE_RADIUS * math.sqrt(math.pi / (SIDES / 2 * math.sin(2 * math.pi / SIDES)))
    along = unit(minus(end, start))
    side = unit(cross(along, (0, 0, 1) if abs(along[2]) < 0.9 else (1, 0, 0)))
    other = cross(along, side)
    angles = [2 * math.pi * (s + 0.5) / SIDES for s in range(SIDES)]
    ring = [add(scaled(radius * math.cos(a), side), scaled(radius * math.sin(a), other)) for a in angles]
    cuts = [add(start, scaled(k / PIECES, minus(end, start))) for k in range(PIECES + 1)]
    for low, high in zip(cuts, cuts[1:]):
        for a, b in zip(ring, ring[1:] + ring[:1]):
            yield add(low, a), add(low, b), add(high, b)
            yield add(low, a), add(high, b), add(high, a)


def outside_channel(triangle):
    limit = HALF + 1e-6
    return any(all(sign * corner[axis] > limit for corner in triangle) for axis in (0, 1) for sign in (1, -1))


def lattice():
    return [t for start, end in fibres() for t in tube(start, end) if not outside_channel(t)]


def upright_walls(low_half, low, high_half, high):
    """Four walls between squares of half widths low_half at z = low and high_half at z = high."""
    corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    for p, q in zip(corners, corners[1:] + corners[:1]):
        a, b = ((low_half * x, low_half * y, low) for x, y in (p, q))
        d, c = ((high_half * x, high_half * y, high) for x, y in (p, q))
        yield a, b, c
        yield a, c, d


def channel():
    return [t for k in range(LAYERS) for t in upright_walls(HALF, -DEPTH + k * CELL, HALF, -DEPTH + (k + 1) * CELL)]


def hopper():
    return [*upright_walls(HALF, 0, 2 * HALF, 24e-3), *upright_walls(2 * HALF, 24e-3, 2 * HALF, 34e-3)]


def write_stl(path, triangles):
    with open(path, "w") as f:
        f.write("solid mesh\n")
        for t in triangles:
            f.write(" facet normal %.9e %.9e %.9e\n  outer loop\n" % unit(cross(minus(t[1], t[0]), minus(t[2], t[0]))))
            for corner in t:
                f.write("   vertex %.12e %.12e %.12e\n" % corner)
            f.write("  endloop\n endfacet\n")
        f.write("endsolid mesh\n")


def write_all(folder):
    for name, triangles in (("lattice", lattice()), ("channel", channel()), ("hopper", hopper())):
        write_stl(Path(folder) / f"{name}.stl", triangles)


if __name__ == "__main__":
    write_all(sys.argv[1])
