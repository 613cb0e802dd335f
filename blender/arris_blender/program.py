# SPDX-License-Identifier: MIT
"""Finds the program `arris`, which the add-on's preferences or PATH name."""

import os
import re
import shutil
import subprocess

import bpy
from bpy.props import StringProperty

from .run_files import ArrisError

OLDEST = (0, 1, 0)
WHERE = "Edit > Preferences > Add-ons > Arris cloth"
versions = {}  # (path, time of change) -> version, or the error to report: the preferences are drawn often


class ArrisPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(name="Program arris", subtype="FILE_PATH",
                            description="Path of the program; empty: arris as found on PATH")

    def draw(self, _context):
        self.layout.prop(self, "program")
        try:
            path, version = find_program()
            self.layout.label(text=f"{path}, version {version}", icon="CHECKMARK")
        except ArrisError as error:
            self.layout.label(text=str(error), icon="ERROR")


def chosen_path():
    add_on = bpy.context.preferences.addons.get(__package__)
    return bpy.path.abspath(add_on.preferences.program) if add_on and add_on.preferences.program else ""


def read_version(path):
    """The version that the program states; asked for once."""
    key = (path, os.stat(path).st_mtime_ns)
    if key not in versions:
        versions[key] = ask_version(path)
    if isinstance(versions[key], ArrisError):
        raise versions[key]
    return versions[key]


def ask_version(path):
    """The version, or the error."""
    try:
        said = subprocess.run([path, "--version"], capture_output=True, text=True, errors="replace", timeout=20,
                              check=False, stdin=subprocess.DEVNULL)
    except (OSError, subprocess.TimeoutExpired) as error:
        return ArrisError(f"program {path}: cannot be run: {getattr(error, 'strerror', None) or error}")
    match = re.match(r"arris (\d+)\.(\d+)\.(\d+)", said.stdout)
    if said.returncode != 0 or not match:
        return ArrisError(f"program {path}: is not arris, or cannot start; {WHERE} sets its path")
    return tuple(int(n) for n in match.groups())


def find_program():
    """(path, version) of the program; an error says what to do."""
    chosen = chosen_path()
    path = chosen or shutil.which("arris")
    if not path:
        raise ArrisError(f"program arris: is not on PATH; install Arris, or set its path in {WHERE}")
    if not (os.path.isfile(path) and os.access(path, os.X_OK)):
        raise ArrisError(f"program {path}: is not there or cannot be run; mend its path in {WHERE}")
    version = read_version(path)
    if version < OLDEST:
        raise ArrisError(f"program {path}: has version {dotted(version)}; the add-on needs {dotted(OLDEST)} or newer")
    return path, dotted(version)


def dotted(version):
    return ".".join(map(str, version))


def register():
    bpy.utils.register_class(ArrisPreferences)


def unregister():
    bpy.utils.unregister_class(ArrisPreferences)
