// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// Target edge length and face angle of mesh clean-up, as functions of the material point.
struct MeshTarget {
    std::function<double(const Vec2&)> length;       ///< of edges, m
    std::function<double(const Vec2&)> least_angle;  ///< least angle allowed in faces, degrees
    std::vector<double> mean_lengths = {0.0};        ///< mean edge length, m, of each piece of cloth
    /// Bounds: shortest <= `length` <= longest, `least_angle` <= most_angle. They save most calls of the
    /// functions.
    double shortest = 0.0, longest = std::numeric_limits<double>::infinity(), most_angle = 180.0;
};

/// A target that does not depend on the material point.
MeshTarget uniform_target(double length, double least_angle);

}  // namespace arris
