// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

struct SeamCorner {
    Vec2 uv = Vec2::Zero();
    bool is_on_seam = false;
};
using SeamCorners = std::array<SeamCorner, 4>;  ///< of a four-sided face, in order

/// `triangles` of a four-sided face, or those along its other diagonal where that spares a triangle with all
/// corners on seams, which the other side of the seams might have, too: as in the corner of a pillow.
std::vector<Face> cut_off_seams(const SeamCorners& corners, const std::vector<Face>& triangles);

}  // namespace arris
