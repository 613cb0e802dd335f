# SPDX-License-Identifier: GPL-3.0-or-later
"""A process that reads an untrusted mesh file for a simulation."""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))  # where its neighbour is

import _arris

_arris.import_obstacle(sys.argv[1:])
