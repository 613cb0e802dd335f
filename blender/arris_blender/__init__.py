# SPDX-License-Identifier: MIT
"""Blender add-on: simulates cloth of the scene with Arris, and imports runs of Arris.

playback and import_run show runs; settings, sampling and scene_export write the scene for Arris; program, background_run,
findings, point_cache and result run it and show what it says; operators and panels are what the user meets.
"""

try:
    import numpy  # noqa: F401
except ImportError as error:
    raise ImportError("the Arris add-on needs NumPy, which this Blender lacks; on Debian: "
                      "apt-get install python3-numpy") from error

from . import background_run, import_run, operators, panels, playback, program, settings

bl_info = {
    "name": "Arris cloth",
    "author": "Arris contributors",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Scene > Arris Cloth; File > Import > Arris run",
    "description": "Simulates cloth that slides over sharp edges, and imports runs",
    "category": "Physics",
}

MODULES = (program, settings, playback, import_run, background_run, operators, panels)


def register():
    for module in MODULES:
        module.register()


def unregister():
    for module in reversed(MODULES):
        module.unregister()
