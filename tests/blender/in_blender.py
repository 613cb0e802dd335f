# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender: imports a run, dumps its meshes at some frames, saves, loads and dumps again, renders.

usage: blender -b --factory-startup --python in_blender.py -- (import|load) ADDON RUN_DIR OUTPUT_DIR FRAME...
`import` writes saved.blend, which `load`, in a Blender of its own, opens. Scene frame = FRAME + START.
"""
import sys
from pathlib import Path

import bpy
import numpy as np

START = 5  # scene frame of the run's frame 0


def add_on(path):
    bpy.ops.preferences.addon_install(filepath=path, overwrite=True)
    bpy.ops.preferences.addon_enable(module="arris_blender")


def array_of(collection, attribute, size, kind):
    values = np.empty(size * len(collection), kind)
    collection.foreach_get(attribute, values)
    return values.reshape(-1, size) if size > 1 else values


def evaluated(name):
    """What is rendered: the object as the dependency graph has it."""
    return bpy.data.objects[name].evaluated_get(bpy.context.evaluated_depsgraph_get())


def dump(path):
    cloth = evaluated("cloth").data
    arrays = {
        "points": array_of(cloth.vertices, "co", 3, "f4"),
        "faces": array_of(cloth.loops, "vertex_index", 1, "i4").reshape(-1, 3),
        "edges": array_of(cloth.edges, "vertices", 2, "i4"),
        "sharp": array_of(cloth.edges, "use_edge_sharp", 1, bool),
        "crease": array_of(cloth.edges, "crease", 1, "f4"),
        "smooth": array_of(cloth.polygons, "use_smooth", 1, bool),
        "uv": array_of(cloth.uv_layers["UVMap"].data, "uv", 2, "f4"),
        "box": array_of(evaluated("box").data.vertices, "co", 3, "f4"),
        "materials": np.array([m.name for m in cloth.materials]),
        "fps": np.array(bpy.context.scene.render.fps / bpy.context.scene.render.fps_base),
        "range": np.array([bpy.context.scene.frame_start, bpy.context.scene.frame_end]),
        "counts": np.array([len(bpy.data.meshes), len(bpy.data.objects)]),
    }
    np.savez(path, **arrays)


def require_refused(directory, text):
    try:
        bpy.ops.import_scene.arris_run(directory=str(directory))
    except RuntimeError as error:
        if text in str(error):
            return
    sys.exit(f"{directory} is not refused with '{text}'")


def render(path, scene):
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples = "CPU", 1
    scene.cycles.use_denoising = False  # Debian's Blender has no denoiser
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 64, 48, 100
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = str(path / "picture_")
    bpy.ops.render.render(animation=True)


def main():
    verb, add_on_path, run_dir, output, *frames = sys.argv[sys.argv.index("--") + 1:]
    output, frames = Path(output), [int(f) for f in frames]
    add_on(add_on_path)
    if verb == "import":
        require_refused(output, "has no frames")
        bpy.ops.object.select_all(action="SELECT")
        bpy.ops.object.delete()
        bpy.ops.import_scene.arris_run(directory=run_dir, start=START)
        bpy.data.objects["cloth"].data.materials.append(bpy.data.materials.new("linen"))
    else:
        bpy.ops.wm.open_mainfile(filepath=str(output / "saved.blend"))
    scene = bpy.context.scene
    for frame in frames:
        scene.frame_set(frame + START)
        dump(output / f"{verb}_{frame}.npz")
    if verb == "import":
        bpy.ops.wm.save_as_mainfile(filepath=str(output / "saved.blend"))
        return
    bpy.ops.object.light_add(type="SUN", location=(0, 0, 3))
    bpy.ops.object.camera_add(location=(0.3, -1.6, 1.2), rotation=(1.0, 0, 0))
    scene.camera = bpy.context.object
    scene.frame_start, scene.frame_end = frames[0] + START, frames[-1] + START
    scene.frame_step = frames[-1] - frames[0]
    render(output, scene)
    root = bpy.data.objects["cloth"].parent
    root["arris_folder"] = str(output)  # a folder that has moved
    scene.frame_set(START)
    if "cloth_00000.ply" not in root.get("arris_problem", ""):
        sys.exit("a frame that is missing is not named")


main()
