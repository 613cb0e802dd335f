// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surgery/patch_quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace arris {

double least_angle(const PatchFace& face)
{
    // At each corner tan = cross / dot; atan2 needs no division and no clamp. The cross product is equal at
    // all corners, so the dot products show which angle is least.
    const auto& X = face.material;
    const double doubled = twice_area(X[0], X[1], X[2]);
    std::array<double, 3> dots;
    for (int k = 0; k < 3; ++k) dots[k] = (X[(k + 1) % 3] - X[k]).dot(X[(k + 2) % 3] - X[k]);
    const auto [low, high] = std::minmax_element(dots.begin(), dots.end());
    return std::atan2(doubled, doubled < 0.0 ? *low : *high) * 180.0 / std::numbers::pi;
}

double least_angle(const std::vector<PatchFace>& faces)
{
    double least = 180.0;
    for (const PatchFace& face : faces) least = std::min(least, least_angle(face));
    return least;
}

double longest_edge(const std::vector<PatchFace>& faces)
{
    double longest = 0.0;
    for (const PatchFace& face : faces)
        for (int k = 0; k < 3; ++k)
            longest = std::max(longest, (face.material[(k + 1) % 3] - face.material[k]).norm());
    return longest;
}

Vec2 material_centre(const PatchFace& face)
{
    return (face.material[0] + face.material[1] + face.material[2]) / 3.0;
}

}  // namespace arris
