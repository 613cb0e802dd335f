// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <limits>

#include "geometry/vectors.h"

namespace arris {

/// What clean-up works towards, as functions of the material point.
struct MeshTarget {
    std::function<double(const Vec2&)> length;       ///< m, of edges
    std::function<double(const Vec2&)> least_angle;  ///< degrees, of faces
    double mean_length = 0.0;                        ///< m, of the whole mesh's edges
    /// No `length` or `least_angle` is beyond these: they spare most questions.
    double shortest = 0.0, longest = std::numeric_limits<double>::infinity(), most_angle = 180.0;
};

/// The same everywhere.
MeshTarget uniform_target(double length, double least_angle);

}  // namespace arris
