# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes for the tests of the add-on, made by Blender's own operators, and what the tests ask of them."""
import subprocess
import sys
import tomllib
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "formats"))
from ply_frames import read_ply  # noqa: E402


def require(holds, message):
    if not holds:
        print(f"test_blender: {message}", file=sys.stderr)
        raise SystemExit(1)


def install(add_on, program):
    """As a user does: the zip, the check mark, the path of the program."""
    bpy.ops.preferences.addon_install(filepath=str(add_on), overwrite=True)
    bpy.ops.preferences.addon_enable(module="arris_blender")
    bpy.context.preferences.addons["arris_blender"].preferences.program = str(program)


def empty_scene(path=None):
    """A scene without objects; saved, as a folder beside the .blend file needs."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    install_again()
    if path is not None:
        bpy.ops.wm.save_as_mainfile(filepath=str(path))
    return bpy.context.scene


installed = {}


def install_again():
    """Factory settings switch add-ons off."""
    if "arris_blender" not in bpy.context.preferences.addons:
        bpy.ops.preferences.addon_enable(module="arris_blender")
        bpy.context.preferences.addons["arris_blender"].preferences.program = installed["program"]


def add_grid(name, cells, size, location=(0, 0, 0)):
    """A square of `cells` x `cells` quads, with UVs."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=cells, y_subdivisions=cells, size=size, location=location)
    bpy.context.object.name = bpy.context.object.data.name = name
    return bpy.context.object


def collect(name, things):
    collection = bpy.data.collections.new(name)
    bpy.context.scene.collection.children.link(collection)
    for thing in things:
        for other in thing.users_collection:
            other.objects.unlink(thing)
        collection.objects.link(thing)
    return collection


def set_linear(thing):
    for curve in thing.animation_data.action.fcurves:
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"


def shown_points(thing):
    """World positions (m) of the evaluated object's vertices."""
    unit = bpy.context.scene.unit_settings.scale_length
    evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    points = np.empty(3 * len(mesh.vertices), "f4")
    mesh.vertices.foreach_get("co", points)
    evaluated.to_mesh_clear()
    matrix = np.array(thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world, float)
    return unit * (points.reshape(-1, 3).astype(float) @ matrix[:3, :3].T + matrix[:3, 3])


def read_obj_points(path):
    return np.array([line.split()[1:4] for line in path.read_text().splitlines() if line.startswith("v ")], "f8")


def frame_points(run_dir, k):
    vertices, _, _ = read_ply(run_dir / f"frames/cloth_{k:05d}.ply")
    return vertices["x"]


def read_pc2(path):
    data = path.read_bytes()
    points, samples = np.frombuffer(data, "<i4", 1, 16)[0], np.frombuffer(data, "<i4", 1, 28)[0]
    return np.frombuffer(data, "<f4", offset=32).reshape(samples, points, 3)


def distance_between(a, b):
    """Greatest distance from a point of either set to the other set (m)."""
    squares = ((a[:, None, :] - b[None, :, :]) ** 2).sum(axis=2)
    return float(np.sqrt(max(squares.min(axis=0).max(), squares.min(axis=1).max())))


def call(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    require(done.returncode == 0, f"{' '.join(map(str, command))}:\n{done.stdout[-1500:]}\n{done.stderr[-1500:]}")
    return done.stdout


def refused(operator, text, **words):
    """The operator ends with an error, in one line, that contains `text`."""
    try:
        outcome = operator(**words)
    except RuntimeError as error:
        said = str(error).strip()
        require(text in said, f"{operator.idname_py()}: says '{said}' instead of '... {text} ...'")
        require("Traceback" not in said and "\n" not in said, f"{operator.idname_py()}: says more than a line: {said}")
        return
    require(False, f"{operator.idname_py()}: is not refused with '{text}' but returns {outcome}")


def fresh(folder, name):
    """A square of cloth above a box, in a file of its own."""
    scene = empty_scene(folder / f"{name}.blend")
    scene.frame_start, scene.frame_end = 1, 4
    bpy.ops.mesh.primitive_cube_add(size=0.4, location=(0, 0, 0.3))
    box = bpy.context.object
    box.name = "Box"
    cloth = add_grid("Cloth", 4, 0.8, (0, 0, 0.6))
    scene.arris.cloth = cloth
    scene.arris.colliders = collect("Solids", [box])
    scene.arris.folder = f"//{name}"
    return scene, cloth, box


def written(scene):
    require(bpy.ops.arris.write_scene() == {"FINISHED"}, "the scene cannot be written")
    folder = Path(bpy.path.abspath(scene.arris.folder))
    return folder, tomllib.loads((folder / "scene.toml").read_text())


def run_tests(tests, add_on, program, folder):
    """Runs the functions test_... of a script, each with a folder of its own; returns their number."""
    installed["program"] = str(program)
    install(add_on, program)
    chosen = [(name, test) for name, test in tests.items() if name.startswith("test_")]
    for name, test in chosen:
        place = folder / name
        place.mkdir()
        test(place)
    return len(chosen)
