# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender: odd scales, parents, names, rates and units come out right in the scene file and in the result.

usage: blender -b --factory-startup --python scene_cases.py -- ADDON.zip PROGRAM FOLDER
"""
import math
import sys
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
import blender_scenes as scenes  # noqa: E402
from blender_scenes import fresh, refused, require, written  # noqa: E402

TOLERANCE = 1e-6  # m, as in live_scene.py
check, simulate = bpy.ops.arris.check, bpy.ops.arris.simulate


def turned(motion, points):
    axis = np.array(motion["rotate"]["axis"])
    angle = math.radians(motion["rotate"]["degrees"])
    axis = axis / np.linalg.norm(axis)
    k = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    rotation = np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * k @ k
    return points @ rotation.T + np.array(motion["translate"])


def placed_at_start(folder, obstacle):
    points = scenes.read_obj_points(folder / obstacle["file"])
    motion = obstacle["keyframes"][0] if "keyframes" in obstacle else obstacle
    return points if "deform" in obstacle else turned(motion, points)


def signed_volume(folder, obstacle):
    points, volume = placed_at_start(folder, obstacle), 0.0
    for line in (folder / obstacle["file"]).read_text().splitlines():
        if line.startswith("f "):
            corners = [points[int(word) - 1] for word in line.split()[1:]]
            volume += sum(np.dot(corners[0], np.cross(b, c)) for b, c in zip(corners[1:], corners[2:])) / 6
    return volume


def test_names(folder):
    scene, _, box = fresh(folder, "names")
    scene.name = 'Szene "1" \\ müde'
    names = ["cloth", "Tür mit \"Zarge\"", "Tur mit 'Zarge'", "3rd", "日本", "x" * 63]
    for name in names:
        copy = box.copy()
        copy.name = name
        scene.arris.colliders.objects.link(copy)
    scene.arris.folder = "//names"
    path, toml = written(scene)
    found = [o["name"] for o in toml["obstacle"]]
    require(len(set(found)) == len(names) + 1 and "cloth" not in found, f"names {found}")
    require(all((path / o["file"]).exists() for o in toml["obstacle"]), "meshes are missing")
    require(check() == {"FINISHED"}, "names are refused")


def test_placements(folder):
    """Colliders below parents with negative, uneven and changing scales are where Blender has them, faces outwards."""
    scene, cloth, box = fresh(folder, "placements")
    bpy.ops.object.empty_add(location=(0.1, 0.2, -0.3), rotation=(0.3, 0.2, 1.0))
    parent = bpy.context.object
    parent.scale = (-1.5, 0.7, 1.1)
    box.parent = parent
    box.rotation_euler = (0.4, 0.5, 0.6)  # with the parent's scale a shear
    bpy.context.view_layer.update()
    path, toml = written(scene)
    require("keyframes" not in toml["obstacle"][0] and "deform" not in toml["obstacle"][0], "a still box moves")
    require(np.abs(placed_at_start(path, toml["obstacle"][0]) - scenes.shown_points(box)).max() < TOLERANCE,
            "a sheared, mirrored box is elsewhere")
    require(signed_volume(path, toml["obstacle"][0]) > 0.01, "a mirrored box is inside out")
    parent.keyframe_insert("scale", frame=1)
    parent.scale = (-1.5, 1.7, 1.1)
    parent.keyframe_insert("scale", frame=4)
    path, toml = written(scene)
    require("deform" in toml["obstacle"][0], "a box whose scale changes is rigid")
    cache = scenes.read_pc2(path / "Box.pc2")
    for k in range(4):
        scene.frame_set(k + 1)
        require(np.abs(cache[k] - scenes.shown_points(box)).max() < TOLERANCE, f"frame {k}: the box is elsewhere")
    cloth.scale = (1, -2, 1)
    path, toml = written(scene)
    scene.frame_set(1)
    points = scenes.read_obj_points(path / "cloth.obj")
    require(np.abs(points - scenes.shown_points(cloth)).max() < TOLERANCE, "a mirrored cloth is elsewhere")
    require(abs(toml["cloth"]["uv_scale"] - math.sqrt(0.8 * 1.6)) < 1e-5, f"UV scale {toml['cloth']['uv_scale']}")


def test_linked_collider(folder):
    """A linked collider stays where it is, though a local one has its name, and messages tell one from the other."""
    scenes.empty_scene(folder / "library.blend")
    bpy.ops.mesh.primitive_cube_add(size=0.4, location=(0.7, 0, 0.8))
    bpy.context.object.name = "Box"
    scenes.collect("Linked", [bpy.context.object])
    bpy.ops.wm.save_mainfile()
    scene, cloth, box = fresh(folder, "links")
    with bpy.data.libraries.load(str(folder / "library.blend"), link=True) as (_, chosen):
        chosen.collections = ["Linked"]
    scene.arris.colliders.children.link(chosen.collections[0])
    group = cloth.vertex_groups.new(name="edge")
    group.add([0], 1.0, "REPLACE")
    bpy.ops.arris.add_pin()
    scene.arris.pins[0].target = other = chosen.collections[0].objects["Box"]
    path, toml = written(scene)
    middles = {o["name"]: placed_at_start(path, o).mean(axis=0) for o in toml["obstacle"]}
    require(sorted(round(float(m[0]), 4) for m in middles.values()) == [0.0, 0.7], f"boxes at {middles}")
    follows = toml["pin"][0]["follow"]
    require(abs(middles[follows][0] - 0.7) < TOLERANCE, f"the pin follows {follows}, the local box")
    other.location = (0.4, 0, 0.6)
    refused(check, "The scene cannot be simulated")
    from arris_blender.findings import findings
    told = {f.thing for f in findings[scene.name] if f.thing != "Cloth"}
    require(told == {"Box [library.blend]"}, f"messages about {told}")
    bpy.ops.arris.select_object(name="Box [library.blend]")
    require(bpy.context.object == other, "another object is selected")


def test_motion(folder):
    """Linear motion is two keyframes, and rest none."""
    scene, _, box = fresh(folder, "motion")
    scene.frame_end = 21
    for frame, x in ((1, 0.0), (21, 1.0)):
        box.location.x = x
        box.keyframe_insert("location", frame=frame)
    scenes.set_linear(box)
    _, toml = written(scene)
    require(len(toml["obstacle"][0]["keyframes"]) == 2, f"{len(toml['obstacle'][0]['keyframes'])} keyframes")
    for point in box.animation_data.action.fcurves[0].keyframe_points:
        point.interpolation = "SINE"
    box.animation_data.action.fcurves[0].keyframe_points[1].co.y = 0.002  # m: some frames are nearly even
    _, toml = written(scene)
    keys = toml["obstacle"][0]["keyframes"]
    require(2 < len(keys) <= 21, f"{len(keys)} keyframes of an eased motion")
    for frame in range(1, 22):
        scene.frame_set(frame)
        x = np.interp((frame - 1) / 24, [k["time"] for k in keys], [k["translate"][0] for k in keys])
        require(abs(x - box.matrix_world.translation.x) < TOLERANCE, f"frame {frame}: eased motion is off")
    scene.frame_set(7)
    box.animation_data_clear()
    written(scene)
    require(scene.frame_current == 7, "the current frame is not restored")


def test_wires(folder):
    scene, _, _ = fresh(folder, "wires")
    mesh = bpy.data.meshes.new("Line")
    mesh.from_pydata([(-1, 0, 0.55), (0, 0, 0.55), (1, 0, 0.55), (0.2, 0.3, 0.55)], [(0, 1), (1, 2)], [])
    line = bpy.data.objects.new("Line", mesh)
    scene.arris.colliders.objects.link(line)
    require(check() == {"FINISHED"}, "a wire is refused")
    said = scenes.call(scenes.installed["program"], "check", Path(bpy.path.abspath(scene.arris.folder)) / "scene.toml")
    require("2 wire segments" in said and "1 lone point" in said, f"no wire or nail: {said}")


def test_moving_cloth(folder):
    """The cloth's object is animated: without a pin it is let go where it begins, and a pin goes with it."""
    scene, cloth, _ = fresh(folder, "moving")
    group = cloth.vertex_groups.new(name="edge")
    group.add([0, 1, 2, 3, 4], 1.0, "REPLACE")
    for frame, x in ((1, 0.0), (4, 0.03)):
        cloth.location.x = x
        cloth.keyframe_insert("location", frame=frame)
    scenes.set_linear(cloth)
    bpy.ops.arris.add_pin()
    _, toml = written(scene)
    keys = toml["pin"][0]["keyframes"]
    require(np.allclose(keys[0]["translate"], 0) and np.allclose(keys[1]["translate"], [0.03, 0, 0], atol=1e-7),
            f"the pin does not go with its object: {keys}")
    scene.arris.result = "CACHE"
    require(simulate(wait=True) == {"FINISHED"}, "an animated cloth cannot be simulated")
    for frame in (1, 4):
        scene.frame_set(frame)
        wanted = np.array(cloth.matrix_world)[:3, 3] + [-0.4, -0.4, 0]
        require(np.abs(scenes.shown_points(cloth)[0] - wanted).max() < TOLERANCE,
                f"frame {frame}: the pinned corner is at {scenes.shown_points(cloth)[0]}, not {wanted}")


def test_units_and_rates(folder):
    scene, cloth, box = fresh(folder, "units")
    scene.unit_settings.scale_length = 0.01
    scene.gravity = (0, 0, -981)
    for thing in (cloth, box):  # in centimetres
        thing.location *= 100
        thing.scale *= 100
    scene.render.fps, scene.render.fps_base = 24, 1.001
    path, toml = written(scene)
    require(abs(toml["duration"] - 3 * 1.001 / 24) < 1e-6, f"duration {toml['duration']}")
    require(abs(toml["output"]["frames_per_second"] - 24 / 1.001) < 1e-4, "frame rate")
    require(np.allclose(toml["gravity"]["acceleration"], [0, 0, -9.81]), f"gravity {toml['gravity']}")
    require(np.ptp(scenes.read_obj_points(path / "cloth.obj"), axis=0).max() < 0.81, "the cloth is not in metres")
    require(simulate(wait=True) == {"FINISHED"}, "a scene in centimetres cannot be simulated")
    run = path / "run"
    require(len(list(run.glob("frames/*.ply"))) == 4, "another number of frames")
    for kind, name in (("MESHES", "Cloth simulated"), ("CACHE", "Cloth")):
        scene.arris.result = kind
        require(bpy.ops.arris.show_result() == {"FINISHED"}, "the result cannot be shown")
        scene.frame_set(4)
        error = scenes.distance_between(scenes.shown_points(bpy.data.objects[name]), scenes.frame_points(run, 3))
        require(error < TOLERANCE, f"{kind}: {error:.2g} m in a scene in centimetres")


def test_modifiers(folder):
    """Applied modifiers are simulated; those after the result act on it."""
    scene, cloth, _ = fresh(folder, "modifiers")
    cloth.modifiers.new("Finer", "SUBSURF").subdivision_type = "SIMPLE"
    scene.arris.use_modifiers, scene.arris.result = True, "CACHE"
    path, _ = written(scene)
    require(len(scenes.read_obj_points(path / "cloth.obj")) == 81, "the modifier is not applied")
    require(simulate(wait=True) == {"FINISHED"}, "cloth with a modifier cannot be simulated")
    require(cloth.modifiers.keys() == ["Finer", "Arris"], f"modifiers {cloth.modifiers.keys()}")
    scene.frame_set(4)
    require(scenes.shown_points(cloth)[:, 2].max() < 0.6, "the cloth does not move")
    bpy.ops.arris.clear_result()
    scene.arris.use_modifiers = False
    require(simulate(wait=True) == {"FINISHED"}, "cloth cannot be simulated without its modifier")
    require(cloth.modifiers.keys() == ["Arris", "Finer"], f"modifiers {cloth.modifiers.keys()}")
    scene.frame_set(4)
    points = scenes.shown_points(cloth)
    require(len(points) == 81 and points[:, 2].max() < 0.6, "the modifier does not act on the result")


def test_mirrored_uvs(folder):
    """The result has the object's own UVs and normals, also where its UVs are mirrored."""
    scene, cloth, _ = fresh(folder, "mirrored")
    for corner in cloth.data.uv_layers.active.data:
        corner.uv.x = 1 - corner.uv.x
    require(simulate(wait=True) == {"FINISHED"}, "cloth with mirrored UVs cannot be simulated")
    scene.frame_set(1)
    mesh = bpy.data.objects["Cloth simulated"].data
    require(all(p.normal.z > 0.99 for p in mesh.polygons), "the result is inside out")
    for loop, corner in zip(mesh.loops, mesh.uv_layers.active.data):
        x, y, _ = mesh.vertices[loop.vertex_index].co
        require(abs(corner.uv.x - (0.5 - x / 0.8)) + abs(corner.uv.y - (0.5 + y / 0.8)) < 1e-5, "other UVs")


def test_settings(folder):
    scene, cloth, box = fresh(folder, "settings")
    settings = scene.arris
    bpy.ops.object.effector_add(type="WIND", rotation=(0, math.pi / 2, 0))
    bpy.context.object.field.strength = 3
    settings.preset, settings.use_density, settings.density = "silk", True, 0.08
    settings.use_bending, settings.bending, settings.damping = True, 20.0, 0.005
    settings.use_friction = settings.use_self_contact = scene.use_gravity = False
    settings.use_remesh, settings.shortest_edge, settings.longest_edge = True, 0.02, 0.1
    box.arris.use_friction, box.arris.friction = True, 0.7
    box.arris.use_feature_angle, box.arris.feature_angle = True, 20
    cloth.vertex_groups.new(name="end").add([0], 1.0, "REPLACE")
    bpy.ops.arris.add_pin()
    settings.pins[0].use_start, settings.pins[0].start = True, 4
    _, toml = written(scene)
    require(toml["cloth"]["material"] == {"preset": "silk", "density": 0.08, "bending_stiffness": 2e-5,
                                          "damping": 0.005, "thickness": 0.001}, f"{toml['cloth']}")
    require(toml["wind"] == {"velocity": [3.0, 0.0, 0.0]} and toml["remesh"] == {"edge_length": [0.02, 0.1]}, f"{toml}")
    require(not {"gravity", "friction", "self_contact"} & set(toml), f"effects that are off: {toml.keys()}")
    solid = toml["obstacle"][0]
    require(solid["friction"] == 0.7 and solid["feature_angle"] == 20, f"{solid}")
    require(toml["pin"] == [{"vertices": [0], "start": 0.125}], f"{toml['pin']}")
    require(check() == {"FINISHED"}, "the settings are refused")
    settings.longest_edge = 0.02
    refused(check, "Cloth: Remesh: the longest edge must be longer than the shortest, 0.02 m")


ADD_ON, PROGRAM, FOLDER = map(Path, sys.argv[sys.argv.index("--") + 1:])
print(f"Blender: {scenes.run_tests(dict(globals()), ADD_ON, PROGRAM, FOLDER)} odd scenes")
