"""A program milled with manifold3d, by hulls of pairs of poses: manifold3d_mill.py WORK TOLERANCE ANSWER. Answers the corners of the triangles."""

import math
import sys
import time

import manifold3d
import numpy


def read(file):
    work = {"poses": []}
    for line in open(file):
        key, *values = line.strip().split(",")
        values = [float(value) for value in values]
        if key == "pose":
            work["poses"].append((numpy.array(values[:3]), numpy.array(values[3:])))
        elif key in ("ball", "flat"):
            work["ball"], work["radius"], work["length"] = key == "ball", *values
        else:
            work[key] = values
    return work


def tool(work, tolerance):
    """Points of the tool's hull, tip at the origin, axis along z; its circles' chords are off by the tolerance at most, inside and outside alike."""
    radius = work["radius"]
    count = max(8, math.ceil(math.pi / math.acos(1.0 - 2.0 * tolerance / radius)))
    turns = numpy.arange(count) * (2.0 * math.pi / count)
    circle = numpy.stack([numpy.cos(turns), numpy.sin(turns)], axis=1) * (radius + 0.5 * tolerance)
    ring = lambda scale, z: numpy.column_stack([circle * scale, numpy.full(count, z)])
    rings = [ring(1.0, work["length"])]
    if work["ball"]:
        for n in range(count // 4 + 1):
            angle = 0.5 * math.pi * n / (count // 4)
            rings.append(ring(math.cos(angle), radius - (radius + 0.5 * tolerance) * math.sin(angle)))
    else:
        rings.append(ring(1.0, 0.0))
    return numpy.concatenate(rings)


def placed(points, tip, axis):
    axis = axis / numpy.linalg.norm(axis)
    side = numpy.cross([0.0, 1.0, 0.0], axis)
    side /= numpy.linalg.norm(side)
    return points @ numpy.stack([side, numpy.cross(axis, side), axis]) + tip


def slerp(a, b, t):
    a, b = a / numpy.linalg.norm(a), b / numpy.linalg.norm(b)
    angle = math.acos(min(1.0, float(a @ b)))
    if angle < 1e-9:
        return a
    return (math.sin((1.0 - t) * angle) * a + math.sin(t * angle) * b) / math.sin(angle)


def main():
    work, tolerance = read(sys.argv[1]), float(sys.argv[2])
    points = tool(work, tolerance)
    start = time.process_time()
    hulls = []
    for (tip, axis), (to, other) in zip(work["poses"], work["poses"][1:]):
        cosine = float(axis @ other) / float(numpy.linalg.norm(axis) * numpy.linalg.norm(other))
        angle = math.acos(min(1.0, cosine))
        # The chord of what the top of the tool describes.
        steps = max(1, math.ceil(angle * math.sqrt(work["length"] / (8.0 * tolerance))))
        ends = [placed(points, tip + (to - tip) * t, slerp(axis, other, t)) for t in (k / steps for k in range(steps + 1))]
        for pair in zip(ends, ends[1:]):
            hulls.append(manifold3d.Manifold.hull_points(numpy.concatenate(pair)))
    block = work["block"]
    size = [high - low for low, high in zip(block[:3], block[3:])]
    stock = manifold3d.Manifold.cube(size).translate(block[:3])
    mesh = (stock - manifold3d.Manifold.batch_boolean(hulls, manifold3d.OpType.Add)).to_mesh64()
    took = time.process_time() - start
    places = numpy.asarray(mesh.vert_properties)[:, :3]
    places[numpy.asarray(mesh.tri_verts)].astype("<f8").tofile(sys.argv[3])
    print(took)


if __name__ == "__main__":
    main()
