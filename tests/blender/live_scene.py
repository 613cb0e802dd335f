# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender: table, cloth, an animated cylinder and an arm with an armature, made by Blender's operators, are
simulated by the add-on's. Each frame, shown either way, is compared with an `arris run` of the written scene.

usage: blender -b --factory-startup --python live_scene.py -- ADDON.zip PROGRAM FOLDER
"""
import sys
from math import radians
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
import blender_scenes as scenes  # noqa: E402
from blender_scenes import require  # noqa: E402

TOLERANCE = 1e-6  # m: Blender's floats, of points within 2 m of the origin
START, END = 5, 29  # scene frames


def add_table():
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0, 0, 0.7), scale=(0.6, 0.6, 0.05))
    bpy.context.object.name = "Tisch für Gäste"
    return bpy.context.object


def add_cylinder():
    """Turns and travels, below a parent that is scaled and turned."""
    bpy.ops.object.empty_add(location=(0.1, 0, 0.5), rotation=(0, 0, radians(20)))
    parent = bpy.context.object
    parent.scale = (0.5, 0.5, 0.5)
    bpy.ops.mesh.primitive_cylinder_add(vertices=16, radius=0.32, depth=2.0, rotation=(radians(90), 0, 0))
    cylinder = bpy.context.object
    cylinder.name = "Roller"
    cylinder.parent = parent
    for frame, x, turn in ((START, -1.8, 0), (END, -0.6, 200)):
        cylinder.location = (x, 0, 0.8)
        cylinder.rotation_euler = (radians(90), radians(turn), 0)
        cylinder.keyframe_insert("location", frame=frame)
        cylinder.keyframe_insert("rotation_euler", frame=frame)
    return cylinder


def add_arm():
    """A tube of two bones that bends down at its elbow."""
    bpy.ops.object.armature_add(location=(0.7, 0, 0.95), rotation=(0, radians(-90), 0))
    armature = bpy.context.object
    armature.name = "Skeleton"
    bpy.ops.object.mode_set(mode="EDIT")
    bones = armature.data.edit_bones
    upper = bones[0]
    upper.name, upper.head, upper.tail = "upper", (0, 0, 0), (0, 0, 0.35)
    lower = bones.new("lower")
    lower.head, lower.tail, lower.parent = upper.tail, (0, 0, 0.7), upper
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.mesh.primitive_cylinder_add(vertices=12, radius=0.05, depth=0.7, location=(0.35, 0, 0.95),
                                        rotation=(0, radians(-90), 0))
    arm = bpy.context.object
    arm.name = "Arm"
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.bisect(plane_co=(0.35, 0, 0.95), plane_no=(1, 0, 0))
    bpy.ops.object.mode_set(mode="OBJECT")
    arm.select_set(True)
    armature.select_set(True)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.parent_set(type="ARMATURE_AUTO")
    bone = armature.pose.bones["lower"]
    bone.rotation_mode = "XYZ"
    for frame, degrees in ((START, 0), (END, 20)):
        bone.rotation_euler = (0, 0, radians(degrees))
        bone.keyframe_insert("rotation_euler", frame=frame)
    return arm


def add_cloth():
    cloth = scenes.add_grid("Cloth", 14, 0.9, (0, 0, 0.80))
    cloth.rotation_euler = (0, 0, radians(10))
    group = cloth.vertex_groups.new(name="corner")
    corner = [v.index for v in cloth.data.vertices if v.co.x > 0.38 and v.co.y > 0.38]
    group.add(corner, 1.0, "REPLACE")
    return cloth


def build(folder):
    scene = scenes.empty_scene(folder / "live scene.blend")
    scene.frame_start, scene.frame_end = START, END
    things = [add_table(), add_cylinder(), add_arm()]
    settings = scene.arris
    settings.cloth = add_cloth()
    settings.colliders = scenes.collect("Solids", things)
    settings.time_step = 0.01
    settings.damping = 0.002
    bpy.ops.arris.add_pin()
    settings.pins[0].use_release, settings.pins[0].release = True, START + 12
    return scene, things


def check_obstacles(scene, things, run_dir, names):
    """What the run had as obstacles is where Blender shows the colliders, at every frame."""
    worst = 0.0
    moved = {}
    for k in range(END - START + 1):
        scene.frame_set(START + k)
        for thing, name in zip(things, names):
            path = run_dir / f"frames/{name}_{k:05d}.obj"
            points = scenes.shown_points(thing)
            stored = scenes.read_obj_points(path if path.exists() else run_dir / f"frames/{name}_00000.obj")
            worst = max(worst, scenes.distance_between(points, stored))
            moved.setdefault(name, []).append(points)
    require(worst < TOLERANCE, f"an obstacle is {worst:.2g} m from its collider")
    for name in names[1:]:
        require(np.abs(moved[name][0] - moved[name][-1]).max() > 0.1, f"{name} does not move: the test shows nothing")
    return worst


def check_meshes(scene, run_dir):
    """The result's vertices are the frames' points."""
    result = bpy.data.objects["Cloth simulated"]
    worst, sizes = 0.0, set()
    for k in range(END - START + 1):
        scene.frame_set(START + k)
        points, wanted = scenes.shown_points(result), scenes.frame_points(run_dir, k)
        require(points.shape == wanted.shape, f"frame {k}: {len(points)} vertices instead of {len(wanted)}")
        worst = max(worst, float(np.abs(points - wanted).max()))
        sizes.add(len(points))
    require(worst < TOLERANCE, f"meshes: a vertex is {worst:.2g} m from that of arris run")
    require(len(sizes) > 1, "the mesh never changes: the test shows nothing")
    return worst


def check_cache(scene, run_dir):
    """Each of the object's own vertices is where the point cache of arris has its material point."""
    cloth = scene.arris.cloth
    cache = scenes.read_pc2(run_dir / "cloth.pc2")
    scene.frame_set(START)
    base = scenes.frame_points(run_dir, 0)
    matrix = np.array(cloth.matrix_world)
    rest = np.array([v.co for v in cloth.data.vertices]) @ matrix[:3, :3].T + matrix[:3, 3]
    numbers = ((rest[:, None] - base[None]) ** 2).sum(axis=2).argmin(axis=1)
    require((numbers != np.arange(len(numbers))).any(), "both number vertices alike: the test shows nothing")
    require(len(set(numbers)) == len(base), "vertices of the run are missing in the object")
    worst = 0.0
    for k in range(END - START + 1):
        scene.frame_set(START + k)
        worst = max(worst, float(np.abs(scenes.shown_points(cloth) - cache[k][numbers]).max()))
    require(worst < TOLERANCE, f"point cache: a vertex is {worst:.2g} m from that of arris export")
    require(np.abs(cache[0] - cache[-1]).max() > 0.1, "the cloth does not move: the test shows nothing")
    return worst


def main():
    add_on, program, folder = map(Path, sys.argv[sys.argv.index("--") + 1:])
    scenes.installed["program"] = str(program)
    scenes.install(add_on, program)
    scene, things = build(folder)
    require(bpy.ops.arris.check() == {"FINISHED"}, "check fails")
    require(bpy.ops.arris.simulate(wait=True) == {"FINISHED"}, "simulate fails")
    exported = folder / "arris" / scene.name
    alone = folder / "alone"
    scenes.call(program, "run", exported / "scene.toml", "-o", alone)
    scenes.call(program, "export", alone, "--formats", "obj,pc2")
    meshes = check_meshes(scene, alone)
    names = ["Tisch_fur_Gaste", "Roller", "Arm"]
    colliders = check_obstacles(scene, things, alone, names)
    require(scene.arris.cloth.hide_get() and scene.arris.cloth.hide_render, "the cloth is seen twice")
    scene.arris.result = "CACHE"
    require(bpy.ops.arris.show_result() == {"FINISHED"}, "show_result fails")
    require("Cloth simulated" not in bpy.data.objects and not scene.arris.cloth.hide_get(), "the result is seen twice")
    cache = check_cache(scene, alone)
    print(f"Blender, {END - START + 1} frames against arris run: meshes {meshes:.2g} m, point cache {cache:.2g} m, "
          f"colliders {colliders:.2g} m")


main()
