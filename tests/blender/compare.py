#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares what Blender shows of a run with the run's PLY frames, before and after saving and loading.

usage: compare.py ADDON RUN_DIR FRAMES_PER_SECOND
"""
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "formats"))
from ply_frames import read_ply  # noqa: E402

HERE = Path(__file__).resolve().parent
START = 5  # as in in_blender.py


def require(holds, message):
    if not holds:
        sys.exit(f"test_blender: {message}")


def run_blender(verb, *words):
    done = subprocess.run(["blender", "-b", "--factory-startup", "--python-exit-code", "3", "--python",
                           str(HERE / "in_blender.py"), "--", verb, *map(str, words)],
                          capture_output=True, text=True, timeout=100, check=False)
    require(done.returncode == 0, f"Blender: {verb}:\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}")


def as_set(edges):
    return {tuple(sorted(map(int, edge))) for edge in edges}


def read_obj_points(path):
    text = path.read_text()
    points = np.array([line.split()[1:] for line in text.splitlines() if line.startswith("v ")], "f8")
    return np.c_[points[:, 0], -points[:, 2], points[:, 1]] if text.startswith("# Arris: m, y is up") else points


def check_frame(shown, run_dir, number, frame_count, frames_per_second):
    vertices, faces, edges = read_ply(run_dir / f"frames/cloth_{number:05d}.ply")
    require(np.array_equal(shown["points"], vertices["x"].astype("f4")), f"frame {number}: other points")
    require(np.array_equal(shown["faces"], faces["vertices"]), f"frame {number}: other faces")
    require(np.array_equal(shown["uv"], vertices["u"].astype("f4")[faces["vertices"].ravel()]),
            f"frame {number}: other UVs")
    require(as_set(shown["edges"][shown["sharp"]]) == as_set(edges), f"frame {number}: other sharp edges")
    require(as_set(shown["edges"][shown["crease"] == 1.0]) == as_set(edges), f"frame {number}: other creases")
    require(shown["smooth"].all(), f"frame {number}: faces that are not shaded smooth")
    box = read_obj_points(run_dir / f"frames/box_{number:05d}.obj")
    require(np.array_equal(shown["box"], box.astype("f4")), f"frame {number}: the obstacle is elsewhere")
    require(list(shown["materials"]) == ["linen"], f"frame {number}: the cloth has lost its material")
    require(abs(float(shown["fps"]) - frames_per_second) < 1e-4, f"{shown['fps']} frames per second")
    require(list(shown["range"]) == [START, START + frame_count - 1], f"frames {shown['range']}")
    require(shown["counts"][1] == 3, f"{shown['counts'][1]} objects")
    return len(vertices), as_set(edges), box


def main():
    add_on, run_dir, frames_per_second = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve(), float(sys.argv[3])
    count = len(list(run_dir.glob("frames/cloth_*.ply")))
    chosen = [0, count // 2, 3 * count // 4]  # later the cloth has slipped off
    with tempfile.TemporaryDirectory() as name:
        output = Path(name)
        for verb in ("import", "load"):
            run_blender(verb, add_on, run_dir, output, *chosen)
            shown = [np.load(output / f"{verb}_{i}.npz") for i in chosen]
            found = [check_frame(s, run_dir, i, count, frames_per_second) for s, i in zip(shown, chosen)]
            require(len({s["counts"][0].item() for s in shown}) == 1, "meshes pile up")
        require(len({size for size, _, _ in found}) > 1 and all(folds for _, folds, _ in found[1:]),
                "the frames have one mesh, or no EOL edges: the test shows nothing")
        require(np.abs(found[0][2] - found[2][2]).max() > 0.1, "the obstacle does not move: the test shows nothing")
        pictures = sorted(output.glob("picture_*.png"))
        require(len(pictures) == 2, f"{len(pictures)} pictures")
        first, last = (pixels_of(p) for p in pictures)
        require(first.std() > 5.0, "the picture is empty")
        changed = (np.abs(first - last).max(axis=2) > 20).mean()
        require(changed > 0.05, f"{changed:.1%} of the pixels differ between the first and the last frame")
    print(f"Blender: frames {chosen} as in the PLY frames, and so again after save and load; "
          f"{changed:.0%} of the pixels change")


def pixels_of(path):
    """Height x width x 3."""
    raw = subprocess.run(["ffmpeg", "-v", "error", "-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"],
                         capture_output=True, check=True).stdout
    return np.frombuffer(raw, "u1").reshape(48, 64, 3).astype(int)


if __name__ == "__main__":
    main()
