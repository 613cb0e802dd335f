// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/cloth_input/cloth_grid.h"

namespace arris {

/// Makes a regular pattern that must be cut to fit its rectangle: a turned one, or one with fold lines.
/// Throws InputError as make_mesh_lines does. Angles are judged in cell coordinates (pattern_lattice.h).
ClothMesh make_cut_pattern(const ClothGrid& grid);

}  // namespace arris
