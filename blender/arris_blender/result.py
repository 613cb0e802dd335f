# SPDX-License-Identifier: MIT
"""The simulated cloth in the scene: an object whose mesh changes, or a Mesh Cache modifier on the cloth's object.

Operators make and remove it, so that undo covers it. While a run goes on only the number of frames changes.
"""

from pathlib import Path

import bpy

from .placements import place
from .playback import fill_mesh, update_object
from .point_cache import CACHE_FILE
from .run_files import ArrisError, count_frames
from .sampling import MODIFIER
from .scene_export import RUN_FOLDER


def run_path(scene):
    """Of the run's folder, as Blender keeps paths: // is the folder of the .blend file."""
    return scene.arris.folder.rstrip("/\\") + "/" + RUN_FOLDER


def is_same_folder(path, run_folder):
    return Path(bpy.path.abspath(path)).resolve() == run_folder


def find_result(scene, run_folder):
    """The object that shows the frames of a run, or None."""
    for thing in scene.objects:
        if thing.type == "MESH" and "arris_folder" in thing and is_same_folder(thing["arris_folder"], run_folder):
            return thing
    return None


def find_modifier(scene, record):
    cloth = scene.objects.get(record["cloth"])
    return cloth and cloth.modifiers.get(MODIFIER)


def set_hidden(thing, is_hidden):
    thing.hide_set(is_hidden)
    thing.hide_render = is_hidden


def remove_result(scene, record, run_folder):
    """Removes what shows the run, and shows the cloth's object again."""
    result, cloth, modifier = find_result(scene, run_folder), scene.objects.get(record["cloth"]), \
        find_modifier(scene, record)
    if result is not None:
        mesh = result.data
        bpy.data.objects.remove(result)
        if not mesh.users:
            bpy.data.meshes.remove(mesh)
        if cloth is not None:
            set_hidden(cloth, False)
    if modifier:
        cloth.modifiers.remove(modifier)


def show_meshes(scene, record, run_folder, arrays=None):
    """Makes the object that shows frames. `arrays` is the mesh to begin with where there is no frame yet."""
    cloth = scene.objects.get(record["cloth"])
    name = f"{record['cloth']} simulated"
    result = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    for collection in (cloth.users_collection if cloth else [scene.collection]):
        if scene.collection == collection or collection in scene.collection.children_recursive:
            collection.objects.link(result)
    result.scale = (1.0 / record["unit"],) * 3
    result["arris_folder"] = run_path(scene)
    result["arris_start"] = record["start"]
    result["arris_name"], result["arris_suffix"] = "cloth", "ply"
    result["arris_uv_scale"], result["arris_is_reversed"] = record["uv_scale"], bool(record["is_reversed"])
    result["arris_frames"] = count_frames(run_folder, "cloth", "ply") if arrays is None else 0
    if arrays is None:
        update_object(result, scene.frame_current)
    else:
        fill_mesh(result.data, place(record["matrices"][0], arrays.points), arrays.corners, arrays.counts)
    for material in (cloth.data.materials if cloth else []):
        result.data.materials.append(material)
    if cloth is not None:
        set_hidden(cloth, True)
    scene.render.use_lock_interface = True  # else the window draws a mesh while a render replaces it


def move_modifier(cloth, modifier, index):
    names = [m.name for m in cloth.modifiers]
    if names.index(modifier.name) != index:
        with bpy.context.temp_override(object=cloth):
            bpy.ops.object.modifier_move_to_index(modifier=modifier.name, index=index)


def show_cache(scene, record, run_folder):
    """Puts the Mesh Cache behind the modifiers that were applied: behind all of them, or before all."""
    cloth = scene.objects.get(record["cloth"])
    if cloth is None:
        raise ArrisError(f"{record['cloth']}: the cloth of the run is not in this scene; show the result as meshes")
    modifier = cloth.modifiers.get(MODIFIER)
    if modifier is None:
        modifier = cloth.modifiers.new(MODIFIER, "MESH_CACHE")
        if not record["use_modifiers"]:
            move_modifier(cloth, modifier, 0)
    modifier.cache_format = "PC2"
    modifier.filepath = run_path(scene) + "/" + CACHE_FILE
    modifier.frame_start = record["start"]


def show_result(scene, record, run_folder, arrays=None):
    """Shows a run as the scene's setting says; nothing of it is shown twice."""
    is_cache = scene.arris.result == "CACHE"
    if not is_cache or not find_modifier(scene, record):
        remove_result(scene, record, run_folder)
    elif find_result(scene, run_folder):
        raise AssertionError("a result is shown in both ways")
    if is_cache:
        show_cache(scene, record, run_folder)
    else:
        show_meshes(scene, record, run_folder, arrays)


def refresh_result(scene, record, run_folder):
    """New frames have arrived: what shows them, if it is still there, shows them."""
    result, modifier = find_result(scene, run_folder), find_modifier(scene, record)
    if result is not None:
        known, result["arris_frames"] = result["arris_frames"], count_frames(run_folder, "cloth", "ply")
        frame = scene.frame_current - record["start"]
        if result["arris_frames"] and (frame >= known or not known) and result.mode != "EDIT":
            update_object(result, scene.frame_current)
    if modifier:
        modifier.id_data.update_tag()
