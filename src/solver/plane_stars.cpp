// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/plane_stars.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "geometry/tolerances.h"

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

std::optional<Vec3> find_plane_normal(int vertex, const std::vector<Face>& faces, const VertexFaces& stars,
                                      const std::vector<Vec3>& positions, double tolerance)
{
    const std::optional<Vec3> normal = find_normal(faces, stars[vertex], positions);
    if (!normal) return std::nullopt;
    double height = 0.0, squared_length = 0.0;
    for (const int f : stars[vertex])
        for (const int w : faces[f]) {
            const Vec3 way = positions[w] - positions[vertex];
            height = std::max(height, std::abs(normal->dot(way)));
            squared_length = std::max(squared_length, way.squaredNorm());
        }
    const double round_off = kProductRounding * positions[vertex].cwiseAbs().maxCoeff();
    return height <= tolerance * std::sqrt(squared_length) + round_off ? normal : std::nullopt;
}

const std::optional<Vec3>& PlaneStars::normal(int vertex)
{
    if (is_known_.empty()) {
        is_known_.assign(vertex_count_, 0);
        normals_.resize(vertex_count_);
    }
    if (!is_known_[vertex]) {
        normals_[vertex] = find_(vertex);
        is_known_[vertex] = 1;
    }
    return normals_[vertex];
}

bool PlaneStars::is_plane_around(int vertex)
{
    const auto is_plane = [&](int v) { return normal(v).has_value(); };
    return std::all_of(stars_[vertex].begin(), stars_[vertex].end(),
                       [&](int f) { return std::all_of(faces_[f].begin(), faces_[f].end(), is_plane); });
}

}  // namespace arris
