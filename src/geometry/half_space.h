// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/vectors.h"

namespace arris {

/// The solid below a plane: cloth stays where normal . x >= offset (+ thickness).
struct HalfSpace {
    Vec3 normal = Vec3::UnitZ();  ///< unit length, out of the solid
    double offset = 0.0;          ///< m
};

}  // namespace arris
