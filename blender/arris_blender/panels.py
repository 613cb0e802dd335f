# SPDX-License-Identifier: MIT
"""The panels: Properties > Scene > Arris Cloth, and Properties > Object > Arris Collider."""

import shlex
import textwrap

import bpy
from bpy.props import FloatProperty

from . import background_run, findings
from .operators import commands
from .point_cache import find_cache_modifier
from .result import find_result
from .run_files import ArrisError, count_frames, read_status
from .scene_export import run_folder_of

UNITS_A_LETTER = 6.5  # of the window's width, at a scale of 1
MOST_FINDINGS = 20
RESUMABLE = {None, "interrupted", "io_error"}  # how a run may have ended
stored = {}           # run folder -> (time of its change, frames, status): panels are drawn often


def read_stored(run_folder):
    """(frames, status) of the run on disk; None if there is none."""
    try:
        time = max((run_folder / name).stat().st_mtime_ns for name in ("", "frames"))
    except OSError:
        return None
    if stored.get(run_folder, (None,))[0] != time:
        try:
            frames = count_frames(run_folder, "cloth", "ply")
        except ArrisError:
            frames = 0
        stored[run_folder] = time, frames, read_status(run_folder)
    _, frames, status = stored[run_folder]
    return (frames, status) if (run_folder / "checkpoint").exists() or frames else None


def wrapped(layout, context, text, icon="NONE"):
    """A text in as many lines as the panel's width needs."""
    letters = max(20, int(context.region.width / (UNITS_A_LETTER * context.preferences.system.ui_scale)) - 8)
    column = layout.column(align=True)
    column.scale_y = 0.8
    for number, line in enumerate(textwrap.wrap(text, letters) or [""]):
        column.label(text=line, icon=icon if number == 0 or icon == "NONE" else "BLANK1")


def draw_select(row, name):
    """The button that selects the object concerned, if there is one."""
    if name:
        row.operator("arris.select_object", text="", icon="RESTRICT_SELECT_OFF").name = name


class ScenePanel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "scene"


class ARRIS_PT_cloth(ScenePanel, bpy.types.Panel):
    bl_label = "Arris Cloth"

    def draw(self, context):
        scene, settings, layout = context.scene, context.scene.arris, self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        column = layout.column()
        column.prop(settings, "cloth")
        column.prop(settings, "colliders")
        column.prop(settings, "result")
        column.prop(settings, "folder")
        try:
            self.draw_run(context, scene, layout)
        except ArrisError as error:
            self.draw_buttons(layout)
            wrapped(layout, context, str(error), "ERROR")
        for run in background_run.find_stray_runs():
            row = layout.row()
            wrapped(row, context, f"Simulating in {run.run_folder}: {run.describe()}", "TIME")
            row.operator("arris.stop", text="", icon="CANCEL").folder = str(run.run_folder)
        self.draw_findings(context, scene, layout)

    def draw_buttons(self, layout):
        row = layout.row(align=True)
        row.operator("arris.check", icon="CHECKMARK")
        row.operator("arris.simulate", icon="PLAY")

    def draw_run(self, context, scene, layout):
        run_folder = run_folder_of(scene)
        run = background_run.find_run(run_folder)
        is_running = run is not None and not run.is_over
        if is_running:
            left = run.seconds_left()
            ends = "" if left is None else f", about {describe_seconds(left)} left"
            wrapped(layout, context, f"Simulating: {run.describe()}{ends}", "TIME")
            row = layout.row(align=True)
            row.prop(scene, "arris_progress", text="", slider=True)
            row.operator("arris.stop", icon="CANCEL")
            return
        self.draw_buttons(layout)
        on_disk = read_stored(run_folder)
        if run is not None and run.problem:
            row = layout.row()
            wrapped(row, context, run.describe(), "ERROR")
            draw_select(row, run.concerned)
        if on_disk is None:
            return
        frames, status = on_disk
        wrapped(layout, context, f"Run in the folder: {frames} frames, {status or 'not ended'}", "INFO")
        row = layout.row(align=True)
        if status in RESUMABLE:
            row.operator("arris.resume", icon="FRAME_NEXT")
        row.operator("arris.show_result", icon="HIDE_OFF")
        row.operator("arris.clear_result", icon="X")
        result = find_result(scene, run_folder)
        if result is not None and "arris_problem" in result:
            wrapped(layout, context, result["arris_problem"], "ERROR")

    def draw_findings(self, context, scene, layout):
        found = findings.findings.get(scene.name)
        if found is None:
            return
        box = layout.box()
        summary = findings.summaries.get(scene.name, "")
        if summary:
            box.label(text=summary, icon="CHECKMARK" if "cannot" not in summary else "CANCEL")
        for finding in found[:MOST_FINDINGS]:
            row = box.row()
            wrapped(row, context, str(finding), "ERROR" if finding.severity == "WARNING" else "CANCEL")
            draw_select(row, finding.thing)
        if len(found) > MOST_FINDINGS:
            box.label(text=f"and {len(found) - MOST_FINDINGS} more; the check command below shows them")


def percent_done(scene):
    """For the bar: of the run in the scene's folder."""
    try:
        run = background_run.find_run(run_folder_of(scene))
    except ArrisError:
        return 0.0
    return 100.0 * max(run.frames - 1, 0) / (run.record["frames"] - 1) if run else 0.0


def describe_seconds(seconds):
    if seconds >= 3600:
        return f"{seconds / 3600:.0f} h {seconds / 60 % 60:.0f} min"
    return f"{seconds / 60:.0f} min" if seconds >= 90 else f"{max(seconds, 1):.0f} s"


class SubPanel(ScenePanel):
    bl_parent_id = "ARRIS_PT_cloth"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        self.fill(self.layout, context, context.scene.arris)


def switched(layout, settings, switch, value, otherwise, name=None):
    """A number behind its switch, and what holds where it is off."""
    row = layout.row(heading=name or settings.bl_rna.properties[switch].name)
    row.prop(settings, switch, text="")
    if getattr(settings, switch):
        row.prop(settings, value, text="")
    else:
        row.label(text=otherwise)


class ARRIS_PT_fabric(SubPanel, bpy.types.Panel):
    bl_label = "Fabric"

    def fill(self, layout, _context, settings):
        layout.prop(settings, "preset")
        column = layout.column()
        for switch, value in (("use_density", "density"), ("use_stiffness", "stiffness"), ("use_bending", "bending")):
            switched(column, settings, switch, value, "of the fabric", settings.bl_rna.properties[value].name)
        column.prop(settings, "damping")
        column.prop(settings, "thickness")


class ARRIS_PT_mesh(SubPanel, bpy.types.Panel):
    bl_label = "Mesh"

    def fill(self, layout, context, settings):
        layout.prop(settings, "use_modifiers")
        switched(layout, settings, "use_uv_scale", "uv_scale", "as the mesh is")
        layout.prop(settings, "use_remesh")
        column = layout.column(align=True)
        column.active = settings.use_remesh
        column.prop(settings, "shortest_edge")
        column.prop(settings, "longest_edge")
        cache = find_cache_modifier(settings.cloth) if settings.cloth else None
        modifiers = list(settings.cloth.modifiers) if settings.cloth else []
        if settings.use_modifiers and len(modifiers) > 1 and cache == modifiers[0]:
            wrapped(layout, context, f"Only modifiers before {cache.name} are applied: move it down", "INFO")


class ARRIS_PT_pins(SubPanel, bpy.types.Panel):
    bl_label = "Pins"

    def fill(self, layout, _context, settings):
        row = layout.row()
        row.template_list("ARRIS_UL_pins", "", settings, "pins", settings, "pin_index", rows=3)
        column = row.column(align=True)
        column.operator("arris.add_pin", text="", icon="ADD")
        column.operator("arris.remove_pin", text="", icon="REMOVE")
        if not 0 <= settings.pin_index < len(settings.pins):
            return
        pin = settings.pins[settings.pin_index]
        column = layout.column()
        if settings.cloth is not None:
            column.prop_search(pin, "vertex_group", settings.cloth, "vertex_groups")
        column.prop(pin, "target")
        if pin.target is not None and pin.target.type == "ARMATURE":
            column.prop_search(pin, "bone", pin.target.data, "bones")
        switched(column, pin, "use_start", "start", "the first frame")
        switched(column, pin, "use_release", "release", "never")


class ARRIS_UL_pins(bpy.types.UIList):
    def draw_item(self, _context, layout, _data, pin, _icon, _active, _name, _index=0, _flag=0):
        target = f" on {pin.target.name}{' / ' + pin.bone if pin.bone else ''}" if pin.target else ""
        layout.label(text=(pin.vertex_group or "no vertex group") + target, icon="PINNED")


class ARRIS_PT_contact(SubPanel, bpy.types.Panel):
    bl_label = "Contact and Forces"

    def fill(self, layout, context, settings):
        switched(layout, settings, "use_friction", "friction", "none")
        layout.prop(settings, "use_self_contact")
        layout.prop(context.scene, "use_gravity")
        layout.prop(settings, "use_wind", text="Wind from force fields")
        layout.prop(settings, "time_step")


class ARRIS_PT_commands(SubPanel, bpy.types.Panel):
    bl_label = "Without Blender"

    def fill(self, layout, context, _settings):
        layout.operator("arris.write_scene", icon="FILE_TICK")
        try:
            lines = commands(context.scene)
        except ArrisError as error:
            wrapped(layout, context, str(error), "ERROR")
            return
        for purpose, words in lines.items():
            row = layout.row()
            wrapped(row, context, shlex.join(words))
            row.operator("arris.copy_command", text="", icon="COPYDOWN").purpose = purpose


class ARRIS_PT_collider(bpy.types.Panel):
    bl_label = "Arris Collider"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "object"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        colliders = context.scene.arris.colliders
        return colliders is not None and context.object in set(colliders.all_objects)

    def draw(self, context):
        layout, own = self.layout, context.object.arris
        layout.use_property_split = True
        layout.use_property_decorate = False
        switched(layout, own, "use_friction", "friction", "of the scene")
        switched(layout, own, "use_feature_angle", "feature_angle", "from 14°, if it deforms 45°")
        switched(layout, own, "use_slit", "slit", "none")


CLASSES = (ARRIS_UL_pins, ARRIS_PT_cloth, ARRIS_PT_fabric, ARRIS_PT_mesh, ARRIS_PT_pins, ARRIS_PT_contact,
           ARRIS_PT_commands, ARRIS_PT_collider)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Scene.arris_progress = FloatProperty(name="Progress", subtype="PERCENTAGE", min=0.0, max=100.0,
                                                   precision=0, get=percent_done,
                                                   description="Share of the frames that have been simulated")


def unregister():
    del bpy.types.Scene.arris_progress
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
