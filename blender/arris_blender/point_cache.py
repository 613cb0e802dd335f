# SPDX-License-Identifier: MIT
"""Turns cloth.pc2, which `arris export` writes, into a cache of the object's own vertices in its own space."""

import numpy as np

from .placements import place_back
from .run_files import ArrisError, Pc2Writer, frame_path, read_frame, read_pc2

CACHE_FILE = "blender_cloth.pc2"


def match_vertices(placed, base):
    """For each of Blender's vertices the number of the run's vertex at the same place, or -1.

    Arris numbers vertices by their first use in faces, joins those that coincide, and leaves out those without faces.
    Places are equal to the bit, as cloth.obj states them with all digits.
    """
    number_at = {tuple(point): i for i, point in enumerate((base + 0.0).tolist())}  # -0.0 becomes 0.0
    return np.array([number_at.get(tuple(point), -1) for point in (placed + 0.0).tolist()])


def write_cache(path, record, samples):
    """Writes `samples` of Blender's vertices, in the space that the cloth's object has at each frame."""
    draft = path.with_suffix(".part")
    writer = Pc2Writer(draft, len(record["points"]), len(samples))
    for points in samples:
        writer.append(points)
    writer.close()
    draft.replace(path)  # Blender may be reading it


def write_first_sample(run_folder, record):
    """The cloth before the run has any frame."""
    write_cache(run_folder / CACHE_FILE, record, [record["points"]])


def convert_cache(run_folder, record):
    """Makes the object's cache from the run's; returns its number of samples."""
    world = read_pc2(run_folder / "cloth.pc2")
    base = read_frame(frame_path(run_folder, "cloth", 0, "ply"))[0]
    numbers = match_vertices(record["placed"], base)
    if world.shape[1] != len(base) or (numbers < 0).all():
        raise ArrisError(f"{run_folder}: its cloth is not that of {record['cloth']}; simulate anew")
    has_faces = numbers >= 0
    matrices = record["matrices"]
    samples = []
    for k, points in enumerate(world):
        own = record["points"].astype(float)
        matrix = matrices[min(k, len(matrices) - 1)]
        own[has_faces] = place_back(matrix, points[numbers[has_faces]])
        samples.append(own.astype(np.float32))
    write_cache(run_folder / CACHE_FILE, record, samples)
    return len(samples)
