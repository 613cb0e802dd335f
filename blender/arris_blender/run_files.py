# SPDX-License-Identifier: MIT
"""Reads and writes files of a run without Blender: frames, obstacles, the report, point caches.

Lengths are metres, z is up.
"""

import json
import re
import struct

import numpy as np

TYPES = {"double": "f8", "float": "f4", "int": "i4", "uint": "u4", "uchar": "u1"}
PC2_HEADER = struct.Struct("<12siiffi")  # signature, version, points, first frame, frames per sample, samples


class ArrisError(Exception):
    """An error that the user can mend. The message is one line that names the object, setting, folder or file."""


def read_header(data, path):
    """(format of each element's properties as written, number of it) by name, and where the binary part starts."""
    end = data.find(b"end_header\n")
    if not data.startswith(b"ply\nformat binary_little_endian 1.0\n") or end < 0:
        raise ArrisError(f"{path}: is not a binary PLY file")
    elements, fields = {}, None
    try:
        for words in (line.split() for line in data[:end].decode("ascii", "replace").splitlines()):
            if words[0] == "element":
                fields = []
                elements[words[1]] = (fields, int(words[2]))
            elif words[:2] == ["property", "list"]:  # every list of a frame has three entries, which read_frame checks
                fields += [(words[4] + "_count", "<" + TYPES[words[2]]), (words[4], "<" + TYPES[words[3]], 3)]
            elif words[0] == "property":
                fields.append((words[2], "<" + TYPES[words[1]]))
    except (IndexError, KeyError, ValueError, AttributeError) as error:
        raise ArrisError(f"{path}: has a damaged header") from error
    return elements, end + len(b"end_header\n")


def own_material(data, material):
    """Material coordinates in those of each piece of cloth. The header says where pieces lie in the frame's plane."""
    lines = (line.split() for line in data[:data.find(b"end_header\n")].decode("ascii", "replace").splitlines())
    pieces = [(float(words[4]), float(words[3])) for words in lines if words[:2] == ["comment", "piece"]]
    if pieces:
        begins, shifts = np.array(pieces).T
        material[:, 0] -= shifts[np.maximum(np.searchsorted(begins, material[:, 0], side="right") - 1, 0)]
    return material


def read_frame(path):
    """A frame's points (n x 3, m), faces (m x 3), UVs of their corners (m x 3 x 2, m) and EOL edges (k x 2)."""
    data = read_bytes(path)
    elements, offset = read_header(data, path)
    tables = {}
    try:
        for name, (fields, count) in elements.items():
            tables[name] = np.frombuffer(data, np.dtype(fields), count, offset)
            offset += tables[name].nbytes
        vertex, face, edge = tables["vertex"], tables["face"], tables["edge"]
        points = np.column_stack([vertex[name] for name in "xyz"])
        material = np.column_stack([vertex[name] for name in "uv"])
        corner_points = face["vertex_indices"]
        if "point" in tables:  # vertices on seams have several material points
            further = np.column_stack([tables["point"][name] for name in "uv"])
            material, corner_points = np.vstack([material, further]), face["point_indices"]
        material = own_material(data, material)
        edges = np.column_stack([edge["vertex1"], edge["vertex2"]])
        triangles, corners = face["vertex_indices"], face["vertex_indices_count"]
    except (IndexError, KeyError, ValueError) as error:
        raise ArrisError(f"{path}: is cut short, or is not a frame of cloth") from error
    for indices, count in ((triangles, len(points)), (edges, len(points)), (corner_points, len(material))):
        if indices.size and not (0 <= indices.min() and indices.max() < count):  # Blender checks no index
            raise ArrisError(f"{path}: has an index of a vertex that does not exist")
    if (corners != 3).any() or not np.isfinite(points).all():
        raise ArrisError(f"{path}: has a face that is no triangle, or a point that is not finite")
    return points, triangles, material[corner_points], edges


def read_obstacle(path):
    """Points (n x 3, m), faces (m x 3) and segments of wires (k x 2) of an obstacle's OBJ file."""
    rows = {"v": [], "f": [], "l": []}
    try:
        text = read_bytes(path).decode()
        for line in text.splitlines():
            words = line.split()
            if words and words[0] in rows:
                rows[words[0]].append([float(w) if words[0] == "v" else int(w) - 1 for w in words[1:]])
        points = np.array(rows["v"], float).reshape(-1, 3)
        if text.startswith("# Arris: m, y is up"):  # exported with --up y; Blender and the cloth's frames have z
            points = points[:, [0, 2, 1]] * (1, -1, 1)
        faces = np.array(rows["f"], np.int32).reshape(-1, 3)
        segments = np.array(rows["l"], np.int32).reshape(-1, 2)
    except ValueError as error:
        raise ArrisError(f"{path}: is not an obstacle as `arris export --formats obj` writes it") from error
    for indices in (faces, segments):
        if indices.size and not (0 <= indices.min() and indices.max() < len(points)):
            raise ArrisError(f"{path}: has an index of a vertex that does not exist")
    return points, faces, segments


def read_bytes(path):
    try:
        return path.read_bytes()
    except OSError as error:
        raise ArrisError(f"{path}: {error.strerror}") from error


def count_frames(folder, name, suffix):
    """Number of files NAME_00000, NAME_00001, ... in the run's folder; a gap is an error."""
    pattern = re.compile(re.escape(name) + r"_(\d{5,})\." + suffix)
    found = (pattern.fullmatch(path.name) for path in (folder / "frames").glob(f"{name}_*.{suffix}"))
    numbers = sorted(int(match[1]) for match in found if match)
    for expected, number in enumerate(numbers):
        if number != expected:
            raise ArrisError(f"{frame_path(folder, name, expected, suffix)}: is missing, though later frames exist")
    return len(numbers)


def frame_path(folder, name, number, suffix):
    return folder / "frames" / f"{name}_{number:05d}.{suffix}"


def read_report(folder):
    """Frames per second and the obstacles' names."""
    path = folder / "report.json"
    try:
        scene = json.loads(read_bytes(path))["scene"]
        return float(scene["output"]["frames_per_second"]), [o["name"] for o in scene.get("obstacle", [])]
    except (KeyError, TypeError, ValueError) as error:
        raise ArrisError(f"{path}: is not the report of a run") from error


def read_status(folder):
    """How the run in `folder` ended ("finished", "interrupted", ...), or None before its first end."""
    try:
        return json.loads((folder / "report.json").read_bytes()).get("status")
    except (OSError, ValueError, AttributeError):
        return None


def read_pc2(path):
    """Samples of a point cache (samples x points x 3, float), mapped from the file and not yet read."""
    try:
        with open(path, "rb") as file:
            signature, version, points, _, _, samples = PC2_HEADER.unpack(file.read(PC2_HEADER.size))
        if signature != b"POINTCACHE2\0" or version != 1:
            raise ValueError
        return np.memmap(path, "<f4", "r", PC2_HEADER.size, (samples, points, 3))
    except OSError as error:
        raise ArrisError(f"{path}: {error.strerror}") from error
    except (ValueError, struct.error) as error:
        raise ArrisError(f"{path}: is not a whole PC2 file") from error


class Pc2Writer:
    """Writes a point cache sample by sample."""

    def __init__(self, path, points, samples):
        self.file = open(path, "wb")
        self.file.write(PC2_HEADER.pack(b"POINTCACHE2\0", 1, points, 0.0, 1.0, samples))

    def append(self, points):
        self.file.write(np.ascontiguousarray(points, "<f4").tobytes())

    def close(self):
        self.file.close()
