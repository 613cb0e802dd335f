# SPDX-License-Identifier: GPL-3.0-or-later
"""Readers of point caches."""
import sys

import numpy as np


def read_pc2(path):
    """Positions: frames x vertices x 3."""
    data = path.read_bytes()
    head = np.frombuffer(data, np.dtype([("sign", "S12"), ("version", "<i4"), ("points", "<i4"), ("start", "<f4"),
                                         ("rate", "<f4"), ("samples", "<i4")]), 1)[0]
    if head["sign"] != b"POINTCACHE2" or head["version"] != 1:
        sys.exit(f"{path}: not a PC2 file of version 1")
    if head["start"] != 0 or head["rate"] != 1:
        sys.exit(f"{path}: sample i is not frame i")
    return np.frombuffer(data, "<f4", offset=32).reshape(head["samples"], head["points"], 3)


def read_mdd(path):
    """Times in seconds; positions: frames x vertices x 3."""
    data = path.read_bytes()
    frames, points = np.frombuffer(data, ">i4", 2)
    times = np.frombuffer(data, ">f4", frames, 8)
    return times, np.frombuffer(data, ">f4", offset=8 + 4 * frames).reshape(frames, points, 3)
