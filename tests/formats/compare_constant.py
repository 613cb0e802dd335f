#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares PC2 and MDD caches of a run with its PLY frames: the cloth at the same material points.

usage: compare_constant.py RUN_DIR FRAMES_PER_SECOND
"""
import sys
from pathlib import Path

import numpy as np
from compare import read_ply, require

FLOAT_TOLERANCE = 1e-6  # m: points are floats, of a cloth within 4 m of the origin
BORDER_TOLERANCE = 1e-9  # barycentric: points on edges lie in a face to rounding


def sample(frame, points):
    """World positions of material points: every face is tried, so that no search tree is needed."""
    vertices, faces, _ = frame
    a, b, c = (vertices["u"][faces["vertices"][:, k]] for k in range(3))
    x = [vertices["x"][faces["vertices"][:, k]] for k in range(3)]

    def area(p, q, r):
        return (q - p)[:, 0] * (r - p)[:, 1] - (q - p)[:, 1] * (r - p)[:, 0]

    result = []
    for p in points:
        at = np.broadcast_to(p, a.shape)
        weights = np.stack([area(at, b, c), area(a, at, c), area(a, b, at)]) / area(a, b, c)
        f = weights.min(axis=0).argmax()
        require(weights[:, f].min() > -BORDER_TOLERANCE, f"material point {p} is not in the cloth")
        result.append(sum(weights[k, f] * x[k][f] for k in range(3)))
    return np.array(result)


def read_pc2(path):
    data = path.read_bytes()
    head = np.frombuffer(data, np.dtype([("sign", "S12"), ("version", "<i4"), ("points", "<i4"), ("start", "<f4"),
                                         ("rate", "<f4"), ("samples", "<i4")]), 1)[0]
    require(head["sign"] == b"POINTCACHE2" and head["version"] == 1, "PC2: another header")
    require(head["start"] == 0 and head["rate"] == 1, "PC2: sample i is not frame i")
    return np.frombuffer(data, "<f4", offset=32).reshape(head["samples"], head["points"], 3)


def read_mdd(path):
    data = path.read_bytes()
    frames, points = np.frombuffer(data, ">i4", 2)
    times = np.frombuffer(data, ">f4", frames, 8)
    return times, np.frombuffer(data, ">f4", offset=8 + 4 * frames).reshape(frames, points, 3)


def read_base(path):
    """Positions, material coordinates and faces of an OBJ file."""
    rows = {"v": [], "vt": [], "f": []}
    for line in path.read_text().splitlines():
        word, *values = line.split()
        if word in rows:
            rows[word].append([float(value.split("/")[0]) for value in values])
    return np.array(rows["v"]), np.array(rows["vt"]), np.array(rows["f"], int) - 1


def main():
    run_dir, frames_per_second = Path(sys.argv[1]), float(sys.argv[2])
    frames = [read_ply(path) for path in sorted(run_dir.glob("frames/cloth_*.ply"))]
    chosen = (0, len(frames) // 2, len(frames) - 1)
    positions, material, faces = read_base(run_dir / "cloth_base.obj")
    require(np.array_equal(faces, frames[0][1]["vertices"]), "the base mesh has other faces than frame 0")
    require(np.array_equal(positions, frames[0][0]["x"]), "the base mesh is not at frame 0")
    times, mdd = read_mdd(run_dir / "cloth.mdd")
    require(np.allclose(times, np.arange(len(frames)) / frames_per_second, rtol=1e-6, atol=0), "MDD: other times")
    pc2 = read_pc2(run_dir / "cloth.pc2")
    require(len(pc2) == len(mdd) == len(frames), f"{len(pc2)} and {len(mdd)} samples of {len(frames)} frames")
    require(any(not np.array_equal(f[0]["id"], frames[0][0]["id"]) for f in frames),
            "no mesh of this run changes: the test shows nothing")
    for i in chosen:
        wanted = sample(frames[i], material)
        for name, cache in (("PC2", pc2), ("MDD", mdd)):
            error = np.abs(cache[i] - wanted).max()
            require(error < FLOAT_TOLERANCE, f"{name} in frame {i}: points differ by {error} m")
    print(f"formats: PC2 and MDD at {len(chosen)} frames: the PLY frames' cloth at the same material points")


if __name__ == "__main__":
    main()
