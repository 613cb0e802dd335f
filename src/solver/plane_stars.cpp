// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/plane_stars.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace arris {

namespace {

/// Normal of the faces at vertex `v`, each weighted by its area; nothing where they are folded or have no
/// area.
std::optional<Vec3> find_normal(const std::vector<Face>& faces, std::span<const int> star,
                                const std::vector<Vec3>& positions)
{
    constexpr double kFolded = 0.5;  // of the faces' area; 1 where they are plane
    Vec3 sum = Vec3::Zero();
    double area = 0.0;
    for (const int f : star) {
        const auto& [a, b, c] = faces[f];
        const Vec3 doubled = (positions[b] - positions[a]).cross(positions[c] - positions[a]);
        sum += doubled;
        area += doubled.norm();
    }
    const double length = sum.norm();
    if (!(length > kFolded * area)) return std::nullopt;
    return sum / length;
}

}  // namespace

std::vector<std::optional<Vec3>> find_plane_stars(const std::vector<Face>& faces, const VertexFaces& stars,
                                                  const std::vector<Vec3>& positions, double tolerance)
{
    constexpr double kRoundOff = 16.0 * std::numeric_limits<double>::epsilon();  // relative to a coordinate
    std::vector<std::optional<Vec3>> normals(positions.size());
    for (int v = 0; v < static_cast<int>(positions.size()); ++v) {
        const std::optional<Vec3> normal = find_normal(faces, stars[v], positions);
        if (!normal) continue;
        double height = 0.0, squared_length = 0.0;
        for (const int f : stars[v])
            for (const int w : faces[f]) {
                const Vec3 way = positions[w] - positions[v];
                height = std::max(height, std::abs(normal->dot(way)));
                squared_length = std::max(squared_length, way.squaredNorm());
            }
        const double round_off = kRoundOff * positions[v].cwiseAbs().maxCoeff();
        if (height <= tolerance * std::sqrt(squared_length) + round_off) normals[v] = normal;
    }
    return normals;
}

bool is_plane_around(int vertex, const std::vector<Face>& faces, const VertexFaces& stars,
                     const std::vector<std::optional<Vec3>>& normals)
{
    const auto is_plane = [&](int v) { return normals[v].has_value(); };
    return std::all_of(stars[vertex].begin(), stars[vertex].end(),
                       [&](int f) { return std::all_of(faces[f].begin(), faces[f].end(), is_plane); });
}

}  // namespace arris
