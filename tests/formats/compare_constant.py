#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares PC2, MDD and glTF, read by three.js, with a run's PLY frames: the cloth at the same material points.

usage: compare_constant.py RUN_DIR FRAMES_PER_SECOND
"""
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
from caches import read_mdd, read_pc2
from compare import HERE, read_ply, require

GLTF_TOLERANCE = 1e-5  # m: also sums of floats, and time a millionth before the end
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


def read_base(path):
    """Positions, material coordinates and faces of an OBJ file."""
    rows = {"v": [], "vt": [], "f": []}
    for line in path.read_text().splitlines():
        word, *values = line.split()
        if word in rows:
            rows[word].append([float(value.split("/")[0]) for value in values])
    return np.array(rows["v"]), np.array(rows["vt"]), np.array(rows["f"], int) - 1


def check_gltf(run_dir, frames, frames_per_second):
    """Khronos's validator accepts the file. At frames and half between two, three.js shows cloth and obstacles."""
    path = run_dir / "cloth.glb"
    done = subprocess.run(["node", str(HERE / "validate_gltf.mjs"), str(path)], capture_output=True, text=True,
                          timeout=60, check=False)
    require(done.returncode == 0, f"glTF is not valid:\n{done.stderr[-2000:]}")
    middle, last = len(frames) // 2, len(frames) - 1
    chosen = (0, middle, middle + 0.5, last)
    times = [str(i / frames_per_second) for i in chosen]
    done = subprocess.run(["node", str(HERE / "read_gltf.mjs"), str(path), *times], capture_output=True, text=True,
                          timeout=60, check=False)
    require(done.returncode == 0, f"three.js did not read {path}:\n{done.stderr[-2000:]}")
    shown = json.loads(done.stdout)
    material = frames[0][0]["u"]
    moved = 0.0
    for i, time in zip(chosen, times):
        got = shown[time]
        low, share = int(i), i - int(i)
        wanted = (1 - share) * sample(frames[low], material) + share * sample(frames[min(low + 1, last)], material)
        require(np.array_equal(got["faces"], frames[0][1]["vertices"].ravel()), "glTF: other faces")
        require(np.array_equal(np.array(got["uv"], "f4"), material.astype("f4").ravel()), "glTF: other UVs")
        error = np.abs(np.array(got["points"]) - to_y_up(wanted)).max()
        require(error < GLTF_TOLERANCE, f"glTF at frame {i}: points differ by {error} m")
        if share == 0:
            matrix = np.array(got["nodes"]["spinner"]).reshape(4, 4).T
            first = read_base(run_dir / "frames/spinner_00000.obj")[0]
            now = read_base(run_dir / f"frames/spinner_{low:05d}.obj")[0]
            at_first = np.array(shown[times[0]]["nodes"]["spinner"]).reshape(4, 4).T
            own = np.linalg.solve(at_first, homogeneous(to_y_up(first)).T)
            error = np.abs((matrix @ own)[:3].T - to_y_up(now)).max()
            require(error < GLTF_TOLERANCE, f"glTF at frame {i}: the obstacle is {error} m off")
            moved = max(moved, np.abs(now - first).max())
    require(moved > 1e-3, "the obstacle of this run does not move: the test shows nothing")
    return f"glTF at {len(chosen)} times"


def to_y_up(points):
    return points[:, [0, 2, 1]] * [1, 1, -1]


def homogeneous(points):
    return np.column_stack([points, np.ones(len(points))])


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
    gltf = check_gltf(run_dir, frames, frames_per_second)
    print(f"formats: PC2 and MDD at {len(chosen)} frames, {gltf}: the PLY frames' cloth at the same material points")


if __name__ == "__main__":
    main()
