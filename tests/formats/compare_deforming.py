#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares an obstacle that deforms, in OBJ files and as OpenUSD, VTK and three.js read it, with its PC2 cache.

Frame i of the run is sample i of the cache, and the obstacle has neither placement nor motion.
usage: compare_deforming.py RUN_DIR OBSTACLE CACHE FRAMES_PER_SECOND
"""
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
from caches import read_pc2
from compare import HERE, read_usd, read_vtp, require
from compare_constant import read_base, to_y_up
from vtkmodules.util.numpy_support import vtk_to_numpy

TOLERANCE = 1e-5  # m: sums of floats, and in glTF time a millionth before the end


def require_near(got, wanted, what):
    require(got.shape == wanted.shape, f"{what}: {len(got)} points")
    error = np.abs(got - wanted).max()
    require(error < TOLERANCE, f"{what}: points differ by {error} m")


def mean_at(samples, time):
    low = int(time)
    share = time - low
    return samples[low] if share == 0 else (1 - share) * samples[low] + share * samples[low + 1]


def check_usd(run_dir, name, samples, times):
    read = read_usd(run_dir / "cloth.usda", [float(t) for t in times])
    for time in times:
        surface = read[str(float(time))][f"/arris/obstacles/{name}/surface"]
        require_near(np.array(surface["points"]).reshape(-1, 3), mean_at(samples, time), f"USD at time code {time}")


def check_gltf(run_dir, name, samples, times, frames_per_second):
    path = run_dir / "cloth.glb"
    done = subprocess.run(["node", str(HERE / "validate_gltf.mjs"), str(path)], capture_output=True, text=True,
                          timeout=60, check=False)
    require(done.returncode == 0, f"glTF is not valid:\n{done.stderr[-2000:]}")
    seconds = [str(time / frames_per_second) for time in times]
    done = subprocess.run(["node", str(HERE / "read_gltf.mjs"), str(path), *seconds], capture_output=True, text=True,
                          timeout=60, check=False)
    require(done.returncode == 0, f"three.js did not read {path}:\n{done.stderr[-2000:]}")
    shown = json.loads(done.stdout)
    for time, second in zip(times, seconds):
        require_near(np.array(shown[second]["meshes"][name]), to_y_up(mean_at(samples, time)), f"glTF at frame {time}")


def main():
    run_dir, name, cache, frames_per_second = Path(sys.argv[1]), sys.argv[2], Path(sys.argv[3]), float(sys.argv[4])
    count = len(list(run_dir.glob("frames/cloth_*.ply")))
    samples = read_pc2(cache)[:count].astype("f8")
    require(np.abs(samples[-1] - samples[0]).max() > 0.01, "the obstacle hardly deforms: the test shows nothing")
    frames = (0, count // 2, count - 1)
    for i in frames:
        obj = read_base(run_dir / f"frames/{name}_{i:05d}.obj")[0]
        require_near(obj, samples[i], f"OBJ in frame {i}")
        vtp = read_vtp(run_dir / f"frames/{name}_{i:05d}.vtp")
        require_near(vtk_to_numpy(vtp.GetPoints().GetData()), samples[i], f"VTK in frame {i}")
    times = (*frames[:2], count // 2 + 0.5, frames[2])
    check_usd(run_dir, name, samples, times)
    check_gltf(run_dir, name, samples, times, frames_per_second)
    print(f"formats: OBJ and VTK at {len(frames)} frames, USD and glTF at {len(times)} times: the cache of {name}")


if __name__ == "__main__":
    main()
