#!/usr/bin/env python3
"""Tri-dexels beside BREP_cam and manifold3d: 243 balls taken out of a block, in one run. See README.md here."""

import json
import math
import subprocess
import sys
import time
from pathlib import Path

SIZE = (90.0, 90.0, 30.0)
RADIUS = 4.0
CENTRES = [(10 * i + 5, 10 * j + 5, 10 * k + 5) for k in range(3) for j in range(9) for i in range(9)]
EXACT = SIZE[0] * SIZE[1] * SIZE[2] - len(CENTRES) * 4 / 3 * math.pi * RADIUS**3
ROW = "{:<28} {:>9} {:>9} {:>11} {:>13} {:>10}"


def row(name, csg, mesh, triangles, volume_error, off):
    away = "steps" if off is None else f"{off:.1e}"
    cells = (name, f"{csg:.3f}", f"{mesh:.3f}", triangles, f"{volume_error:.1e}", away)
    print(ROW.format(*cells), flush=True)


def tri_dexels(lines):
    command = ["cargo", "run", "--quiet", "--release", "-p", "sweepsim-dexel", "--example", "csg_of_many_balls", "--"]
    folder = Path(__file__).resolve().parent.parent
    done = subprocess.run([*command, str(lines)], cwd=folder, check=True, capture_output=True, text=True)
    found = json.loads(done.stdout)
    name = f"tri-dexels, {lines} lines"
    row(name, found["csg_s"], found["mesh_s"], found["triangles"], found["volume_error"], found["off_mm"])


def brep_cam(lines):
    folder = Path(__file__).resolve().parent / "brep_cam_balls"
    command = ["cargo", "run", "--quiet", "--release", "--", str(lines)]
    done = subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True)
    found = json.loads(done.stdout)
    # Its surface is made of squares and walls, off by a cell's slope: no distance would be fair.
    cells = found["csg_s"], found["mesh_s"], found["triangles"], found["volume_error"]
    row(f"BREP_cam, {lines} lines", *cells, None)


def manifold(segments):
    import manifold3d
    import numpy

    start = time.perf_counter()
    ball = manifold3d.Manifold.sphere(RADIUS, segments)
    balls = manifold3d.Manifold.batch_boolean([ball.translate(c) for c in CENTRES], manifold3d.OpType.Add)
    part = manifold3d.Manifold.cube(SIZE) - balls
    # Booleans are done when something is asked for.
    volume = part.volume()
    csg = time.perf_counter() - start
    start = time.perf_counter()
    mesh = part.to_mesh()
    meshing = time.perf_counter() - start
    # Middles of triangles on balls: their corners are on the ball, and the middle is what is furthest from it.
    places = numpy.asarray(mesh.vert_properties, dtype=float)[:, :3]
    middles = places[numpy.asarray(mesh.tri_verts)].mean(axis=1)
    inner = numpy.all((middles > 1e-6) & (middles < numpy.array(SIZE) - 1e-6), axis=1)
    away = numpy.linalg.norm((middles[inner] % 10) - 5, axis=1)
    off = float(abs(away - RADIUS).max())
    row(f"manifold3d, {segments} segments", csg, meshing, part.num_tri(), abs(volume - EXACT) / EXACT, off)


def main():
    print(ROW.format("", "CSG s", "mesh s", "triangles", "volume error", "off mm"))
    for lines in (90, 180, 360):
        tri_dexels(lines)
    for lines in (90, 180, 360):
        brep_cam(lines)
    try:
        import manifold3d  # noqa: F401
    except ImportError as error:
        sys.exit(f"manifold3d is not there: {error}")
    for segments in (32, 128, 512):
        manifold(segments)


if __name__ == "__main__":
    main()
