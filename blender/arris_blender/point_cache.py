# SPDX-License-Identifier: MIT
"""Turns cloth.pc2, which `arris export` writes, into a cache of the object's own vertices in its own space."""

from pathlib import PureWindowsPath

import numpy as np

from .placements import place_back
from .run_files import ArrisError, Pc2Writer, frame_path, read_frame, read_pc2

CACHE_FILE = "blender_cloth.pc2"


def find_cache_modifier(cloth):
    """The modifier that shows a point cache, whatever its name; or None. It and the modifiers after it act on the
    result, and are not simulated."""
    return next((modifier for modifier in cloth.modifiers if modifier.type == "MESH_CACHE"
                 and PureWindowsPath(modifier.filepath).name == CACHE_FILE), None)  # of paths with / or \


def match_vertices(placed, base):
    """For each of Blender's vertices the number of the run's vertex at the same place, or -1.

    Arris numbers vertices by their first use in faces, joins those that coincide, and leaves out those without faces.
    Places are equal to the bit, as cloth.obj states them with all digits.
    """
    number_at = {tuple(point): i for i, point in enumerate((base + 0.0).tolist())}  # -0.0 becomes 0.0
    return np.array([number_at.get(tuple(point), -1) for point in (placed + 0.0).tolist()])


def write_cache(path, samples, points, count):
    """Writes `count` samples of `points` points each, in the space that the cloth's object has at each frame."""
    draft = path.with_suffix(".part")
    writer = Pc2Writer(draft, points, count)
    for sample in samples:
        writer.append(sample)
    writer.close()
    draft.replace(path)  # Blender may be reading it


def write_first_sample(run_folder, record):
    """The cloth before the run has any frame."""
    write_cache(run_folder / CACHE_FILE, [record["points"]], len(record["points"]), 1)


def convert_cache(run_folder, record):
    """Makes the object's cache from the run's; returns its number of samples."""
    world = read_pc2(run_folder / "cloth.pc2")
    base = read_frame(frame_path(run_folder, "cloth", 0, "ply"))[0]
    numbers = match_vertices(record["placed"], base)
    if world.shape[1] != len(base) or (numbers < 0).all():
        raise ArrisError(f"{run_folder}: its cloth is not that of {record['cloth']}; simulate anew")
    has_faces = numbers >= 0
    matrices = record["matrices"]

    def own_points(k):
        points = record["points"].astype(float)  # vertices without faces stay where they are in their object
        points[has_faces] = place_back(matrices[min(k, len(matrices) - 1)], world[k][numbers[has_faces]])
        return points

    write_cache(run_folder / CACHE_FILE, map(own_points, range(len(world))), len(numbers), len(world))
    return len(world)
