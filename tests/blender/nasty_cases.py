# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender: what a user can get wrong is refused in one line that names object and setting.

usage: blender -b --factory-startup --python nasty_cases.py -- ADDON.zip PROGRAM FOLDER
"""
import math
import stat
import sys
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
import blender_scenes as scenes  # noqa: E402
from blender_scenes import fresh, refused, require, written  # noqa: E402

TOLERANCE = 1e-6  # m, as in live_scene.py
check, simulate = bpy.ops.arris.check, bpy.ops.arris.simulate


def test_choices(folder):
    scene, cloth, box = fresh(folder, "choices")
    scene.arris.cloth = None
    refused(check, "Cloth: choose a mesh object")
    refused(simulate, "Cloth: choose a mesh object", wait=True)
    scene.arris.cloth = box
    refused(check, "Box: is the cloth and in the collection of colliders, Solids")
    scene.arris.cloth = cloth
    cloth.select_set(True)
    bpy.ops.object.delete()
    refused(check, "Cloth: Cloth: the object is not in the view layer")
    scene.frame_end = scene.frame_start
    refused(check, "Frame range: the last frame, 1, must be after the first, 1")
    require(not (folder / "choices").exists(), "a refused scene leaves a folder")


def test_meshes(folder):
    scene, cloth, box = fresh(folder, "meshes")
    empty = bpy.data.objects.new("Nothing", bpy.data.meshes.new("Nothing"))
    scene.collection.objects.link(empty)
    scene.arris.cloth = empty
    refused(check, "Nothing: Cloth: the mesh has no faces")
    scene.arris.colliders.objects.link(empty)
    scene.arris.cloth = cloth
    refused(check, "Nothing: is a collider without vertices")
    bpy.data.objects.remove(empty)
    cloth.data.vertices[7].co.x = math.nan
    refused(check, "Cloth: vertex 7 is not at a finite place")
    cloth.data.vertices[7].co.x = 0.0
    scene.arris.cloth.scale = (1, 1, 0)
    scene.arris.result = "CACHE"
    refused(simulate, "Cloth: has a scale of 0", wait=True)


def test_loose_edge(folder):
    """A loose edge of the cloth is no cloth, which a warning on the cloth says; its vertices are told apart."""
    scene, cloth, _ = fresh(folder, "loose")
    mesh = cloth.data
    mesh.vertices.add(2)
    mesh.vertices[-2].co, mesh.vertices[-1].co = (0.5, 0.5, 0.2), (0.5, 0.5, 0.4)
    mesh.edges.add(1)
    mesh.edges[-1].vertices = (len(mesh.vertices) - 2, len(mesh.vertices) - 1)
    mesh.update()
    require(check() == {"FINISHED"}, "a loose edge stops the check")
    from arris_blender.findings import findings
    told = [f for f in findings[scene.name] if "belong to no face" in f.text]
    require(told and told[0].thing == "Cloth", f"nothing says that the edge is loose: {findings[scene.name]}")
    group = cloth.vertex_groups.new(name="all")
    group.add([0, len(mesh.vertices) - 1], 1.0, "REPLACE")
    bpy.ops.arris.add_pin()
    scene.arris.result = "CACHE"
    require(simulate(wait=True) == {"FINISHED"}, "a loose edge stops the run")
    scene.frame_set(4)
    points = scenes.shown_points(cloth)
    require(np.abs(points[-2:] - [[0.5, 0.5, 0.8], [0.5, 0.5, 1.0]]).max() < TOLERANCE, "the loose edge moves")
    require(points[1:-2, 2].max() < 0.6, "the cloth does not move")


def test_folders(folder):
    scene, _, _ = fresh(folder, "folders")
    (folder / "a file").write_text("")
    scene.arris.folder = "//a file"
    refused(check, "cannot be written")
    scene.arris.folder = "/proc/none"
    refused(check, "Folder: /proc/none cannot be written")
    scene.arris.folder = "//a folder with spaces & 'quotes'"
    require(check() == {"FINISHED"}, "a folder with spaces is refused")
    scenes.empty_scene()
    bpy.context.scene.arris.cloth = scenes.add_grid("Cloth", 2, 1.0)
    refused(check, "which has not been saved; save it")


def test_changing_collider(folder):
    scene, _, box = fresh(folder, "changing")
    build = box.modifiers.new("Build", "BUILD")
    build.frame_start, build.frame_duration = -4, 20
    refused(check, "Box: has ")
    box.modifiers.clear()
    box.hide_set(True)
    require(check() == {"FINISHED"}, "a hidden collider stops the check")
    from arris_blender.findings import findings
    require(any(f.thing == "Box" and "hidden" in f.text for f in findings[scene.name]), "a hidden collider is not told")


def test_left_out(folder):
    """What the collection of colliders holds and the cloth does not collide with is named, except what moves others."""
    scene, cloth, box = fresh(folder, "left")
    rig = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    kinds = {"Lamp": bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "POINT")), "Rig": rig,
             **{name: bpy.data.objects.new(name, None) for name in ("Empty", "Parent", "Instance")}}
    for thing in kinds.values():
        scene.arris.colliders.objects.link(thing)
    box.parent = kinds["Parent"]
    kinds["Instance"].instance_type = "COLLECTION"
    kinds["Instance"].instance_collection = bpy.data.collections.new("Source")
    require(check() == {"FINISHED"}, "objects of other kinds stop the check")
    from arris_blender.findings import findings
    told = {f.thing: f.text for f in findings[scene.name]}
    require(set(told) == {"Lamp", "Empty", "Instance"}, f"messages about {told}")
    require("kind light" in told["Lamp"] and "Make Instances Real" in told["Instance"], f"{told}")
    scene.arris.colliders = bpy.data.collections.new("Nothing")
    require(check() == {"FINISHED"}, "an empty collection stops the check")
    told = [f.text for f in findings[scene.name]]
    require(told == ["Colliders: the collection Nothing has no object that the cloth can collide with"], f"{told}")
    scene.arris.colliders = None
    require(check() == {"FINISHED"} and not findings[scene.name], "a scene without colliders is warned of")


def test_pins(folder):
    scene, cloth, box = fresh(folder, "pins")
    bpy.ops.arris.add_pin()
    pin = scene.arris.pins[0]
    refused(check, "Cloth: Pins: a pin has no vertex group")
    pin.vertex_group = "gone"
    refused(check, "Cloth: Pins: there is no vertex group 'gone'")
    group = cloth.vertex_groups.new(name="corner")
    pin.vertex_group = "corner"
    group.add([0, 1], 0.5, "REPLACE")
    refused(check, "Cloth: Pins: no vertex of the group 'corner' has a weight above 0.5")
    group.add([0, 1], 0.51, "REPLACE")
    _, toml = written(scene)
    require(toml["pin"] == [{"vertices": [0, 1]}], f"pin {toml['pin']}")
    pin.use_release, pin.release = True, 1
    refused(check, "Pins: 'corner' is released at frame 1")
    pin.use_release = False
    bpy.ops.object.empty_add(location=(0, 0, 1))
    hand = bpy.context.object
    hand.name = "Hand"
    pin.target = hand
    for frame, scale in ((1, 1.0), (4, 2.0)):
        hand.scale = (scale,) * 3
        hand.keyframe_insert("scale", frame=frame)
    refused(check, "Hand: Pins: 'corner' follows an object whose scale changes")
    pin.bone = "wrist"
    refused(check, "Hand: Pins: there is no bone 'wrist'")
    pin.bone = ""
    bpy.ops.object.select_all(action="DESELECT")
    hand.select_set(True)
    bpy.ops.object.delete()
    refused(check, "Hand: Pins: the object that 'corner' follows is not in this scene")
    pin.target = box
    _, toml = written(scene)
    require(toml["pin"][0]["follow"] == "Box", "a pin does not follow its collider")


def test_linked_cloth(folder):
    """A linked object keeps no modifier; a library override of it does."""
    library = folder / "library.blend"
    fresh(folder, "library")[1].modifiers.new("Bend", "SIMPLE_DEFORM")
    bpy.ops.wm.save_mainfile()
    scene, _, _ = fresh(folder, "linked")
    with bpy.data.libraries.load(str(library), link=True) as (_, chosen):
        chosen.objects = ["Cloth"]
    linked = chosen.objects[0]
    scene.collection.objects.link(linked)
    scene.arris.cloth, scene.arris.result = linked, "CACHE"
    bpy.context.view_layer.update()
    refused(simulate, "Cloth [library.blend]: is linked, and would lose the modifier", wait=True)
    require(not (folder / "linked/run").exists(), "a run begins")
    scene.arris.result = "MESHES"
    require(simulate(wait=True) == {"FINISHED"} and linked.hide_get(), "a linked cloth is not replaced by meshes")
    scene.arris.result = "CACHE"
    refused(bpy.ops.arris.show_result, "Cloth [library.blend]: is linked, and would lose the modifier")
    require("Cloth simulated" in bpy.data.objects, "a refused cache removes the meshes")
    bpy.ops.arris.clear_result()
    scene.arris.cloth = own = linked.override_create(remap_local_usages=True)
    require(simulate(wait=True) == {"FINISHED"}, "a library override cannot be simulated")
    name = own.name
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
    require(bpy.data.objects[name].modifiers.keys() == ["Arris", "Bend"], "a library override loses its modifier")


def test_curved(folder):
    scene, cloth, _ = fresh(folder, "curved")
    cloth.data.vertices[12].co.z = 0.1
    while cloth.data.uv_layers:
        cloth.data.uv_layers.remove(cloth.data.uv_layers[0])
    refused(check, "The scene cannot be simulated; errors: 1")
    from arris_blender.findings import findings
    told = findings[scene.name]
    require(told[0].severity == "ERROR" and told[0].thing == "Cloth" and "unwrap" in told[0].text, f"{told}")
    refused(simulate, told[0].text, wait=True)
    require(findings[scene.name] == told[:1], f"Simulate says {findings[scene.name]}, and Check {told[:1]}")
    require("Cloth simulated" not in bpy.data.objects and not cloth.hide_get(), "a refused run hides the cloth")
    cloth.data.vertices[12].co.z = 0.0
    require(simulate(wait=True) == {"FINISHED"}, "flat cloth without UVs is refused")


def test_edit_mode(folder):
    """What is being edited counts, and the mode does not stop the panel."""
    scene, cloth, box = fresh(folder, "edit")
    bpy.context.view_layer.objects.active = cloth
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.transform.translate(value=(0, 0, 0.25))
    path, _ = written(scene)
    require(abs(scenes.read_obj_points(path / "cloth.obj")[:, 2].max() - 0.85) < TOLERANCE, "an edit is not simulated")
    box.name = "face"  # a word of messages
    bpy.ops.object.mode_set(mode="EDIT")
    require(simulate(wait=True) == {"FINISHED"}, "edit mode stops the simulation")
    result = bpy.data.objects["Cloth simulated"]
    bpy.context.view_layer.objects.active = result
    bpy.ops.object.mode_set(mode="EDIT")
    scene.frame_set(4)
    require("leave it" in result["arris_problem"], "nothing says why no frame is shown")
    bpy.ops.object.mode_set(mode="OBJECT")
    scene.frame_set(3)
    require("arris_problem" not in result, "the problem stays")


def test_overlap(folder):
    """Messages name faces as Blender numbers them."""
    scene, cloth, box = fresh(folder, "overlap")
    box.name = "face"  # is not what these messages are about
    layer = cloth.data.uv_layers.active.data
    for polygon in (cloth.data.polygons[2], cloth.data.polygons[9]):
        for corner, uv in zip(polygon.loop_indices, ((3, 3), (4, 3), (4, 4), (3, 4))):
            layer[corner].uv = uv
    refused(check, "Cloth: face 2 (at ")
    refused(check, "and face 9 (at ")


def test_crossings(folder):
    """The cloth begins in the box: an error on it, and the 8 faces that the box's sides cut are selected."""
    scene, cloth, box = fresh(folder, "crossing")
    cloth.location = (0.07, 0.05, 0.4)
    refused(check, "The scene cannot be simulated")
    from arris_blender.findings import findings
    told = findings[scene.name]
    require(any(f.severity == "ERROR" and f.thing == "Box" for f in told), f"{told}")
    chosen = {tuple(round(x, 2) for x in cloth.matrix_world @ p.center)[:2] for p in cloth.data.polygons if p.select}
    wanted = {(x, y) for x in (-0.23, -0.03, 0.17) for y in (-0.25, -0.05, 0.15)} - {(-0.03, -0.05)}
    require(chosen == wanted, f"faces with middles at {sorted(chosen)} are selected")
    require(all(p.select == (abs(p.normal.z) < 0.5) for p in box.data.polygons), "other faces of the box are selected")
    bpy.ops.arris.select_object(name="Box")
    require(bpy.context.object == box, "the object concerned is not selected")
    cloth.location.z, box.name = 0.6, "crossings"  # as the file of crossing faces could be called
    require(check() == {"FINISHED"}, "the name of a collider is refused")


def fake_program(folder, name, body):
    path = folder / name
    path.write_text(f"#!/bin/sh\n{body}\n")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return str(path)


def test_programs(folder):
    scene, cloth, _ = fresh(folder, "programs")
    preferences = bpy.context.preferences.addons["arris_blender"].preferences
    good = preferences.program
    is_version = 'if [ "$1" = --version ]; then echo arris'
    for path, text in ((str(folder / "nowhere"), "is not there or cannot be run"),
                       (fake_program(folder, "other", "echo other"), "is not arris"),
                       (fake_program(folder, "old", "echo arris 0.0.9"), "has version 0.0.9"),
                       (fake_program(folder, "crash", f"{is_version} 0.1.0; else kill -SEGV $$; fi"), "status -11")):
        preferences.program = path
        refused(check, text)
        refused(simulate, text, wait=True)
        require("Cloth simulated" not in bpy.data.objects and not cloth.hide_get(), "a failed run hides the cloth")
    preferences.program = good
    require(simulate(wait=True) == {"FINISHED"}, "the program is not found again")


ADD_ON, PROGRAM, FOLDER = map(Path, sys.argv[sys.argv.index("--") + 1:])
print(f"Blender: {scenes.run_tests(dict(globals()), ADD_ON, PROGRAM, FOLDER)} nasty cases")
