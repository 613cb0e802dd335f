# SPDX-License-Identifier: GPL-3.0-or-later
"""A process that reads an untrusted mesh file for a simulation. Started by path, so that it finds its neighbour."""

import sys

import _arris

_arris.import_obstacle(sys.argv[1:])
