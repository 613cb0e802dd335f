# SPDX-License-Identifier: MIT
"""Blender add-on: imports the folder of an Arris run as one animated cloth mesh, with its obstacles.

The cloth's mesh changes from frame to frame, which no shape key or cache can hold. So a handler fills one mesh anew
from the frame's PLY file at each frame change. The .blend file therefore needs the run's folder and this add-on, and
memory does not grow with the number of frames. Obstacles come from the OBJ files of `arris export DIR --formats obj`.

An empty, named after the folder, is the parent of all objects. Its custom properties say where the folder is
(`arris_folder`; `//` is the folder of the .blend file) and the scene frame of the run's frame 0 (`arris_start`).
"""

import json
import re
import sys
from pathlib import Path

import bpy

try:
    import numpy as np
except ImportError as error:
    raise ImportError("the Arris add-on needs NumPy, which this Blender lacks; on Debian: "
                      "apt-get install python3-numpy") from error
from bpy.app.handlers import persistent
from bpy.props import BoolProperty, FloatProperty, IntProperty, StringProperty

bl_info = {
    "name": "Arris run",
    "author": "Arris contributors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "File > Import > Arris run",
    "description": "Imports cloth and obstacles of a run, animated",
    "category": "Import-Export",
}

FACETED_ANGLE = np.radians(30.0)  # obstacles: edges whose faces turn by more are shaded sharp
TYPES = {"double": "f8", "float": "f4", "int": "i4", "uint": "u4", "uchar": "u1"}


class ArrisError(Exception):
    """A folder or file that is not a run's. The message names it."""


# Files of a run


def read_header(data, path):
    """(format of each element's properties as written, number of it) by name, and where the binary part starts."""
    end = data.find(b"end_header\n")
    if not data.startswith(b"ply\nformat binary_little_endian 1.0\n") or end < 0:
        raise ArrisError(f"{path}: is not a binary PLY file")
    elements, fields = {}, None
    try:
        for words in (line.split() for line in data[:end].decode("ascii", "replace").splitlines()):
            if words[0] == "element":
                fields = []
                elements[words[1]] = (fields, int(words[2]))
            elif words[:2] == ["property", "list"]:  # every list of a frame has three entries, which read_frame checks
                fields += [(words[4] + "_count", "<" + TYPES[words[2]]), (words[4], "<" + TYPES[words[3]], 3)]
            elif words[0] == "property":
                fields.append((words[2], "<" + TYPES[words[1]]))
    except (IndexError, KeyError, ValueError, AttributeError) as error:
        raise ArrisError(f"{path}: has a damaged header") from error
    return elements, end + len(b"end_header\n")


def own_material(data, material):
    """Material coordinates in those of each piece of cloth. The header says where pieces lie in the frame's plane."""
    lines = (line.split() for line in data[:data.find(b"end_header\n")].decode("ascii", "replace").splitlines())
    pieces = [(float(words[4]), float(words[3])) for words in lines if words[:2] == ["comment", "piece"]]
    if pieces:
        begins, shifts = np.array(pieces).T
        material[:, 0] -= shifts[np.maximum(np.searchsorted(begins, material[:, 0], side="right") - 1, 0)]
    return material


def read_frame(path):
    """A frame's points (n x 3, m), faces (m x 3), UVs of their corners (m x 3 x 2, m) and EOL edges (k x 2)."""
    data = read_bytes(path)
    elements, offset = read_header(data, path)
    tables = {}
    try:
        for name, (fields, count) in elements.items():
            tables[name] = np.frombuffer(data, np.dtype(fields), count, offset)
            offset += tables[name].nbytes
        vertex, face, edge = tables["vertex"], tables["face"], tables["edge"]
        points = np.column_stack([vertex[name] for name in "xyz"])
        material = np.column_stack([vertex[name] for name in "uv"])
        corner_points = face["vertex_indices"]
        if "point" in tables:  # vertices on seams have several material points
            further = np.column_stack([tables["point"][name] for name in "uv"])
            material, corner_points = np.vstack([material, further]), face["point_indices"]
        material = own_material(data, material)
        edges = np.column_stack([edge["vertex1"], edge["vertex2"]])
        triangles, corners = face["vertex_indices"], face["vertex_indices_count"]
    except (IndexError, KeyError, ValueError) as error:
        raise ArrisError(f"{path}: is cut short, or is not a frame of cloth") from error
    for indices, count in ((triangles, len(points)), (edges, len(points)), (corner_points, len(material))):
        if indices.size and not (0 <= indices.min() and indices.max() < count):  # Blender checks no index
            raise ArrisError(f"{path}: has an index of a vertex that does not exist")
    if (corners != 3).any() or not np.isfinite(points).all():
        raise ArrisError(f"{path}: has a face that is no triangle, or a point that is not finite")
    return points, triangles, material[corner_points], edges


def read_obstacle(path):
    """Points (n x 3, m), faces (m x 3) and segments of wires (k x 2) of an obstacle's OBJ file."""
    rows = {"v": [], "f": [], "l": []}
    try:
        text = read_bytes(path).decode()
        for line in text.splitlines():
            words = line.split()
            if words and words[0] in rows:
                rows[words[0]].append([float(w) if words[0] == "v" else int(w) - 1 for w in words[1:]])
        points = np.array(rows["v"], float).reshape(-1, 3)
        if text.startswith("# Arris: m, y is up"):  # exported with --up y; Blender and the cloth's frames have z
            points = points[:, [0, 2, 1]] * (1, -1, 1)
        faces = np.array(rows["f"], np.int32).reshape(-1, 3)
        segments = np.array(rows["l"], np.int32).reshape(-1, 2)
    except ValueError as error:
        raise ArrisError(f"{path}: is not an obstacle as `arris export --formats obj` writes it") from error
    for indices in (faces, segments):
        if indices.size and not (0 <= indices.min() and indices.max() < len(points)):
            raise ArrisError(f"{path}: has an index of a vertex that does not exist")
    return points, faces, segments


def read_bytes(path):
    try:
        return path.read_bytes()
    except OSError as error:
        raise ArrisError(f"{path}: {error.strerror}") from error


def count_frames(folder, name, suffix):
    """Number of files NAME_00000, NAME_00001, ... in the run's folder; a gap is an error."""
    pattern = re.compile(re.escape(name) + r"_(\d{5,})\." + suffix)
    found = (pattern.fullmatch(path.name) for path in (folder / "frames").glob(f"{name}_*.{suffix}"))
    numbers = sorted(int(match[1]) for match in found if match)
    for expected, number in enumerate(numbers):
        if number != expected:
            raise ArrisError(f"{frame_path(folder, name, expected, suffix)}: is missing, though later frames exist")
    return len(numbers)


def frame_path(folder, name, number, suffix):
    return folder / "frames" / f"{name}_{number:05d}.{suffix}"


def read_report(folder):
    """Frames per second and the obstacles' names."""
    path = folder / "report.json"
    try:
        scene = json.loads(read_bytes(path))["scene"]
        return float(scene["output"]["frames_per_second"]), [o["name"] for o in scene.get("obstacle", [])]
    except (KeyError, TypeError, ValueError) as error:
        raise ArrisError(f"{path}: is not the report of a run") from error


# Meshes


def fill_mesh(mesh, points, faces, segments=()):
    """Replaces all geometry of `mesh`; its materials stay."""
    mesh.clear_geometry()
    mesh.vertices.add(len(points))
    mesh.vertices.foreach_set("co", np.ascontiguousarray(points, np.float32).ravel())
    mesh.edges.add(len(segments))
    if len(segments):
        mesh.edges.foreach_set("vertices", np.ascontiguousarray(segments, np.int32).ravel())
    mesh.loops.add(3 * len(faces))
    mesh.loops.foreach_set("vertex_index", np.ascontiguousarray(faces, np.int32).ravel())
    mesh.polygons.add(len(faces))
    mesh.polygons.foreach_set("loop_start", np.arange(0, 3 * len(faces), 3, dtype=np.int32))
    if bpy.app.version < (3, 6, 0):  # later versions derive it
        mesh.polygons.foreach_set("loop_total", np.full(len(faces), 3, np.int32))
    mesh.polygons.foreach_set("use_smooth", np.ones(len(faces), bool))
    mesh.update(calc_edges=True)


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


def show_cloth(mesh, path):
    points, faces, uvs, folds = read_frame(path)
    fill_mesh(mesh, points, faces)
    layer = mesh.uv_layers.new(name="UVMap", do_init=False)
    layer.data.foreach_set("uv", uvs.astype(np.float32).ravel())
    set_folds(mesh, find_edges(mesh, folds))


def show_obstacle(mesh, path):
    points, faces, segments = read_obstacle(path)
    fill_mesh(mesh, points, faces, segments)
    split_normals(mesh, FACETED_ANGLE)


SHOW = {"ply": show_cloth, "obj": show_obstacle}


def update_object(thing, frame):
    """Fills the mesh of a cloth or moving obstacle for the scene's `frame`; before and after the run it rests."""
    root = thing["arris_run"]
    number = min(max(frame - root["arris_start"], 0), thing["arris_frames"] - 1)
    folder = Path(bpy.path.abspath(root["arris_folder"]))
    suffix = thing["arris_suffix"]
    SHOW[suffix](thing.data, frame_path(folder, thing["arris_name"], number, suffix))


@persistent
def update_scene(scene, *_):
    """The handler: before Blender evaluates a frame. What cannot be read is said, and the last mesh stays."""
    for thing in scene.objects:
        root = thing.get("arris_run")
        if root is None or thing.get("arris_frames", 0) < 2:
            continue
        try:
            update_object(thing, scene.frame_current)
            root.pop("arris_problem", None)
        except ArrisError as error:
            root["arris_problem"] = str(error)
            print(f"Arris: {error}", file=sys.stderr)


@persistent
def update_loaded(*_):
    for scene in bpy.data.scenes:
        update_scene(scene)


# Import


def add_object(context, root, name, count, suffix):
    mesh = bpy.data.meshes.new(name)
    thing = bpy.data.objects.new(name, mesh)
    context.collection.objects.link(thing)
    thing.parent = root
    thing["arris_run"] = root
    thing["arris_name"] = name
    thing["arris_suffix"] = suffix
    thing["arris_frames"] = count
    update_object(thing, context.scene.frame_current)
    return thing


def import_run(context, folder, start, scale, set_scene):
    """Returns the cloth, and the names of obstacles without OBJ files."""
    folder = Path(folder).resolve()
    count = count_frames(folder, "cloth", "ply")
    if count == 0:
        raise ArrisError(f"{folder}: has no frames (frames/cloth_00000.ply); choose the folder of a run")
    rate, names = read_report(folder)
    counts = {name: count_frames(folder, name, "obj") for name in names}
    for name, files in counts.items():  # an obstacle that never moves has one file
        if files not in (0, 1, count):
            raise ArrisError(f"{folder}: has {files} OBJ files of {name} and {count} frames of the cloth; "
                             f"export them anew: arris export {folder} --formats obj")

    scene = context.scene
    if set_scene:
        scene.render.fps = max(1, round(rate))
        scene.render.fps_base = scene.render.fps / rate
        scene.frame_start, scene.frame_end = start, start + count - 1
        scene.frame_set(start)
    scene.render.use_lock_interface = True  # else the window draws a mesh while a render replaces it
    root = bpy.data.objects.new(folder.name, None)
    context.collection.objects.link(root)
    root.scale = (scale, scale, scale)
    root["arris_folder"] = str(folder)
    root["arris_start"] = start
    try:
        for name in names:
            if counts[name]:
                add_object(context, root, name, counts[name], "obj")
        cloth = add_object(context, root, "cloth", count, "ply")
    except ArrisError:
        for thing in [*root.children, root]:  # nothing of a run that cannot be read stays
            bpy.data.objects.remove(thing)
        raise
    return cloth, [name for name in names if not counts[name]]


class ImportArrisRun(bpy.types.Operator):
    """Import cloth and obstacles of an Arris run, animated"""

    bl_idname = "import_scene.arris_run"
    bl_label = "Import Arris run"
    bl_options = {"REGISTER", "UNDO"}

    directory: StringProperty(name="Folder", description="Folder of the run", subtype="DIR_PATH")
    filter_folder: BoolProperty(default=True, options={"HIDDEN"})
    start: IntProperty(name="First frame", description="Scene frame of the run's frame 0", default=1)
    scale: FloatProperty(name="Scale", description="Units of the scene in a metre", default=1.0, min=1e-6, max=1e6)
    set_scene: BoolProperty(name="Set frame rate and range", default=True,
                            description="Take the scene's frame rate, first and last frame from the run")

    def invoke(self, context, _event):
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context):
        folder = bpy.path.abspath(self.directory)
        try:
            cloth, missing = import_run(context, folder, self.start, self.scale, self.set_scene)
        except ArrisError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        context.view_layer.objects.active = cloth
        if missing:
            self.report({"WARNING"}, f"No OBJ files of {', '.join(missing)}, left out; to make them: "
                                     f"arris export {Path(folder).resolve()} --formats obj")
        return {"FINISHED"}


def add_menu_entry(menu, _context):
    menu.layout.operator(ImportArrisRun.bl_idname, text="Arris run")


def register():
    bpy.utils.register_class(ImportArrisRun)
    bpy.types.TOPBAR_MT_file_import.append(add_menu_entry)
    bpy.app.handlers.frame_change_pre.append(update_scene)
    bpy.app.handlers.load_post.append(update_loaded)


def unregister():
    bpy.app.handlers.load_post.remove(update_loaded)
    bpy.app.handlers.frame_change_pre.remove(update_scene)
    bpy.types.TOPBAR_MT_file_import.remove(add_menu_entry)
    bpy.utils.unregister_class(ImportArrisRun)
