// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/scene/parts/piece_source.h"
#include "geometry/cloth_input/pattern/sewing_pattern.h"

namespace arris {

/// The sewing pattern of a piece with panels: its `pattern_file` with the scene's changes, or its own panels
/// and seams, checked. `notes` gains what may surprise, `warnings` what is probably not meant. Throws
/// InputError.
SewingPattern read_pattern(const PieceSource& piece, std::vector<std::string>& notes,
                           std::vector<std::string>& warnings);

}  // namespace arris
