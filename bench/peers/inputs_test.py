"""The peers' input files are what they say: counts and shapes, read back."""

import math
import tempfile
from pathlib import Path

import compare
import inputs
import lattice_mesh

ROWS = [(1e-3, 2e-3, 3e-4, 2e-4, 0.0, -0.1, 0.2), (0.1 + 0.2, 5e-3, 6e-4, 2e-4, 1e-9, 0.0, 0.0)]


def test_the_mesh_is_complete():
    assert len(lattice_mesh.fibres()) == 100
    assert len(lattice_mesh.lattice()) == 18560
    assert len(lattice_mesh.channel()) == 24 and len(lattice_mesh.hopper()) == 16


def test_a_tube_has_the_fibre_s_volume():
    # The divergence theorem, and the triangles' orientation with it: the sides alone of a tube along z from z = 0.
    area = sum(
        0.5 * lattice_mesh.cross(lattice_mesh.minus(b, a), lattice_mesh.minus(c, a))[axis] * (a[axis] + b[axis] + c[axis]) / 3
        for a, b, c in lattice_mesh.tube((0, 0, 0), (0, 0, 1.0))
        for axis in (0, 1)
    )
    assert math.isclose(area / 2, math.pi * lattice_mesh.FIBRE_RADIUS**2, rel_tol=1e-9)


def test_stl_files_hold_three_corners_a_facet():
    with tempfile.TemporaryDirectory() as folder:
        lattice_mesh.write_all(folder)
        words = (Path(folder) / "lattice.stl").read_text().split()
    assert words.count("facet") == 18560 and words.count("vertex") == 3 * 18560


def test_data_files_give_back_the_particles():
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "x.data"
        assert inputs.write_data(path, ROWS, [(0.0, 1.0)] * 3) == 2
        sections = path.read_text().split("\n\n")
    atoms = [list(map(float, line.split())) for line in sections[sections.index("Atoms") + 1].splitlines()]
    assert [a[4:] for a in atoms] == [list(r[:3]) for r in ROWS]  # every digit
    assert atoms[0][:4] == [1, 1, 4e-4, 3071]
    velocities = [list(map(float, line.split())) for line in sections[sections.index("Velocities") + 1].splitlines()]
    assert [v[1:4] for v in velocities] == [list(r[4:]) for r in ROWS]


def test_tiles_stand_side_by_side():
    bed = list(inputs.tiled(ROWS, 0.01, 3))
    assert len(bed) == 18 and bed[4][0] == ROWS[0][0] + 2 * 0.01 and bed[12][1] == ROWS[0][1] + 2 * 0.01


def test_constants_are_the_case_s():
    v = inputs.constants()
    assert (v["youngs_1"], v["sliding_11"], v["sliding_12"], v["rolling_12"], v["dt"]) == (1e7, 0.53, 0.5, 0.41, 5e-6)


def test_a_best_skin_at_an_end_of_the_search_is_told():
    skins = [{"skin": s} for s in compare.BED_SKINS]
    assert compare.skin_at_edge(skins[0], skins) == "smallest" and compare.skin_at_edge(skins[-1], skins) == "largest"
    assert compare.skin_at_edge(skins[2], skins) is None
    assert compare.skin_at_edge(skins[0], [skins[0], {**skins[0], "grid": [1, 1, 2]}]) is None  # grids, not skins


def test_every_ratio_is_of_two_measurements_that_are_taken():
    for pair in (compare.RATIOS | compare.FURTHER_RATIOS).values():
        assert set(pair) <= set(compare.ORDER)


if __name__ == "__main__":
    tests = [f for name, f in list(globals().items()) if name.startswith("test_")]
    for test in tests:
        test()
    print(f"{len(tests)} tests passed")
