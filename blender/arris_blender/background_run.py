# SPDX-License-Identifier: MIT
"""Runs `arris` behind Blender's window: processes, what they say, and a timer that shows frames as they arrive.

Runs are kept here by their folder and not in Blender's data, so that neither undo nor loading a file loses them. What
shows a run is found by the run's folder, in whatever scene, since scenes are renamed and deleted while a run goes on.
"""

import atexit
import fcntl
import os
import re
import shlex
import signal
import subprocess
import time
import traceback

import bpy

from .findings import Finding, read_message
from .point_cache import convert_cache
from .result import find_modifier, refresh_result, remove_result
from .run_files import ArrisError, count_frames
from .scene_export import LOG_FILE, run_folders, write_record

INTERVAL = 0.25      # s, between looks at the runs
CACHE_SHARE = 0.2    # of the time, that exporting point caches takes while a run goes on
STOP_SECONDS = 10.0  # within which a run ends after its interruption
ENDS = {0: "finished", 130: "interrupted", -signal.SIGINT: "interrupted"}  # the last before the first step
runs = {}            # run folder -> BackgroundRun, the last one of each


class BackgroundRun:
    """`arris run` or `arris resume` in a process group of its own, with its output in a log."""

    def __init__(self, command, run_folder, record):
        self.command, self.run_folder, self.record = command, run_folder, record
        self.log = run_folder.parent / LOG_FILE
        self.frames, self.problem, self.concerned = 0, "", ""  # `concerned`: full name of the object, or ""
        self.export, self.export_began, self.next_export = None, 0.0, 0.0
        self.cached = 0          # frames in the point cache
        self.is_last_export = False
        self.first_frame = self.first_frame_time()
        self.is_recorded = command[1] == "resume"  # the record is there, and the frames are the record's
        self.is_over = False
        with open(self.log, "wb") as log:
            log.write(os.fsencode(f"$ {shlex.join(command)}\n"))
            log.flush()
            self.process = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                                            start_new_session=True, cwd=run_folder.parent)
        self.began = time.monotonic()

    def first_frame_time(self):
        try:
            return os.stat(self.run_folder / "frames/cloth_00000.ply").st_mtime_ns
        except OSError:
            return None

    def is_running(self):
        return self.process.poll() is None

    def interrupt(self):
        """Arris ends within its step, with a checkpoint."""
        if self.is_running():
            os.killpg(self.process.pid, signal.SIGINT)

    def wait_for_end(self, seconds):
        try:
            self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait()

    def look(self):
        """Shows what has arrived since the last look. Returns whether anything changed. A folder that cannot be read
        or written ends the run; any other error is kept as its problem, and leaves the timer to other runs."""
        try:
            return self.show_news()
        except Exception as error:
            is_expected = isinstance(error, (ArrisError, OSError))
            problem = str(error) if is_expected else f"the result cannot be shown: {type(error).__name__}: {error}"
            is_known, self.problem = problem == self.problem, problem
            if is_expected:
                self.interrupt()
            elif not is_known:
                traceback.print_exc()
            self.is_over = is_known and not self.is_running()  # else the next look may still tell how the run ended
            return True

    def show_news(self):
        is_running = self.is_running()  # first: what is on disk then is no older
        if not self.is_recorded and self.first_frame_time() not in (None, self.first_frame):
            write_record(self.run_folder, self.record)  # the frames in the folder are now those of this run
            self.is_recorded = True
        frames = count_frames(self.run_folder, "cloth", "ply") if self.is_recorded else 0
        is_new, self.frames = frames != self.frames, frames
        is_new = self.update_cache(is_running) or is_new
        for scene in bpy.data.scenes if is_new else ():
            refresh_result(scene, self.record, self.run_folder)
        if not is_running and self.export is None:
            self.is_over = True
            self.tell_end()
            return True
        return is_new

    def update_cache(self, is_running):
        """Exports the point cache now and then, and all of it at the end. Returns whether there is a new one."""
        is_new = False
        if self.export is not None:
            if self.export.poll() is None:
                return False
            self.next_export = time.monotonic() + (time.monotonic() - self.export_began) / CACHE_SHARE
            is_new, self.export = self.export.returncode == 0, None
            if is_new:
                self.cached = convert_cache(self.run_folder, self.record)
        is_shown = any(find_modifier(scene, self.run_folder) is not None for scene in bpy.data.scenes)
        is_time = time.monotonic() >= self.next_export if is_running else not self.is_last_export
        if is_shown and self.frames > self.cached and is_time:
            self.is_last_export = not is_running  # which is tried once
            self.export_began = time.monotonic()
            self.export = start_export(self.command[0], self.run_folder)
        return is_new

    def tell_end(self):
        status = self.process.returncode
        if status not in ENDS:
            told = read_problem(self.log)
            finding = read_message("ERROR", told, self.run_folder.parent, self.record) if told else \
                Finding("ERROR", "", f"arris ended with status {status}; see {self.log}")
            self.concerned, self.problem = finding.thing, finding.text
            if when := re.search(r"\bt = ([0-9.]+) s", self.problem):
                self.problem += f" (frame {self.record['start'] + float(when[1]) * self.record['rate']:.1f})"
        for scene in () if self.is_recorded else bpy.data.scenes:  # it had not begun: an earlier run is still there
            remove_result(scene, self.record, self.run_folder)

    def describe(self):
        if not self.is_over:
            done = f"frame {max(self.frames - 1, 0)} of {self.record['frames'] - 1}"
            return f"{done}; {self.problem}" if self.problem else done
        if self.problem:
            return f"{self.concerned}: {self.problem}" if self.concerned else self.problem
        return f"{ENDS[self.process.returncode]}: {self.frames} frames"

    def seconds_left(self):
        """A guess by the frames so far; None before there are any."""
        done = self.frames - 1
        if done < 1 or self.is_recorded and self.command[1] == "resume":
            return None
        return (time.monotonic() - self.began) / done * (self.record["frames"] - 1 - done)


def start_export(program, run_folder):
    return subprocess.Popen([program, "export", str(run_folder), "--formats", "pc2"], stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL, start_new_session=True)


def read_problem(log):
    """The last line of arris about why it stopped, alone."""
    try:
        lines = log.read_text(errors="replace").splitlines()
    except OSError:
        return ""
    told = [line for line in lines if line.startswith("arris: ")]
    return told[-1][len("arris: "):] if told else ""


def find_run(run_folder):
    return runs.get(str(run_folder))


def find_stray_runs():
    """Runs that go on in folders that no scene has, as after File > Save As in another folder."""
    folders = run_folders(bpy.data.scenes)
    return [run for run in runs.values() if not run.is_over and run.run_folder not in folders]


def is_in_use(run_folder):
    """Whether a process, also of another Blender, is writing the run."""
    try:
        descriptor = os.open(run_folder, os.O_RDONLY)
    except OSError:
        return False
    try:
        fcntl.flock(descriptor, fcntl.LOCK_SH | fcntl.LOCK_NB)
        return False
    except OSError:
        return True
    finally:
        os.close(descriptor)


def require_idle(run_folder):
    known = find_run(run_folder)
    if known is not None and not known.is_over or is_in_use(run_folder):
        raise ArrisError(f"{run_folder}: a simulation is running in this folder; stop it first, or choose another "
                         "folder")


def start(command, run_folder, record):
    """Starts a run and the timer that follows it."""
    run_folder.mkdir(parents=True, exist_ok=True)
    try:
        run = BackgroundRun(command, run_folder, record)
    except OSError as error:
        raise ArrisError(f"{shlex.join(command)}: cannot be started: {error.strerror}") from error
    runs[str(run_folder)] = run
    if not bpy.app.timers.is_registered(look_at_runs):
        bpy.app.timers.register(look_at_runs, first_interval=INTERVAL, persistent=True)
    return run


def wait_for(run):
    """For Blender without a window, where no timer runs."""
    while not run.is_over:
        run.look()
        time.sleep(0.02)


def redraw():
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type in {"PROPERTIES", "VIEW_3D"}:
                area.tag_redraw()


def look_at_runs():
    """The timer. Data may not change while a picture is rendered."""
    if bpy.app.is_job_running("RENDER"):
        return INTERVAL
    for run in runs.values():
        if not run.is_over and run.look():
            redraw()
    return INTERVAL if any(not run.is_over for run in runs.values()) else None


def stop_all():
    """At the end of Blender: runs keep their checkpoints, and can be resumed."""
    going = [run for run in runs.values() if run.is_running()]
    for run in going:
        run.interrupt()
    for run in going:
        run.wait_for_end(STOP_SECONDS)
        if not run.is_recorded and run.first_frame_time() not in (None, run.first_frame):
            write_record(run.run_folder, run.record)


def register():
    atexit.register(stop_all)


def unregister():
    stop_all()
    atexit.unregister(stop_all)
    if bpy.app.timers.is_registered(look_at_runs):
        bpy.app.timers.unregister(look_at_runs)
