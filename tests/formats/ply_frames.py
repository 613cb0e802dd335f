# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads PLY frames of a run, whose layout is fixed."""
import numpy as np

VERTEX = np.dtype([("x", "<f8", 3), ("u", "<f8", 2), ("v", "<f8", 3), ("w", "<f8", 3), ("id", "<u4"), ("eol", "u1"),
                   ("contact", "u1")])
FACE = np.dtype([("n", "u1"), ("vertices", "<i4", 3), ("strain", "<f8"), ("stretch", "<f8"), ("bending", "<f8")])


def read_ply(path):
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    counts = {w[1]: int(w[2]) for w in (line.split() for line in data[:end].decode().splitlines()) if w[0] == "element"}
    vertices = np.frombuffer(data, VERTEX, counts["vertex"], end)
    faces = np.frombuffer(data, FACE, counts["face"], end + vertices.nbytes)
    edges = np.frombuffer(data, "<i4", 2 * counts["edge"], end + vertices.nbytes + faces.nbytes).reshape(-1, 2)
    return vertices, faces, edges
