// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "geometry/cloth/piece_place.h"

namespace arris {

/// Lays pieces of cloth side by side along u, `room` (m) apart, the first where it is. `boxes`: of their own
/// material. The places have no names.
std::vector<PiecePlace> lay_out(const std::vector<Eigen::AlignedBox2d>& boxes, double room);

}  // namespace arris
