// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/feature_frame.h"

#include <algorithm>
#include <cmath>

#include "geometry/closest_point.h"
#include "geometry/middle_direction.h"
#include "geometry/obstacle/feature_path.h"
#include "geometry/obstacle/normal_cone.h"

namespace arris {
namespace {

constexpr double kLongestMitre = 2.0;  // bounds the mitre at very sharp edges, such as a knife's
constexpr double kLeastPart = 0.1;     // least component of outward along each normal

double mitre_of(double least_part)
{
    return least_part * kLongestMitre > 1.0 ? 1.0 / least_part : kLongestMitre;
}

// Outward is the cloth's mean normal, signed towards its outer side, plus the direction opposite to where its
// two sides leave. On cloth that bends over the feature like a V, both vectors are parallel, and one is short
// where the other is long. Their sum turns steadily from flat cloth to cloth that hangs down on both sides.
// Returns nothing where both vectors are too short.
std::optional<Vec3> outward_of_cloth(const ClothAround& cloth, const Vec3& tangent)
{
    constexpr double kShort = 1e-3;  // length of a sum of unit vectors
    const auto across = [&](const Vec3& v) { return Vec3(v - tangent.dot(v) * tangent); };
    const Vec3 normal = across(cloth.normal), back = across(-cloth.leaving);
    if (!(std::max(normal.norm(), back.norm()) > kShort)) return std::nullopt;
    // The sign of the normal comes from the known orientation; else from the fold, if there is one; else from
    // the side on which the cloth has been.
    const Vec3& known = back.norm() > normal.norm() ? back : cloth.side;
    const bool is_inward = cloth.orientation != 0 ? cloth.orientation < 0 : normal.dot(known) < 0.0;
    const Vec3 outward = is_inward ? Vec3(back - normal) : Vec3(back + normal);
    if (!(outward.norm() > kShort)) return std::nullopt;
    return outward.normalized();
}

// Unit directions from a point along its edges.
std::vector<Vec3> find_edges_away(const Obstacle& obstacle, int point)
{
    const ObstacleTopology& topology = obstacle.topology();
    std::vector<Vec3> away;
    for (int k = 0; k < topology.edge_count_at(point); ++k) {
        const auto& [a, b] = topology.edges[topology.edge_at(point, k)].points;
        const int other = a == point ? b : a;
        away.push_back((obstacle.mesh().points[other] - obstacle.mesh().points[point]).normalized());
    }
    return away;
}

bool is_on_solid(const Obstacle& obstacle, int point)
{
    const ObstacleTopology& topology = obstacle.topology();
    for (int k = 0; k < topology.edge_count_at(point); ++k)
        for (const int f : topology.edges[topology.edge_at(point, k)].faces)
            if (f >= 0) return topology.is_solid[topology.component[f]] != 0;
    return false;
}

}  // namespace

std::optional<FeatureFrame> find_edge_frame(const Obstacle& obstacle, int edge, const Vec3& place,
                                            const ClothAround& cloth)
{
    const FeatureEdge& feature = obstacle.features().edges[edge];
    const ObstacleEdge& ends = obstacle.topology().edges[feature.edge];
    const Vec3& a = obstacle.mesh().points[ends.points[0]];
    const Vec3& b = obstacle.mesh().points[ends.points[1]];
    const double s = closest_on_segment(place, a, b);
    FeatureFrame frame{a + s * (b - a), (b - a).normalized(), Vec3::Zero(), 1.0};
    if (feature.kind == FeatureKind::Wire) {
        const std::optional<Vec3> outward = outward_of_cloth(cloth, frame.tangent);
        if (!outward) return std::nullopt;
        frame.outward = *outward;
        return frame;
    }
    // Opposite to the directions into both faces. This is the bisector of the faces' normals, and remains
    // defined on a knife, where the normals cancel.
    Vec3 inside = Vec3::Zero();
    for (const int f : ends.faces)
        if (f >= 0) inside += into_face(obstacle, f, feature.edge);
    frame.outward = -inside.normalized();
    if (feature.kind == FeatureKind::Convex)
        frame.mitre = mitre_of(std::abs(feature.normals[0].dot(frame.outward)));
    return frame;
}

std::optional<FeatureFrame> find_bend_frame(const Obstacle& obstacle, int edge, int end,
                                            const ClothAround& cloth)
{
    const FeatureBend bend{edge, end};
    const Vec3 tangent = tangent_at(obstacle, bend);
    const std::optional<Vec3> outward = outward_of_cloth(cloth, tangent);
    if (!outward) return std::nullopt;
    return FeatureFrame{bend_point(obstacle, bend), tangent, *outward, 1.0};
}

std::optional<FeatureFrame> find_corner_frame(const Obstacle& obstacle, int corner, const Vec3& place,
                                              const ClothAround& cloth)
{
    const FeatureCorner& feature = obstacle.features().corners[corner];
    FeatureFrame frame{obstacle.mesh().points[feature.point], Vec3::Zero(), Vec3::Zero(), 1.0};
    std::optional<Vec3> outward;
    if (feature.normals.empty()) {
        ClothAround around = cloth;
        if (around.side.squaredNorm() == 0.0) around.side = place - frame.point;
        outward = outward_of_cloth(around, Vec3::Zero());
    } else {
        std::vector<Vec3> directions = feature.normals;
        if (!is_on_solid(obstacle, feature.point)) {
            directions = find_edges_away(obstacle, feature.point);
            for (Vec3& d : directions) d = -d;
        }
        outward = find_middle(directions);
        if (outward && least_part(directions, *outward) < kLeastPart) return std::nullopt;
        if (outward) frame.mitre = mitre_of(least_part(feature.normals, *outward));
    }
    if (!outward) return std::nullopt;
    frame.outward = *outward;
    return frame;
}

}  // namespace arris
