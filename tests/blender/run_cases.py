# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender: a run is stopped, killed and resumed, two scenes run at once, and a .blend file moves.

usage: blender -b --factory-startup --python run_cases.py -- ADDON.zip PROGRAM FOLDER
"""
import json
import os
import shutil
import signal
import sys
import time
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
import blender_scenes as scenes  # noqa: E402
from blender_scenes import refused, require  # noqa: E402

LIMIT = 60.0  # s
ADD_ON, PROGRAM, FOLDER = map(Path, sys.argv[sys.argv.index("--") + 1:])


def add_scene(name, end):
    """Cloth that falls onto a box."""
    scene = bpy.context.scene
    scene.name = name
    scene.frame_start, scene.frame_end = 1, end
    bpy.ops.mesh.primitive_cube_add(size=0.4, location=(0, 0, 0.3))
    box = bpy.context.object
    scene.arris.cloth = scenes.add_grid(f"Cloth of {name}", 8, 0.8, (0, 0, 0.51))
    scene.arris.colliders = scenes.collect(f"Solids of {name}", [box])
    scene.arris.time_step = 0.02
    return scene


def run_of(scene):
    from arris_blender import background_run
    from arris_blender.operators import run_folder_of
    return background_run.find_run(run_folder_of(scene))


def look_until(is_reached, what):
    """What the timer does where Blender has a window."""
    from arris_blender import background_run
    began = time.monotonic()
    while not is_reached():
        require(time.monotonic() - began < LIMIT, f"{what} takes more than {LIMIT:.0f} s")
        background_run.look_at_runs()
        time.sleep(0.01)


def frame_bytes(run_folder):
    return [path.read_bytes() for path in sorted(run_folder.glob("frames/cloth_*.ply"))]


def test_stop_and_resume(folder):
    scenes.empty_scene(folder / "stop.blend")
    scene = add_scene("Stopped", 60)
    bpy.ops.arris.simulate()
    run = run_of(scene)
    look_until(lambda: run.frames >= 3, "three frames")
    result = bpy.data.objects[f"{scene.arris.cloth.name} simulated"]
    require(result["arris_frames"] >= 3, "frames are not shown as they arrive")
    refused(bpy.ops.arris.simulate, "a simulation is running in this folder", wait=True)
    bpy.ops.arris.stop()
    look_until(lambda: run.is_over, "stopping")
    require(run.describe().startswith("interrupted"), f"stopped: {run.describe()}")
    require(3 <= run.frames < 60, f"stopped after {run.frames} frames: the test shows nothing")
    refused(bpy.ops.arris.stop, "no simulation that this Blender has started is running")

    scene.arris.preset = "denim"  # is not mixed into the run
    bpy.ops.arris.resume()
    run = run_of(scene)
    look_until(lambda: run.frames >= 6, "six frames")
    os.kill(run.process.pid, signal.SIGKILL)
    look_until(lambda: run.is_over, "dying")
    require("status -9" in run.problem, f"killed: {run.describe()}")
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
    scene = bpy.context.scene
    require(bpy.ops.arris.resume(wait=True) == {"FINISHED"}, "a killed run is not resumed")
    from arris_blender.operators import run_folder_of
    resumed = frame_bytes(run_folder_of(scene))
    scenes.call(scenes.installed["program"], "run", run_folder_of(scene).parent / "scene.toml", "-o", folder / "whole")
    require(len(resumed) == 60 and resumed == frame_bytes(folder / "whole"), "resumed frames differ from a whole run's")


def test_quit(folder):
    """Blender ends while a run goes on: the run keeps its checkpoint, and another Blender resumes it."""
    scenes.empty_scene(folder / "quit.blend")
    add_scene("Quit", 200)
    bpy.ops.wm.save_mainfile()
    script = folder / "quit.py"
    script.write_text("import bpy, time\n"
                      "from pathlib import Path\n"
                      "bpy.ops.preferences.addon_enable(module='arris_blender')\n"
                      f"bpy.context.preferences.addons['arris_blender'].preferences.program = {str(PROGRAM)!r}\n"
                      "bpy.ops.arris.simulate()\n"
                      f"frame = Path({str(folder / 'arris/Quit/run/frames/cloth_00002.ply')!r})\n"
                      "while not frame.exists():\n"
                      "    time.sleep(0.01)\n")
    scenes.call("blender", "-b", bpy.data.filepath, "--python-exit-code", "1", "--python", script)
    run_folder = folder / "arris/Quit/run"
    report = json.loads((run_folder / "report.json").read_text())
    require(report["status"] == "interrupted", f"after the end of Blender the run is {report['status']}")
    scene = bpy.context.scene
    scene.frame_end = 60  # is not mixed into the run
    require(bpy.ops.arris.resume(wait=True) == {"FINISHED"}, "the run cannot be resumed")
    require(len(frame_bytes(run_folder)) == 200, f"{len(frame_bytes(run_folder))} frames")


def test_two_scenes(folder):
    """Each has its folder and its run, also at one time; the cache of one and the meshes of the other are shown."""
    slow = folder / "slow arris"  # exports so slowly that one is under way where the run ends, without its last frames
    slow.write_text(f'#!/bin/sh\nif [ "$1" = export ]; then {PROGRAM} "$@"; sleep 2; else exec {PROGRAM} "$@"; fi\n')
    slow.chmod(0o755)
    scenes.empty_scene(folder / "two.blend")
    bpy.context.preferences.addons["arris_blender"].preferences.program = str(slow)
    first = add_scene("First", 30)
    first.arris.result = "CACHE"
    bpy.ops.scene.new(type="NEW")
    second = add_scene("Second", 8)
    bpy.ops.arris.simulate()
    bpy.context.window.scene = first
    bpy.ops.arris.simulate()
    runs = [run_of(first), run_of(second)]
    require(runs[0] is not runs[1], "two scenes share a run")
    look_until(lambda: all(run.is_over for run in runs), "two runs")
    for scene, kind in ((first, "cache"), (second, "meshes")):
        bpy.context.window.scene = scene
        last = scene.frame_end
        scene.frame_set(last)
        shown = scene.arris.cloth if kind == "cache" else scene.objects[f"{scene.arris.cloth.name} simulated"]
        wanted = scenes.read_pc2(run_of(scene).run_folder / "cloth.pc2")[last - 1] if kind == "cache" else \
            scenes.frame_points(run_of(scene).run_folder, last - 1)
        require(kind == "meshes" or len(scenes.read_pc2(run_of(scene).run_folder / "blender_cloth.pc2")) == last,
                "the point cache lacks frames")
        error = scenes.distance_between(scenes.shown_points(shown), wanted)
        require(error < 1e-6, f"the {kind} of {scene.name} is {error:.2g} m off")


def test_renamed_scene(folder):
    """A run belongs to its folder: the scene keeps it under another name, and copies take folders of their own."""
    from arris_blender.operators import run_folder_of
    scenes.empty_scene(folder / "renamed.blend")
    scene = add_scene("Named", 400)
    bpy.ops.arris.simulate()
    run = run_of(scene)
    look_until(lambda: run.frames >= 2, "two frames")
    scene.name = "Renamed"
    require(run_of(scene) is run, "a renamed scene loses its run")
    frames = run.frames
    look_until(lambda: run.frames > frames, "another frame")
    result = bpy.data.objects[f"{scene.arris.cloth.name} simulated"]
    require(result["arris_frames"] == run.frames, "a renamed scene is not shown what arrives")
    refused(bpy.ops.arris.simulate, "a simulation is running in this folder", wait=True)
    copy = scene.copy()
    copy.name = "Copied"
    bpy.context.window.scene = copy
    bpy.ops.arris.write_scene()
    bpy.ops.scene.new(type="NEW")
    bpy.context.scene.name = "Named"
    folders = [run_folder_of(s).parent.name for s in (scene, copy, bpy.context.scene)]
    require(folders == ["Named", "Copied", "Named_2"], f"scenes have the folders {folders}")
    bpy.context.window.scene = scene
    bpy.ops.arris.stop()
    look_until(lambda: run.is_over, "stopping")


def test_renamed_cloth(folder):
    """A point cache goes on under other names of the cloth and of its modifier, and is cleared."""
    scenes.empty_scene(folder / "cloth.blend")
    scene = add_scene("Cache", 12)
    scene.arris.result, cloth = "CACHE", scene.arris.cloth
    bpy.ops.arris.simulate()
    cloth.name, cloth.modifiers["Arris"].name = "Other", "Mine"
    run = run_of(scene)
    look_until(lambda: run.is_over, "a run")
    require(run.cached == 12, f"the cache has {run.cached} frames")
    scene.arris.use_modifiers = True
    require(bpy.ops.arris.show_result() == {"FINISHED"}, "the cache of a renamed cloth cannot be shown")
    require(cloth.modifiers.keys() == ["Mine"], f"modifiers {cloth.modifiers.keys()}")
    scene.frame_set(12)
    wanted = scenes.read_pc2(run.run_folder / "cloth.pc2")[11]
    require(scenes.distance_between(scenes.shown_points(cloth), wanted) < 1e-6, "another frame is shown")
    bpy.ops.arris.write_scene()
    start = scenes.read_obj_points(run.run_folder.parent / "cloth.obj")
    require(np.ptp(start[:, 2]) < 1e-6, "the result is simulated")
    scene.arris.result = "MESHES"
    bpy.ops.arris.show_result()
    require(cloth.hide_get() and not cloth.modifiers, "the renamed cloth is shown beside the result")
    bpy.ops.arris.clear_result()
    require(not cloth.hide_get(), "the renamed cloth stays hidden")


def test_broken_result(folder):
    """A result that the user has damaged ends neither its run nor the timer, and is named."""
    from arris_blender import background_run
    scenes.empty_scene(folder / "broken.blend")
    first = add_scene("Broken", 30)
    bpy.ops.arris.simulate()
    bpy.ops.scene.new(type="NEW")
    second = add_scene("Whole", 12)
    bpy.ops.arris.simulate()
    runs = [run_of(first), run_of(second)]
    del bpy.data.objects[f"{first.arris.cloth.name} simulated"]["arris_suffix"]
    look_until(lambda: runs[0].problem and runs[0].is_over and runs[1].is_over, "two runs")
    require("arris_suffix" in runs[0].problem, f"the problem is told as {runs[0].problem}")
    require(runs[0].process.returncode == 0, "a damaged result ends its run")
    require(not runs[1].problem and runs[1].frames == 12, "a damaged result ends another run")
    require(background_run.look_at_runs() is None, "the timer goes on")


def test_damaged_record(folder):
    """A run whose record is cut off or changed is refused in one line."""
    scenes.empty_scene(folder / "record.blend")
    scene = add_scene("Record", 3)
    bpy.ops.arris.simulate(wait=True)
    path = run_of(scene).run_folder / "blender.npz"
    data = path.read_bytes()
    no_entries = b"PK\5\6" + bytes(18)
    for damaged in (b"", b"junk", no_entries, data[:len(data) // 2], data[:-10], data[:200] + b"XXXX" + data[204:]):
        path.write_bytes(damaged)
        for operator in (bpy.ops.arris.show_result, bpy.ops.arris.resume, bpy.ops.arris.clear_result):
            refused(operator, "blender.npz: is damaged")
    with open(path, "wb") as file:
        np.save(file, np.zeros(3))
    refused(bpy.ops.arris.show_result, "blender.npz: is damaged")
    path.unlink()
    refused(bpy.ops.arris.show_result, "holds no run of a Blender scene")
    path.write_bytes(data)
    require(bpy.ops.arris.show_result() == {"FINISHED"}, "a whole record is refused")


def mesh_details(thing):
    """What a frame has besides points and faces."""
    mesh = thing.data
    return (len(mesh.polygons), [tuple(c.uv) for c in mesh.uv_layers.active.data], [m.name for m in mesh.materials],
            sorted(tuple(e.vertices) for e in mesh.edges if e.crease > 0.99 and e.use_edge_sharp), mesh.use_auto_smooth)


def test_linked_result(folder):
    """A result that another file links finds its frames beside its own file, also after that other file is reopened."""
    for name in ("library", "shot"):
        (folder / name).mkdir()
    scenes.empty_scene(folder / "library/library.blend")
    scene = add_scene("Linked", 8)
    scene.arris.cloth.data.materials.append(bpy.data.materials.new("Silk"))
    bpy.ops.arris.simulate(wait=True)
    run_folder, name = run_of(scene).run_folder, f"{scene.arris.cloth.name} simulated"
    scene.frame_set(8)
    details = mesh_details(bpy.data.objects[name])
    require(details[3], "no folds: the test shows less")
    scene.frame_set(1)
    bpy.ops.wm.save_mainfile()
    scenes.empty_scene(folder / "shot/shot.blend")
    with bpy.data.libraries.load(str(folder / "library/library.blend"), link=True, relative=True) as (_, chosen):
        chosen.objects = [name]
    bpy.context.scene.collection.objects.link(chosen.objects[0])
    for reopened in (False, True):
        if reopened:
            bpy.ops.wm.save_mainfile()
            bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
        result = bpy.data.objects[name]
        for frame in (2, 8):
            bpy.context.scene.frame_set(frame)
            shown, wanted = scenes.shown_points(result), scenes.frame_points(run_folder, frame - 1)
            require(shown.shape == wanted.shape and np.abs(shown - wanted).max() < 1e-6,
                    f"frame {frame}: a linked result shows another mesh; {result.get('arris_problem')}")
        require(bpy.context.scene.render.use_lock_interface, "the window draws a linked result while a render fills it")
        require(mesh_details(result) == details, "a linked result lacks UVs, materials, folds or smooth shading")


def test_copied_scene(folder):
    """A full copy of a scene has one object that shows its own run, and leaves the first scene's alone."""
    scenes.empty_scene(folder / "copied.blend")
    first = add_scene("Copied", 3)
    bpy.ops.arris.simulate(wait=True)
    bpy.ops.scene.new(type="FULL_COPY")
    second = bpy.context.scene
    second.arris.cloth.location.z += 0.1
    require(bpy.ops.arris.simulate(wait=True) == {"FINISHED"}, "a copied scene cannot be simulated")
    require(run_of(first) is not run_of(second), "a copied scene shares the folder of the first")
    for scene in (first, second):
        bpy.context.window.scene = scene
        scene.frame_set(3)
        shown = [thing for thing in scene.objects if "arris_folder" in thing]
        require(len(shown) == 1, f"{scene.name} has the results {[thing.name for thing in shown]}")
        wanted = scenes.frame_points(run_of(scene).run_folder, 2)
        require(scenes.distance_between(scenes.shown_points(shown[0]), wanted) < 1e-6, f"{scene.name}: another run")


def test_stray_run(folder):
    """A run whose folder no scene has any more is listed, and can be stopped."""
    from arris_blender import background_run
    (folder / "elsewhere").mkdir()
    scenes.empty_scene(folder / "stray.blend")
    scene = add_scene("Stray", 400)
    bpy.ops.arris.simulate()
    run = run_of(scene)
    require(background_run.find_stray_runs() == [], "a scene's run is taken for a stray one")
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "elsewhere/stray.blend"))
    refused(bpy.ops.arris.stop, f"here; running: {run.run_folder}")
    require(background_run.find_stray_runs() == [run], "a run is lost where its file is saved elsewhere")
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "stray.blend"))
    require(background_run.find_stray_runs() == [], "the run does not come back with its file")
    bpy.ops.scene.new(type="NEW")
    bpy.data.scenes.remove(scene)
    require(background_run.find_stray_runs() == [run], "a run is lost with its scene")
    bpy.ops.arris.stop(folder=str(run.run_folder))
    look_until(lambda: run.is_over, "stopping")
    require(run.describe().startswith("interrupted") and background_run.find_stray_runs() == [], run.describe())


def test_moved_file(folder):
    """With its folder the .blend file may move; without it the last mesh stays, and the object says what is missing."""
    for name in ("here", "there"):
        (folder / name).mkdir()
    scenes.empty_scene(folder / "here/moved.blend")
    add_scene("Moved", 4)
    bpy.ops.arris.simulate(wait=True)
    bpy.ops.wm.save_mainfile()
    shutil.move(folder / "here/moved.blend", folder / "there/moved.blend")
    bpy.ops.wm.open_mainfile(filepath=str(folder / "there/moved.blend"))
    result = bpy.data.objects["Cloth of Moved simulated"]
    bpy.context.scene.frame_set(4)
    require("cloth_00003.ply" in result.get("arris_problem", ""), "nothing says that the folder is missing")
    require(len(result.data.vertices) > 0, "the last mesh is lost")
    refused(bpy.ops.arris.resume, "holds no run to resume")
    shutil.move(folder / "here/arris", folder / "there/arris")
    bpy.context.scene.frame_set(3)
    require("arris_problem" not in result, "the folder is not found beside the moved file")
    wanted = scenes.frame_points(folder / "there/arris/Moved/run", 2)
    require(np.abs(scenes.shown_points(result) - wanted).max() < 1e-6, "another frame is shown")


print(f"Blender: {scenes.run_tests(dict(globals()), ADD_ON, PROGRAM, FOLDER)} cases of runs")
