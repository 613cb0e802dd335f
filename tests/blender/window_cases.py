# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender with a window: frames are shown as they arrive, and undo and redo during and after a run.

usage: blender --factory-startup --python window_cases.py -- ADDON.zip PROGRAM FOLDER
Writes FOLDER/passed at the end; a picture of the panel is in FOLDER/panel.png.
"""
import sys
import time
import traceback
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
import blender_scenes as scenes  # noqa: E402
from blender_scenes import require  # noqa: E402

LIMIT = 60.0  # s
END = 2000     # frames: longer than the test
PAUSE = 0.1   # s, in which Blender runs its timers and draws
ADD_ON, PROGRAM, FOLDER = map(Path, sys.argv[sys.argv.index("--") + 1:])


def area_of(kind):
    return next(area for area in bpy.context.window_manager.windows[0].screen.areas if area.type == kind)


def in_window(operator, **words):
    """Calls an operator as its button does, with a step of undo."""
    window = bpy.context.window_manager.windows[0]
    with bpy.context.temp_override(window=window, screen=window.screen, area=area_of("PROPERTIES")):
        return operator("EXEC_DEFAULT", True, **words)


def until(is_reached, what):
    began = time.monotonic()
    while not is_reached():
        require(time.monotonic() - began < LIMIT, f"{what} takes more than {LIMIT:.0f} s")
        yield PAUSE


def run_of(scene):
    from arris_blender import background_run
    from arris_blender.operators import run_folder_of
    return background_run.find_run(run_folder_of(scene))


def result_of():
    return bpy.data.objects.get("Cloth simulated")


def require_shown(frame):
    """The result has the mesh of the run at the scene's frame."""
    wanted = scenes.frame_points(run_of(bpy.context.scene).run_folder, frame - 1)
    shown = scenes.shown_points(result_of())
    require(shown.shape == wanted.shape and np.abs(shown - wanted).max() < 1e-6,
            f"frame {frame}: another mesh is shown")


def build():
    scene = bpy.context.scene
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()
    scene.frame_start, scene.frame_end = 1, END
    bpy.ops.mesh.primitive_cube_add(size=0.4, location=(0, 0, 0.3))
    box = bpy.context.object
    scene.arris.cloth = scenes.add_grid("Cloth", 10, 0.8, (0, 0, 0.52))
    scene.arris.colliders = scenes.collect("Solids", [box])
    scene.arris.time_step = 0.01
    bpy.ops.wm.save_as_mainfile(filepath=str(FOLDER / "window.blend"))
    bpy.ops.ed.undo_push(message="scene built")


def steps():
    scenes.installed["program"] = str(PROGRAM)
    scenes.install(ADD_ON, PROGRAM)
    build()
    yield PAUSE
    area_of("PROPERTIES").spaces[0].context = "SCENE"
    require(in_window(bpy.ops.arris.check) == {"FINISHED"}, "check fails")
    in_window(bpy.ops.arris.simulate)
    require(result_of() is not None and bpy.data.objects["Cloth"].hide_get(), "nothing is shown at once")
    yield from until(lambda: result_of()["arris_frames"] >= 3, "three frames")
    bpy.context.scene.frame_set(3)
    require_shown(3)
    window = bpy.context.window_manager.windows[0]
    bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)
    with bpy.context.temp_override(window=window, screen=window.screen, area=area_of("PROPERTIES")):
        bpy.ops.screen.screenshot(filepath=str(FOLDER / "panel.png"))

    run = run_of(bpy.context.scene)
    in_window(bpy.ops.ed.undo)  # while it runs: what shows the run goes, the run goes on
    require(result_of() is None and not bpy.data.objects["Cloth"].hide_get(), "undo leaves the result")
    require(run.is_running(), "undo ends the run, or the run was too short to show anything")
    frames = run.frames
    yield from until(lambda: run.frames > frames, "another frame")
    in_window(bpy.ops.ed.redo)
    yield PAUSE
    require(result_of() is not None, "redo does not bring back the result")
    in_window(bpy.ops.arris.stop)
    yield from until(lambda: run.is_over, "stopping")
    require(run.describe().startswith("interrupted"), run.describe())
    frames = run.frames
    in_window(bpy.ops.arris.resume)
    run = run_of(bpy.context.scene)
    yield from until(lambda: run.frames > frames + 5, "more frames")
    in_window(bpy.ops.arris.stop)
    yield from until(lambda: run.is_over, "stopping again")
    require(not run.problem, run.describe())
    last = run.frames  # counted from 1, as scene frames are
    bpy.context.scene.frame_set(last)
    require_shown(last)

    in_window(bpy.ops.ed.undo)  # to the state before Resume, when there were fewer frames
    yield PAUSE
    require(result_of()["arris_frames"] == last, f"undo brings back {result_of()['arris_frames']} frames")
    bpy.context.scene.frame_set(last)
    require_shown(last)

    bpy.context.scene.arris.result = "CACHE"
    in_window(bpy.ops.arris.show_result)
    require(result_of() is None and "Arris" in bpy.data.objects["Cloth"].modifiers, "no point cache is shown")
    in_window(bpy.ops.ed.undo)
    require("Arris" not in bpy.data.objects["Cloth"].modifiers, "undo leaves the modifier")
    (FOLDER / "passed").write_text("Blender: undo and redo during and after a run, with a window\n")


def tick(iterator=steps()):
    try:
        return next(iterator)
    except StopIteration:
        pass
    except BaseException:
        traceback.print_exc()
    bpy.ops.wm.quit_blender()


bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(tick, first_interval=0.5, persistent=True)
