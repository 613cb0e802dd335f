// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <limits>

#include "geometry/cloth_surgery.h"

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

/// Least angle of a face in material space, degrees; negative if it is clockwise.
double least_angle(const PatchFace& face);
/// Of all; 180 for none.
double least_angle(const std::vector<PatchFace>& faces);
/// In material space, m; 0 for none.
double longest_edge(const std::vector<PatchFace>& faces);
Vec2 material_centre(const PatchFace& face);

}  // namespace arris
