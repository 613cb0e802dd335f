# SPDX-License-Identifier: MIT
"""The operators of the panel. Whatever the user can cause ends with one line, which names object and setting."""

import shlex

import bpy
from bpy.props import BoolProperty, StringProperty

from . import background_run, findings
from .placements import is_singular
from .point_cache import convert_cache, write_first_sample
from .program import find_program
from .result import remove_result, require_modifiable, show_result
from .run_files import ArrisError, count_frames
from .sampling import SceneError
from .scene_export import (RUN_FOLDER, SCENE_FILE, make_record, read_record, resolve_folder, run_folder_of,
                           write_scene)
from .settings import keep_folder


def commands(scene, program="arris"):
    """The command lines that do without Blender what the panel does, by their purpose."""
    folder = resolve_folder(scene)
    words = {"check": [program, "check", str(folder / SCENE_FILE)],
             "run": [program, "run", str(folder / SCENE_FILE), "-o", str(folder / RUN_FOLDER), "--overwrite"],
             "resume": [program, "resume", str(folder / RUN_FOLDER)]}
    return words


def prepare(context):
    """Before the scene is written."""
    leave_edit_mode(context)
    keep_folder(context.scene)


def leave_edit_mode(context):
    """Ends the mode in which Blender keeps edits out of the mesh."""
    if context.object is not None and context.object.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")


class ArrisOperator:
    """Reports an ArrisError in one line, beside the panel's findings."""

    def execute(self, context):
        scene = context.scene
        try:
            return self.act(context, scene) or {"FINISHED"}
        except (ArrisError, OSError) as error:
            self.report({"ERROR"}, str(error))
            findings.findings[scene.name] = [findings.Finding("ERROR", getattr(error, "thing", ""),
                                                                  getattr(error, "text", str(error)))]
            findings.summaries[scene.name] = ""
            return {"CANCELLED"}


class WriteScene(ArrisOperator, bpy.types.Operator):
    """Write the scene file and its meshes, to go on without Blender"""

    bl_idname = "arris.write_scene"
    bl_label = "Write Scene"
    bl_options = {"REGISTER"}

    def act(self, context, _scene):
        prepare(context)
        written = write_scene(context)
        self.report({"INFO"}, f"{written.scene_file} has been written")


class Check(ArrisOperator, bpy.types.Operator):
    """Write the scene and say what is wrong with it. Faces that cross are selected"""

    bl_idname = "arris.check"
    bl_label = "Check"
    bl_options = {"REGISTER", "UNDO"}

    def act(self, context, scene):
        program = find_program()[0]
        prepare(context)
        written = write_scene(context)
        found, is_good = findings.run_check(program, written, make_record(scene, written))
        found += findings.select_crossings(written, scene.arris.cloth)
        findings.findings[scene.name] = found
        errors = sum(f.severity == "ERROR" for f in found)
        warnings = len(found) - errors
        findings.summaries[scene.name] = "The scene can be simulated" if is_good else "The scene cannot be simulated"
        kind = "ERROR" if errors else "WARNING" if warnings else "INFO"
        first = f": {found[0]}" if found else ""
        self.report({kind}, f"{findings.summaries[scene.name]}; errors: {errors}, warnings: {warnings}{first}")


class SelectFinding(bpy.types.Operator):
    """Select the object that this message is about"""

    bl_idname = "arris.select_object"
    bl_label = "Select Object"
    bl_options = {"REGISTER", "UNDO"}

    name: StringProperty()

    def execute(self, context):
        thing = next((t for t in context.view_layer.objects if t.name_full == self.name), None)
        if thing is None:
            self.report({"ERROR"}, f"{self.name}: is no longer in this view layer")
            return {"CANCELLED"}
        leave_edit_mode(context)
        for other in context.selected_objects:
            other.select_set(False)
        thing.select_set(True)
        context.view_layer.objects.active = thing
        return {"FINISHED"}


class RunOperator(ArrisOperator):
    """Base of Simulate and Resume."""

    wait: BoolProperty(name="Wait", default=False, options={"HIDDEN", "SKIP_SAVE"},
                       description="Return when the run has ended, as Blender without a window needs")

    def follow(self, run):
        if not self.wait:
            return {"FINISHED"}
        background_run.wait_for(run)
        if run.problem:
            raise SceneError(run.concerned, run.problem)
        self.report({"INFO"}, run.describe())
        return {"FINISHED"}


class Simulate(RunOperator, bpy.types.Operator):
    """Write the scene and simulate it in the background. Replaces an earlier run in the folder"""

    bl_idname = "arris.simulate"
    bl_label = "Simulate"
    bl_options = {"UNDO"}  # not REGISTER, which would offer to simulate again with other settings

    def act(self, context, scene):
        program = find_program()[0]
        prepare(context)
        run_folder = run_folder_of(scene)
        background_run.require_idle(run_folder)
        is_cache = scene.arris.result == "CACHE"
        written = write_scene(context)
        record = make_record(scene, written)
        if is_cache:
            require_modifiable(scene.arris.cloth)
        if is_cache and any(is_singular(matrix[:, :3]) for matrix in record["matrices"]):
            raise SceneError(record["cloth"], "has a scale of 0, so a point cache cannot move it; show the result as "
                                              "meshes, or apply the scale")
        findings.findings.pop(scene.name, None)
        run = background_run.start(commands(scene, program)["run"], run_folder, record)
        if is_cache:
            write_first_sample(run_folder, record)
        show_result(scene, record, run_folder, written.samples.cloth)
        return self.follow(run)


class Resume(RunOperator, bpy.types.Operator):
    """Continue the run in the folder from its last checkpoint, with the scene as it was when it was started"""

    bl_idname = "arris.resume"
    bl_label = "Resume"
    bl_options = {"UNDO"}

    def act(self, context, scene):
        program, run_folder = find_program()[0], run_folder_of(scene)
        background_run.require_idle(run_folder)
        if not (run_folder / "checkpoint").exists():
            raise ArrisError(f"{run_folder}: holds no run to resume; use Simulate")
        record = read_record(run_folder)
        show_stored(scene, run_folder, record)
        return self.follow(background_run.start(commands(scene, program)["resume"], run_folder, record))


class Stop(ArrisOperator, bpy.types.Operator):
    """End the simulation within its step. Resume continues it"""

    bl_idname = "arris.stop"
    bl_label = "Stop"
    bl_options = {"REGISTER"}

    folder: StringProperty(name="Folder", options={"HIDDEN", "SKIP_SAVE"},
                           description="Folder of the run; empty: that of the scene")

    def act(self, _context, scene):
        folder = self.folder or str(run_folder_of(scene))
        run = background_run.find_run(folder)
        if run is None or run.is_over:
            others = [path for path, other in background_run.runs.items() if not other.is_over]
            raise ArrisError(f"{folder}: no simulation that this Blender has started is running" +
                             (f" here; running: {', '.join(others)}" if others else ""))
        run.interrupt()


def show_stored(scene, run_folder, record):
    """Shows the frames that are on disk."""
    if not count_frames(run_folder, "cloth", "ply"):
        raise ArrisError(f"{run_folder}: has no frames yet")
    show_result(scene, record, run_folder)


class ShowResult(ArrisOperator, bpy.types.Operator):
    """Show the run in the folder as the setting Result says"""

    bl_idname = "arris.show_result"
    bl_label = "Show Result"
    bl_options = {"REGISTER", "UNDO"}

    def act(self, _context, scene):
        run_folder = run_folder_of(scene)
        record = read_record(run_folder)
        if scene.arris.result == "CACHE":
            export = background_run.start_export(find_program()[0], run_folder)
            if export.wait() != 0:
                raise ArrisError(f"{run_folder}: arris export --formats pc2 ended with status {export.returncode}")
            convert_cache(run_folder, record)
        show_stored(scene, run_folder, record)


class ClearResult(ArrisOperator, bpy.types.Operator):
    """Remove what shows the run and show the cloth again. The files stay"""

    bl_idname = "arris.clear_result"
    bl_label = "Clear Result"
    bl_options = {"REGISTER", "UNDO"}

    def act(self, _context, scene):
        run_folder = run_folder_of(scene)
        remove_result(scene, read_record(run_folder), run_folder)


class CopyCommand(ArrisOperator, bpy.types.Operator):
    """Copy this command line to the clipboard"""

    bl_idname = "arris.copy_command"
    bl_label = "Copy Command"
    bl_options = {"REGISTER"}

    purpose: StringProperty(default="run")

    def act(self, context, scene):
        try:
            program = find_program()[0]
        except ArrisError:
            program = "arris"
        command = shlex.join(commands(scene, program)[self.purpose])
        context.window_manager.clipboard = command
        self.report({"INFO"}, f"Copied: {command}")


class AddPin(bpy.types.Operator):
    """Add a pin, which holds vertices of the cloth"""

    bl_idname = "arris.add_pin"
    bl_label = "Add Pin"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        settings = context.scene.arris
        pin = settings.pins.add()
        settings.pin_index = len(settings.pins) - 1
        pin.start = pin.release = context.scene.frame_current
        groups = settings.cloth.vertex_groups if settings.cloth else []
        if len(groups):
            pin.vertex_group = groups[settings.cloth.vertex_groups.active_index].name
        return {"FINISHED"}


class RemovePin(bpy.types.Operator):
    """Remove the pin"""

    bl_idname = "arris.remove_pin"
    bl_label = "Remove Pin"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return len(context.scene.arris.pins) > 0

    def execute(self, context):
        settings = context.scene.arris
        settings.pins.remove(settings.pin_index)
        settings.pin_index = max(min(settings.pin_index, len(settings.pins) - 1), 0)
        return {"FINISHED"}


CLASSES = (WriteScene, Check, SelectFinding, Simulate, Resume, Stop, ShowResult, ClearResult, CopyCommand, AddPin,
           RemovePin)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
    findings.findings.clear()
    findings.summaries.clear()
