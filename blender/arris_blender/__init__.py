# SPDX-License-Identifier: MIT
"""Blender add-on: simulates cloth of the scene with Arris, and imports runs of Arris.

playback and import_run show runs; settings, sampling, placements and scene_export write the scene for Arris; program,
background_run, findings, point_cache and result run it and show what it says; operators and panels are what the user
meets.
"""

import importlib
import sys

try:
    import numpy  # noqa: F401
except ImportError as error:
    raise ImportError("the Arris add-on needs NumPy, which this Blender lacks; on Debian: "
                      "apt-get install python3-numpy") from error

bl_info = {
    "name": "Arris cloth",
    "author": "Arris contributors",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Scene > Arris Cloth; File > Import > Arris run",
    "description": "Simulates cloth that slides over sharp edges, and imports runs",
    "category": "Physics",
}

# In their order of use: a new version that is installed over an older one is loaded anew, module by module.
NAMES = ("run_files", "placements", "playback", "import_run", "sampling", "scene_export", "point_cache", "program",
         "settings", "result", "background_run", "findings", "operators", "panels")


def load(name):
    path = f"{__package__}.{name}"
    return importlib.reload(sys.modules[path]) if path in sys.modules else importlib.import_module(path)


MODULES = [module for module in map(load, NAMES) if hasattr(module, "register")]


def register():
    for module in MODULES:
        module.register()


def unregister():
    for module in reversed(MODULES):
        module.unregister()
