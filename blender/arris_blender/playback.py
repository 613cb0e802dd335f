# SPDX-License-Identifier: MIT
"""Shows frames of a run in meshes that a handler fills anew at each frame change.

The cloth's mesh changes from frame to frame, which no shape key or cache can hold. The .blend file therefore needs the
run's folder and this add-on, and memory does not grow with the number of frames.

Custom properties say where a mesh comes from. On an imported run's empty, or on the result of a simulation itself:
`arris_folder`, the folder (`//` is that of the .blend file), and `arris_start`, the scene frame of the run's frame 0.
On each mesh: `arris_name` and `arris_suffix` of its files, and `arris_frames`, the number of frames; on the result of a
simulation `arris_uv_scale`, the length of a unit of its UVs (m), and `arris_is_reversed`.
"""

import sys
from contextlib import contextmanager
from pathlib import Path

import bmesh
import bpy
import numpy as np
from bpy.app.handlers import persistent

from .run_files import ArrisError, count_frames, frame_path, read_frame, read_obstacle

FACETED_ANGLE = np.radians(30.0)  # obstacles: edges whose faces turn by more are shaded sharp
paused = [False]  # while the scene is sampled, whose frames need no result


def fill_mesh(mesh, points, corners, counts, segments=()):
    """Replaces all geometry of `mesh`; its materials stay. `counts` are the corners of each face."""
    mesh.clear_geometry()
    mesh.vertices.add(len(points))
    mesh.vertices.foreach_set("co", np.ascontiguousarray(points, np.float32).ravel())
    mesh.edges.add(len(segments))
    if len(segments):
        mesh.edges.foreach_set("vertices", np.ascontiguousarray(segments, np.int32).ravel())
    mesh.loops.add(len(corners))
    mesh.loops.foreach_set("vertex_index", np.ascontiguousarray(corners, np.int32))
    mesh.polygons.add(len(counts))
    mesh.polygons.foreach_set("loop_start", np.ascontiguousarray(np.cumsum(counts) - counts, np.int32))
    if bpy.app.version < (3, 6, 0):  # later versions derive it
        mesh.polygons.foreach_set("loop_total", np.ascontiguousarray(counts, np.int32))
    mesh.polygons.foreach_set("use_smooth", np.ones(len(counts), bool))
    mesh.update(calc_edges=True)


def fill_triangles(mesh, points, faces, segments=()):
    fill_mesh(mesh, points, faces.ravel(), np.full(len(faces), 3, np.int32), segments)


def find_edges(mesh, pairs):
    """Whether each edge of `mesh` is one of `pairs` of vertices."""
    vertices = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", vertices)
    size = max(len(mesh.vertices), 1)
    key = lambda edges: np.sort(edges, axis=1).astype(np.int64) @ np.array([size, 1])
    return np.isin(key(vertices.reshape(-1, 2)), key(np.asarray(pairs).reshape(-1, 2)))


def set_folds(mesh, is_fold):
    """Folds of the cloth over sharp edges are shaded sharp, and stay where they are under subdivision."""
    mesh.edges.foreach_set("use_edge_sharp", is_fold)
    if bpy.app.version < (4, 0, 0):
        mesh.edges.foreach_set("crease", is_fold.astype(np.float32))
    else:
        crease = mesh.attributes.new("crease_edge", "FLOAT", "EDGE")
        crease.data.foreach_set("value", is_fold.astype(np.float32))
    split_normals(mesh, np.pi)


def split_normals(mesh, angle):
    """Shades edges sharp that are marked so, or whose faces turn by more than `angle` (radians)."""
    if bpy.app.version < (4, 1, 0):
        mesh.use_auto_smooth = True
        mesh.auto_smooth_angle = angle
    elif angle < np.pi:
        mesh.set_sharp_from_angle(angle=angle)


@contextmanager
def fillable_mesh(thing):
    """The mesh to fill. Blender 3.4 ignores foreach_set on a linked mesh, so a local one is filled and copied to it."""
    mesh = thing.data
    if mesh.library is None:
        yield mesh
        return
    local = bpy.data.meshes.new(mesh.name)
    try:
        yield local
        copy = bmesh.new()
        copy.from_mesh(local)
        copy.to_mesh(mesh)
        copy.free()
        if bpy.app.version < (4, 1, 0):
            mesh.use_auto_smooth, mesh.auto_smooth_angle = local.use_auto_smooth, local.auto_smooth_angle
        mesh.update()
    finally:
        bpy.data.meshes.remove(local)


def show_cloth(thing, path):
    points, faces, uvs, folds = read_frame(path)
    uvs = uvs / thing.get("arris_uv_scale", 1.0)
    if thing.get("arris_is_reversed", False):  # the object's faces run the other way round
        faces, uvs = faces[:, ::-1], uvs[:, ::-1]
    with fillable_mesh(thing) as mesh:
        fill_triangles(mesh, points, faces)
        layer = mesh.uv_layers.new(name="UVMap", do_init=False)
        layer.data.foreach_set("uv", uvs.astype(np.float32).ravel())
        set_folds(mesh, find_edges(mesh, folds))


def show_obstacle(thing, path):
    points, faces, segments = read_obstacle(path)
    with fillable_mesh(thing) as mesh:
        fill_triangles(mesh, points, faces, segments)
        split_normals(mesh, FACETED_ANGLE)


SHOW = {"ply": show_cloth, "obj": show_obstacle}


def run_of(thing):
    """The object whose properties name the run of which `thing` shows a part; None if it shows none."""
    if thing.type != "MESH" or "arris_frames" not in thing:
        return None
    return thing if "arris_folder" in thing else thing.get("arris_run")


def folder_of(root):
    """The run's folder; // is that of the file in which the object is, which may be a library."""
    return Path(bpy.path.abspath(root["arris_folder"], library=root.library))


def update_object(thing, frame):
    """Fills the mesh of a cloth or moving obstacle for the scene's `frame`; before and after the run it rests."""
    root = run_of(thing)
    if thing.mode == "EDIT":  # Blender crashes where the mesh changes under its editor
        raise ArrisError(f"{thing.name}: shows no frames in edit mode; leave it")
    number = min(max(frame - root["arris_start"], 0), thing["arris_frames"] - 1)
    suffix = thing["arris_suffix"]
    SHOW[suffix](thing, frame_path(folder_of(root), thing["arris_name"], number, suffix))


def recount_frames(result):
    """Counts the frames of a result again, while its simulation writes them."""
    try:
        result["arris_frames"] = max(count_frames(folder_of(result), "cloth", "ply"), result["arris_frames"])
    except ArrisError as error:
        result["arris_problem"] = str(error)


@persistent
def update_scene(scene, *_):
    """The handler: before Blender evaluates a frame. What cannot be read is said, and the last mesh stays."""
    if paused[0]:
        return
    for thing in scene.objects:
        root = run_of(thing)
        if root is None or thing["arris_frames"] < (1 if root == thing else 2):  # a still obstacle is filled once
            continue
        try:
            update_object(thing, scene.frame_current)
            root.pop("arris_problem", None)
            scene.render.use_lock_interface = True  # also of a scene to which the object was appended or linked
        except ArrisError as error:
            root["arris_problem"] = str(error)
            print(f"Arris: {error}", file=sys.stderr)


@persistent
def update_all(*_):
    """After a file is loaded, and after undo and redo: a run may have gone on since that state."""
    for scene in bpy.data.scenes:
        for thing in scene.objects:
            if run_of(thing) == thing:
                recount_frames(thing)
        update_scene(scene)


@contextmanager
def pause_playback():
    paused[0] = True
    try:
        yield
    finally:
        paused[0] = False


HANDLERS = (("frame_change_pre", update_scene), ("load_post", update_all), ("undo_post", update_all),
            ("redo_post", update_all))


def register():
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)


def unregister():
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).remove(handler)
