# SPDX-License-Identifier: MIT
"""The simulated cloth in the scene: an object whose mesh changes, or a Mesh Cache modifier on the cloth's object.

Operators make and remove it, so that undo covers it. While a run goes on only the number of frames changes.
"""

from pathlib import Path

import bpy

from .placements import place
from .playback import fill_mesh, fillable_mesh, folder_of, update_object
from .point_cache import CACHE_FILE, find_cache_modifier
from .run_files import ArrisError, count_frames
from .sampling import SceneError
from .scene_export import RUN_FOLDER, run_folders

MODIFIER = "Arris"


def run_path(scene):
    """Path of the run's folder, as Blender keeps paths: // is the folder of the .blend file."""
    return scene.arris.folder.rstrip("/\\") + "/" + RUN_FOLDER


def cache_path(modifier):
    return Path(bpy.path.abspath(modifier.filepath, library=modifier.id_data.library))


def find_result(scene, run_folder):
    """The object that shows the frames of a run, or None."""
    for thing in scene.objects:
        if thing.type == "MESH" and "arris_folder" in thing and folder_of(thing).resolve() == run_folder:
            return thing
    return None


def adopt_copy(scene, run_folder):
    """A full copy of a scene brings a copy of what shows the other scene's run; that copy now shows this scene's."""
    if find_result(scene, run_folder) is not None:
        return
    others = run_folders(other for other in bpy.data.scenes if other != scene)
    for thing in scene.objects:
        is_result = thing.type == "MESH" and "arris_folder" in thing and "arris_frames" in thing
        if is_result and thing.users_scene == (scene,) and folder_of(thing).resolve() in others:
            thing["arris_folder"] = run_path(scene)
            if thing.data.users > 1:
                thing.data = thing.data.copy()
            return


def find_modifier(scene, run_folder):
    """The Mesh Cache modifier that shows a run, or None."""
    for thing in scene.objects:
        modifier = find_cache_modifier(thing)
        if modifier is not None and cache_path(modifier).resolve() == run_folder / CACHE_FILE:
            return modifier
    return None


def find_cloth_object(scene, record, run_folder):
    """The object of which the run's cloth was made, also if it was renamed since; or None."""
    modifier = find_modifier(scene, run_folder)
    if modifier is not None:
        return modifier.id_data
    named = (thing for thing in scene.objects if thing.name_full == record["cloth"])
    chosen = scene.arris.cloth
    return next(named, chosen if chosen in set(scene.objects) else None)


def require_modifiable(cloth):
    """A point cache needs an object that keeps a modifier in this file."""
    if cloth.library is not None:
        raise SceneError(cloth, "is linked, and would lose the modifier that shows a point cache; make a library "
                                "override of it (Object > Library Override > Make), or show the result as meshes")


def set_hidden(scene, thing, is_hidden):
    for layer in scene.view_layers:
        if thing in set(layer.objects):
            thing.hide_set(is_hidden, view_layer=layer)
    thing.hide_render = is_hidden


def remove_meshes(scene, record, run_folder):
    """Removes the object that shows frames, and shows the cloth's object again."""
    result, cloth = find_result(scene, run_folder), find_cloth_object(scene, record, run_folder)
    if result is None:
        return
    mesh = result.data
    bpy.data.objects.remove(result)
    if not mesh.users:
        bpy.data.meshes.remove(mesh)
    if cloth is not None:
        set_hidden(scene, cloth, False)


def remove_cache(scene, run_folder):
    modifier = find_modifier(scene, run_folder)
    if modifier is not None:
        modifier.id_data.modifiers.remove(modifier)


def remove_result(scene, record, run_folder):
    """Removes what shows the run. Its files stay."""
    remove_meshes(scene, record, run_folder)
    remove_cache(scene, run_folder)


def make_object(scene, record, cloth):
    name = f"{cloth.name if cloth is not None else record['cloth']} simulated"
    result = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    for collection in (cloth.users_collection if cloth is not None else [scene.collection]):
        if collection == scene.collection or collection in scene.collection.children_recursive:
            collection.objects.link(result)
    for material in (cloth.data.materials if cloth is not None else []):
        result.data.materials.append(material)
    return result


def show_meshes(scene, record, run_folder, arrays=None):
    """Shows frames in an object, which keeps its materials and modifiers from run to run.

    `arrays` is the mesh to begin with where there is no frame yet.
    """
    cloth = find_cloth_object(scene, record, run_folder)
    result = find_result(scene, run_folder) or make_object(scene, record, cloth)
    result.scale = (1.0 / record["unit"],) * 3
    result["arris_folder"] = run_path(scene)
    result["arris_start"] = record["start"]
    result["arris_name"], result["arris_suffix"] = "cloth", "ply"
    result["arris_uv_scale"], result["arris_is_reversed"] = record["uv_scale"], bool(record["is_reversed"])
    result["arris_frames"] = count_frames(run_folder, "cloth", "ply") if arrays is None else 0
    if arrays is None:
        update_object(result, scene.frame_current)
    else:
        with fillable_mesh(result) as mesh:
            fill_mesh(mesh, place(record["matrices"][0], arrays.points), arrays.corners, arrays.counts)
    if cloth is not None:
        set_hidden(scene, cloth, True)
    scene.render.use_lock_interface = True  # else the window draws a mesh while a render replaces it


def move_modifier(cloth, modifier, index):
    names = [m.name for m in cloth.modifiers]
    if names.index(modifier.name) != index:
        with bpy.context.temp_override(object=cloth):
            bpy.ops.object.modifier_move_to_index(modifier=modifier.name, index=index)


def show_cache(scene, record, run_folder):
    """Puts the Mesh Cache behind the modifiers that were applied: behind all of them, or before all."""
    cloth = find_cloth_object(scene, record, run_folder)
    if cloth is None:
        raise ArrisError(f"{record['cloth']}: the cloth of the run is not in this scene; show the result as meshes")
    require_modifiable(cloth)
    modifier = find_cache_modifier(cloth)
    if modifier is None:
        modifier = cloth.modifiers.new(MODIFIER, "MESH_CACHE")
        if not record["use_modifiers"]:
            move_modifier(cloth, modifier, 0)
    modifier.cache_format = "PC2"
    modifier.filepath = run_path(scene) + "/" + CACHE_FILE
    modifier.frame_start = record["start"]


def show_result(scene, record, run_folder, arrays=None):
    """Shows a run in the way that the scene's setting says, and not in the other."""
    adopt_copy(scene, run_folder)
    if scene.arris.result == "CACHE":
        show_cache(scene, record, run_folder)
        remove_meshes(scene, record, run_folder)
    else:
        remove_cache(scene, run_folder)
        show_meshes(scene, record, run_folder, arrays)


def refresh_result(scene, record, run_folder):
    """New frames have arrived: what shows the run, if it is still there, shows them."""
    result, modifier = find_result(scene, run_folder), find_modifier(scene, run_folder)
    if result is not None:
        known, result["arris_frames"] = result["arris_frames"], count_frames(run_folder, "cloth", "ply")
        is_later = scene.frame_current - record["start"] >= known  # it has shown an earlier frame so far
        if result["arris_frames"] and (is_later or not known) and result.mode != "EDIT":
            update_object(result, scene.frame_current)
    if modifier is not None:
        modifier.id_data.update_tag()
