# SPDX-License-Identifier: MIT
"""File > Import > Arris run: the folder of a run as one animated cloth mesh, with its obstacles.

Obstacles come from the OBJ files of `arris export DIR --formats obj`. An empty, named after the folder, is the parent
of all objects and names the run (see playback.py).
"""

from pathlib import Path

import bpy
from bpy.props import BoolProperty, FloatProperty, IntProperty, StringProperty

from .playback import update_object
from .run_files import ArrisError, count_frames, read_report


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


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(add_menu_entry)
    bpy.utils.unregister_class(ImportArrisRun)
