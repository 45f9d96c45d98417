"""Dexels, meshes, programs and roots as arrays."""

from pathlib import Path

import numpy as np
import pytest

import sweepsim


def test_a_sweep_of_a_ball_is_exact() -> None:
    path = [[0, 0, 0], [8, 0, 0]]
    volume = sweepsim.sweep("Ball(radius: 2, length: 10)", path, min=(-3, -3), max=(11, 3), cells=(140, 60))
    assert volume.min == (-3, -3) and volume.max == (11, 3) and volume.cells == (140, 60)
    lines, ends = volume.lines, volume.intervals
    assert lines.dtype == np.uint32 and ends.dtype == np.float64 and len(volume) == len(lines) == len(ends)
    at = np.array(volume.min) + (lines + 0.5) * volume.spacing
    # The distance from the segment of the ball's centres, 2 above the tip.
    beside = np.hypot(at[:, 0] - np.clip(at[:, 0], 0, 8), at[:, 1])
    assert len(ends) > 3000
    assert np.abs(ends[:, 0] - (2 - np.sqrt(4 - beside**2))).max() < 1e-6
    # Normals point out of the volume, and moves are known.
    normals = volume.normals
    assert normals.shape == (len(ends), 2, 3) and np.abs(np.linalg.norm(normals, axis=2) - 1).max() < 1e-4
    assert (normals[:, 0, 2] < 1e-4).all() and (normals[:, 1, 2] > -1e-4).all()
    assert (volume.moves == 0).all()
    assert volume.counts.shape == (140, 60) and volume.counts.sum() == len(volume)
    assert volume.volume == pytest.approx((ends[:, 1] - ends[:, 0]).sum() * 0.01)
    assert volume.frame == ((0, 0, 0), [(1, 0, 0), (0, 1, 0), (0, 0, 1)])


def test_tools_lean() -> None:
    poses = [[0, 0, 0, 0, 0, 1], [4, 0, 0, 0.3, 0, 1]]
    leaning = sweepsim.sweep(sweepsim.Tool("Flat(radius: 2, length: 10)"), poses, min=(-4, -4), max=(12, 4), cells=(64, 32))
    upright = sweepsim.sweep("Flat(radius: 2, length: 10)", np.array(poses)[:, :3], min=(-4, -4), max=(12, 4), cells=(64, 32))
    assert leaning.volume > upright.volume > 250


def test_meshes_are_closed_and_not_copied() -> None:
    ball = sweepsim.sweep("Ball(radius: 2, length: 4)", [[0, 0, 0]], min=(-3, -3), max=(3, 3), cells=(60, 60))
    vertices, triangles, normals = ball.mesh()
    assert vertices.dtype == np.float64 and triangles.dtype == np.uint32 and normals.dtype == np.float32
    assert vertices.shape == normals.shape and len(triangles) > 1000
    assert triangles.max() == len(vertices) - 1
    # Every edge has its partner; on sharp edges each side has vertices of its own.
    places = np.unique(vertices, axis=0, return_inverse=True)[1].reshape(-1)[triangles]
    edges = np.concatenate([places[:, [0, 1]], places[:, [1, 2]], places[:, [2, 0]]])
    assert set(map(tuple, edges.tolist())) == set(map(tuple, edges[:, ::-1].tolist()))
    # By the divergence theorem.
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6 == pytest.approx(ball.volume, rel=0.01)
    # The memory belongs to what Rust made, and is the caller's to change.
    for array in (vertices, triangles, normals, ball.intervals, ball.lines):
        assert array.base is not None and array.flags.c_contiguous and array.flags.writeable


def test_dexels_of_arrays(tmp_path: Path) -> None:
    lines = np.array([[2, 1], [0, 0], [2, 1]], dtype=np.uint32)
    ends = np.array([[5.0, 6.0], [0.0, 1.0], [2.0, 3.0]])
    made = sweepsim.Dexels((0, 0), (3, 2), (3, 2), lines, ends)
    assert made.lines.tolist() == [[0, 0], [2, 1], [2, 1]]
    assert made.intervals.tolist() == [[0, 1], [2, 3], [5, 6]]
    assert made.volume == 3 and (made.moves == -1).all()
    for name in ("a.csv", "a.dexels", "a.npz", "a.vtu"):
        made.write(tmp_path / name)
        assert (tmp_path / name).stat().st_size > 20
    for name in ("a.dexels", "a.npz"):
        assert sweepsim.Dexels.read(tmp_path / name).intervals.tolist() == made.intervals.tolist()
    for wrong, word in [
        ((lines, ends[:2]), "one of each"),
        ((lines + 2, ends), "beyond the grid"),
        ((lines, ends[:, ::-1].copy()), "length"),
        ((lines[:, :1].copy(), ends), "rows of 2"),
    ]:
        with pytest.raises(sweepsim.InputError, match=word):
            sweepsim.Dexels((0, 0), (3, 2), (3, 2), *wrong)
    with pytest.raises(OSError):
        made.write(tmp_path / "missing" / "a.csv")
    with pytest.raises(sweepsim.InputError):
        made.write(tmp_path / "a.doc")


def test_a_program_as_arrays() -> None:
    program = sweepsim.read_program("G20 G90\nT3 M6\nG0 X1 Y2 Z3\nG1 Z0 F20\nG2 X3 I1 J0\nM30\n", name="arc.ngc")
    assert len(program) == len(program.tips) == len(program.line) > 8
    assert program.tips[[0, -1]] == pytest.approx(np.array([[25.4, 50.8, 76.2], [76.2, 50.8, 0]]))
    assert (program.axes == [0, 0, 1]).all() and (program.tool == 3).all()
    assert program.rapid.tolist() == [True] + [False] * (len(program) - 1)
    assert program.joined.tolist() == [False] + [True] * (len(program) - 1)
    assert np.isnan(program.feed[0]) and (program.feed[1:] == 20).all() and (program.feed_mode == 94).all()
    assert program.line[0] == 3 and set(program.line[2:].tolist()) == {5}
    assert (program.units, program.format, program.files) == ("inch", "gcode", ["arc.ngc"])
    # Chords of the half circle.
    radii = np.hypot(*(program.tips[1:, :2] - [2 * 25.4, 2 * 25.4]).T)
    assert np.abs(radii - 25.4).max() < 1e-9
    siemens = sweepsim.read_program("N10 G0 X=5 Y0 Z0\nN20 G1 X=7 F100\n", controller="siemens", name="a.mpf")
    assert siemens.controller == "siemens" and siemens.tips[1].tolist() == [7, 0, 0]


def test_roots_are_all_and_certified() -> None:
    roots = sweepsim.solve_system(["x^2+y^2-1", "y = x^3"], [(-2, 2), (-2, 2)])
    assert roots.variables == ("x", "y") and len(roots) == 2 and roots.unresolved.shape == (0, 2, 2)
    x, y = roots.points.T
    assert np.abs(x**2 + y**2 - 1).max() < 1e-15 and np.abs(y - x**3).max() < 1e-15
    low, high = roots.enclosures[:, 0], roots.enclosures[:, 1]
    assert ((low <= roots.points) & (roots.points <= high)).all() and (high - low).max() < 1e-12
    # A double root cannot be certified: it is where nothing is decided.
    double = sweepsim.solve_system(["a^2 - 2*a + 1"], {"a": (0, 3)})
    assert len(double) == 0 and len(double.unresolved) == 1
    [[[low1], [high1]]] = double.unresolved.tolist()
    assert low1 <= 1 <= high1
    few = sweepsim.solve_system(["x^2+y^2-1", "y = x^3"], [(-2, 2), (-2, 2)], boxes=1)
    assert len(few) == 0 and len(few.unresolved) > 0


def test_parts_are_compared(tmp_path: Path) -> None:
    def block(high: float) -> sweepsim.Dexels:
        lines = np.stack(np.meshgrid(np.arange(20), np.arange(10), indexing="ij"), -1).reshape(-1, 2).astype(np.uint32)
        ends = np.tile([0.0, high], (len(lines), 1))
        return sweepsim.Dexels((0, 0), (20, 10), (20, 10), lines, ends)

    low, tall = block(5), block(5.5)
    found = sweepsim.compare(tall, low, limits=(0.1, 0.1))
    assert found.report["volume"] == 1100 and found.report["target_volume"] == pytest.approx(1000, rel=0.2)
    assert found.report["excess_volume"] > 50 and found.picture.startswith(b"\x89PNG")
    low.write(tmp_path / "low.dexels")
    same = sweepsim.compare(low, tmp_path / "low.dexels")
    assert same.report["excess_volume"] == pytest.approx(0, abs=1e-9)
    mesh = sweepsim.compare(tall.mesh(), low.mesh(), cells=(20, 10))
    assert mesh.report["part"] == "a" and mesh.report["target"] == "b"
    assert "<img" in mesh._repr_html_()
