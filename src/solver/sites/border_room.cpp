// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sites/border_room.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "solver/eol/cloth_stars.h"
#include "solver/eol/eol_features.h"
#include "solver/model/eol_limits.h"

namespace arris {

namespace {

/// Tangent of the feature in the world, at the state's time.
Vec3 tangent_of(const Scene& scene, const State& state, const EolVertex& eol)
{
    const ObstaclePose obstacle = scene.obstacles[eol.on.obstacle].at(state.time);
    return obstacle.placement.rotation * feature_tangent(obstacle, eol);
}

bool is_cloth_corner(const State& state, const ClothStars& stars, int v)
{
    const std::optional<Vec2> border = find_border(state.mesh, stars, v);
    return border && border->isZero(0.0);
}

}  // namespace

double room_to_border(const Scene& scene, const State& state, const ClothStars& stars, const Vec2& X, int v,
                      bool is_on_border, const EolVertex& eol)
{
    std::optional<Vec3> tangent;  // computed when first needed
    double least = std::numeric_limits<double>::infinity();
    const ClothMesh& mesh = state.mesh;
    for (const int f : stars.faces[v])
        for (const int point : mesh.points_of(f)) {
            if (stars.border_neighbours[point][0] < 0) continue;
            const int w = mesh.vertex_of(point);
            if (is_on_border) {
                if (is_cloth_corner(state, stars, w))
                    least = std::min(least, (X - mesh.material[point]).norm());
                continue;
            }
            for (const int next : stars.border_neighbours[point]) {
                const Vec3 way = (mesh.world[mesh.vertex_of(next)] - mesh.world[w]).normalized();
                constexpr double kAlong = 0.7;  // cosine
                if (!tangent) tangent = tangent_of(scene, state, eol);
                if (!eol.on.is_fixed() && !(std::abs(way.dot(*tangent)) > kAlong)) continue;
                const Vec2 &a = mesh.material[point], &b = mesh.material[next];
                const double s = std::clamp((X - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
                least = std::min(least, (X - a - s * (b - a)).norm());
            }
        }
    return least;
}

bool is_along_border(const Scene& scene, const State& state, const ClothStars& stars,
                     const std::array<int, 2>& edge, const EolVertex& eol)
{
    const double most = std::cos(kLeastCrossing * M_PI / 180.0);
    const auto [from, to] = edge[0] == edge[1] ? stars.border_neighbours[edge[0]] : edge;
    const auto world = [&](int point) { return state.mesh.world[state.mesh.vertex_of(point)]; };
    const Vec3 border = (world(to) - world(from)).stableNormalized();
    return std::abs(border.dot(tangent_of(scene, state, eol))) > most;
}

}  // namespace arris
