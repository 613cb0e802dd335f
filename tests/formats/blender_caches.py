# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares Blender's Mesh Cache modifier with the PC2 and MDD caches of a run, at two frames and between two.

usage: blender -b --factory-startup --python-exit-code 1 --python blender_caches.py -- RUN_DIR FRAMES_PER_SECOND
"""
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
import numpy as np
from caches import read_mdd, read_pc2

TOLERANCE = 1e-6  # m: both sides are floats, of a cloth within 4 m of the origin


def import_cloth(run_dir, kind, frames_per_second):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.fps = frames_per_second
    bpy.ops.import_scene.obj(filepath=str(run_dir / "cloth_base.obj"), axis_forward="Y", axis_up="Z", split_mode="OFF")
    cloth, = bpy.context.selected_objects
    cache = cloth.modifiers.new("cache", "MESH_CACHE")
    cache.cache_format = kind
    cache.filepath = str(run_dir / f"cloth.{kind.lower()}")
    cache.frame_start = 0
    return cloth


def shown_points(cloth, frame):
    bpy.context.scene.frame_set(int(frame), subframe=frame - int(frame))
    mesh = cloth.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    points = np.empty(3 * len(mesh.vertices), "f4")
    mesh.vertices.foreach_get("co", points)
    return points.reshape(-1, 3)


def main():
    run_dir, frames_per_second = Path(sys.argv[-2]), int(sys.argv[-1])
    for kind, samples in (("PC2", read_pc2(run_dir / "cloth.pc2")), ("MDD", read_mdd(run_dir / "cloth.mdd")[1])):
        cloth = import_cloth(run_dir, kind, frames_per_second)
        middle, last = len(samples) // 2, len(samples) - 1
        for frame in (0, middle + 0.25, last):
            low, share = int(frame), frame - int(frame)
            wanted = (1 - share) * samples[low] + share * samples[min(low + 1, last)]
            error = np.abs(shown_points(cloth, frame) - wanted).max()
            if not error < TOLERANCE:
                sys.exit(f"test_point_caches: {kind} at frame {frame}: points differ by {error} m")
    print("blender: Mesh Cache at 3 frames of PC2 and MDD: as in the caches")


main()
