// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/feature_frame.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "geometry/closest_point.h"
#include "geometry/feature_path.h"
#include "geometry/normal_cone.h"

namespace arris {
namespace {

constexpr double kLongestMitre = 2.0;  // sharp stays sharp: a knife's mitre would have no end
constexpr double kLeastPart = 0.1;     // of the outward direction along each normal

double mitre_of(double least_part)
{
    return least_part * kLongestMitre > 1.0 ? 1.0 / least_part : kLongestMitre;
}

// The cloth's mean normal on its side, and the direction against where it leaves: of cloth that bends over
// the feature like a V both point the same way, the one short where the other is long, so that their sum
// turns evenly from flat cloth to cloth that hangs down on both sides. Nothing where both are too short.
std::optional<Vec3> outward_of_cloth(const ClothAround& cloth, const Vec3& tangent)
{
    constexpr double kShort = 1e-3;  // of a sum of unit vectors
    const auto across = [&](const Vec3& v) { return Vec3(v - tangent.dot(v) * tangent); };
    const Vec3 normal = across(cloth.normal), back = across(-cloth.leaving);
    if (!(std::max(normal.norm(), back.norm()) > kShort)) return std::nullopt;
    // Which way the normal goes, unless it is known, the fold tells where there is one, else where the cloth
    // has been.
    const Vec3& known = back.norm() > normal.norm() ? back : cloth.side;
    const bool is_inward = cloth.orientation != 0 ? cloth.orientation < 0 : normal.dot(known) < 0.0;
    const Vec3 outward = is_inward ? Vec3(back - normal) : Vec3(back + normal);
    if (!(outward.norm() > kShort)) return std::nullopt;
    return outward.normalized();
}

// Calls visit with every direction that is equally far from one, two or three of `directions`.
template <typename Visit>
void for_each_candidate(const std::vector<Vec3>& directions, const Visit& visit)
{
    constexpr double kIndependent = 1e-9;  // determinant of three unit vectors
    const std::size_t n = directions.size();
    for (std::size_t i = 0; i < n; ++i) {
        visit(directions[i]);
        for (std::size_t j = i + 1; j < n; ++j) {
            visit(directions[i] + directions[j]);
            for (std::size_t k = j + 1; k < n; ++k) {
                Mat3 rows;
                rows << directions[i].transpose(), directions[j].transpose(), directions[k].transpose();
                if (std::abs(rows.determinant()) > kIndependent) visit(rows.inverse() * Vec3::Ones());
            }
        }
    }
}

double least_part(const std::vector<Vec3>& directions, const Vec3& along)
{
    double least = 1.0;
    for (const Vec3& d : directions) least = std::min(least, d.dot(along));
    return least;
}

// Unit directions from a point along its feature edges.
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

std::optional<Vec3> find_middle(const std::vector<Vec3>& directions)
{
    Vec3 best = Vec3::Zero();
    double best_part = 0.0;
    for_each_candidate(directions, [&](const Vec3& candidate) {
        if (!(candidate.norm() > 0.0)) return;
        const Vec3 unit = candidate.normalized();
        const double part = least_part(directions, unit);
        if (part > best_part) {
            best = unit;
            best_part = part;
        }
    });
    return best_part > 0.0 ? std::optional(best) : std::nullopt;
}

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
    // Against the inside of both faces: the bisector of their normals, also on a knife, where these cancel.
    Vec3 inside = Vec3::Zero();
    for (const int f : ends.faces)
        if (f >= 0) inside += into_face(obstacle, f, feature.edge);
    frame.outward = -inside.normalized();
    if (feature.kind == FeatureKind::Convex)
        frame.mitre = mitre_of(std::abs(feature.normals[0].dot(frame.outward)));
    return frame;
}

std::optional<FeatureFrame> find_turn_frame(const Obstacle& obstacle, int edge, int end,
                                            const ClothAround& cloth)
{
    const FeatureTurn turn{edge, end};
    const Vec3 tangent = tangent_at(obstacle, turn);
    const std::optional<Vec3> outward = outward_of_cloth(cloth, tangent);
    if (!outward) return std::nullopt;
    return FeatureFrame{turn_point(obstacle, turn), tangent, *outward, 1.0};
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
