// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/surface_ride.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "geometry/closest_point.h"
#include "geometry/obstacle/normal_cone.h"

namespace arris {
namespace {

/// Directions that turn with an element: its first side or itself, and its normal. A zero normal is unknown.
struct Directions {
    Vec3 along, normal;
};

Vec3 side_of(const Obstacle& pose, int edge)
{
    const auto& [a, b] = pose.topology().edges[edge].points;
    return pose.mesh().points[b] - pose.mesh().points[a];
}

Directions of_face(const Obstacle& pose, int face)
{
    return {side_of(pose, pose.topology().face_edges[face][0]).stableNormalized(),
            pose.topology().face_normals[face]};
}

Directions of_edge(const Obstacle& pose, int edge)
{
    const Vec3 along = side_of(pose, edge).stableNormalized();
    const Vec3 outward = outward_of_edge(pose, edge);
    const Vec3 across = outward - along.dot(outward) * along;
    constexpr double kSeen = 1e-3;  // of a sum of unit normals: less where faces are folded onto each other
    return {along, across.norm() > kSeen ? Vec3(across.normalized()) : Vec3(Vec3::Zero())};
}

/// The rotation that takes one pair of directions to another; the least one where a normal is unknown.
Mat3 turn_between(const Directions& from, const Directions& to)
{
    if (from.along.isZero(0.0) || to.along.isZero(0.0)) return Mat3::Identity();
    if (from.normal.isZero(0.0) || to.normal.isZero(0.0))
        return Eigen::Quaterniond::FromTwoVectors(from.along, to.along).toRotationMatrix();
    const auto frame = [](const Directions& d) {
        Mat3 columns;
        columns << d.along, d.normal.cross(d.along), d.normal;
        return columns;
    };
    return frame(to) * frame(from).transpose();
}

Mat3 nearest_rotation(const Mat3& sum)
{
    const Eigen::JacobiSVD<Mat3> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Mat3 flip = Mat3::Identity();
    flip(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
    return svd.matrixU() * flip * svd.matrixV().transpose();
}

/// Visits the wires at a point, and the faces: use_face(face), use_wire(edge).
template <class UseFace, class UseWire>
void visit_around(const ObstacleTopology& topology, int point, const UseFace& use_face,
                  const UseWire& use_wire)
{
    for (int k = 0; k < topology.edge_count_at(point); ++k)
        if (const int edge = topology.edge_at(point, k); topology.edges[edge].faces[0] < 0) use_wire(edge);
    for (const int face : topology.faces_at(point)) use_face(face);
}

Mat3 turn_of(const Obstacle& from, const Obstacle& to, const SurfacePlace& on)
{
    if (on.kind == SurfaceKind::Triangle)
        return turn_between(of_face(from, on.element), of_face(to, on.element));
    if (on.kind == SurfaceKind::Edge) return turn_between(of_edge(from, on.element), of_edge(to, on.element));
    Mat3 sum = Mat3::Zero();
    visit_around(
        from.topology(), on.element,
        [&](int face) { sum += turn_between(of_face(from, face), of_face(to, face)); },
        [&](int wire) { sum += turn_between(of_edge(from, wire), of_edge(to, wire)); });
    return sum.isZero(0.0) ? Mat3::Identity() : nearest_rotation(sum);
}

/// Angular velocity of an edge without that about itself, rad/s: t x t'.
Vec3 spin_across(const Obstacle& pose, const std::vector<Vec3>& velocities, int edge)
{
    const auto& [a, b] = pose.topology().edges[edge].points;
    const Vec3 side = side_of(pose, edge);
    const double square = side.squaredNorm();
    return square > 0.0 ? Vec3(side.cross(velocities[b] - velocities[a]) / square) : Vec3(Vec3::Zero());
}

/// Angular velocity of a face about one of its edges, rad/s. The face's normal n stays normal to the way
/// d = along t + h e from the edge to the face's third point, whose velocity beside the edge's is d':
/// (n . d' - along n . t') / h.
double spin_about(const Obstacle& pose, const std::vector<Vec3>& velocities, int face, int edge)
{
    const auto& [a, b] = pose.topology().edges[edge].points;
    const Face& corners = pose.mesh().faces[face];
    const int third = *std::find_if(corners.begin(), corners.end(), [&](int p) { return p != a && p != b; });
    const std::vector<Vec3>& points = pose.mesh().points;
    const Vec3& normal = pose.topology().face_normals[face];
    const Vec3 side = side_of(pose, edge), way = points[third] - points[a];
    const double length = side.norm();
    const Vec3 along = side / length;
    const Vec3 into = into_face(pose, face, edge);
    const double height = into.dot(way);
    if (!(length > 0.0) || !(height > 0.0)) return 0.0;
    const double lifted = normal.dot(velocities[third] - velocities[a]) -
                          along.dot(way) / length * normal.dot(velocities[b] - velocities[a]);
    // `into` is n x t in the face's own direction of the edge, so the sense of the turn follows from it.
    return lifted / height * (normal.cross(along).dot(into) > 0.0 ? 1.0 : -1.0);
}

/// Angular velocity of an edge with its faces in the mean, or of a face given one of its edges, rad/s.
Vec3 spin_of_edge(const Obstacle& pose, const std::vector<Vec3>& velocities, int edge,
                  const std::array<int, 2>& faces)
{
    Vec3 spin = spin_across(pose, velocities, edge);
    if (faces[0] < 0) return spin;
    double about = spin_about(pose, velocities, faces[0], edge);
    if (faces[1] >= 0) about = 0.5 * (about + spin_about(pose, velocities, faces[1], edge));
    return spin + about * side_of(pose, edge).stableNormalized();
}

Vec3 spin_of_face(const Obstacle& pose, const std::vector<Vec3>& velocities, int face)
{
    return spin_of_edge(pose, velocities, pose.topology().face_edges[face][0], {face, -1});
}

Vec3 spin_of(const Obstacle& pose, const std::vector<Vec3>& velocities, const SurfacePlace& on)
{
    if (on.kind == SurfaceKind::Triangle) return spin_of_face(pose, velocities, on.element);
    if (on.kind == SurfaceKind::Edge)
        return spin_of_edge(pose, velocities, on.element, pose.topology().edges[on.element].faces);
    Vec3 sum = Vec3::Zero();
    int count = 0;
    const auto add = [&](const Vec3& spin) {
        sum += spin;
        ++count;
    };
    visit_around(
        pose.topology(), on.element, [&](int face) { add(spin_of_face(pose, velocities, face)); },
        [&](int wire) { add(spin_across(pose, velocities, wire)); });
    return count > 0 ? Vec3(sum / count) : sum;
}

/// Collects the nearest of several places.
struct Nearest {
    const Vec3& place;
    double least;
    SurfacePlace on = {};

    void take(const Vec3& point, const SurfacePlace& candidate)
    {
        const double distance = (place - point).norm();
        if (!(distance < least)) return;
        least = distance;
        on = candidate;
    }
};

SurfacePlace on_edge(int edge, int from, int to, double weight_of_to)
{
    return {SurfaceKind::Edge, edge, {from, to, -1}, {1.0 - weight_of_to, weight_of_to, 0.0}};
}

SurfacePlace at_point(int point)
{
    return {SurfaceKind::Point, point, {point, -1, -1}, {1.0, 0.0, 0.0}};
}

void take_face(const Obstacle& obstacle, int face, Nearest& nearest)
{
    const Face& corners = obstacle.mesh().faces[face];
    const std::vector<Vec3>& points = obstacle.mesh().points;
    const PointOnTriangle found =
        closest_on_triangle(nearest.place, {points[corners[0]], points[corners[1]], points[corners[2]]},
                            obstacle.topology().face_normals[face]);
    if (found.corner >= 0) return nearest.take(found.point, at_point(corners[found.corner]));
    if (found.edge < 0)
        return nearest.take(found.point, {SurfaceKind::Triangle, face, corners, found.weights});
    const int i = found.edge, j = (i + 1) % 3;
    nearest.take(found.point,
                 on_edge(obstacle.topology().face_edges[face][i], corners[i], corners[j], found.weights[j]));
}

void take_wire(const Obstacle& obstacle, int edge, Nearest& nearest)
{
    const auto& [a, b] = obstacle.topology().edges[edge].points;
    const std::vector<Vec3>& points = obstacle.mesh().points;
    const double t = closest_on_segment(nearest.place, points[a], points[b]);
    const Vec3 point = points[a] + t * (points[b] - points[a]);
    nearest.take(point, t > 0.0 && t < 1.0 ? on_edge(edge, a, b, t) : at_point(t > 0.0 ? b : a));
}

}  // namespace

std::optional<SurfacePlace> find_nearest(const Obstacle& obstacle, const Vec3& place, double most)
{
    const double farthest =
        obstacle.bounds().diagonal().norm() + std::sqrt(obstacle.bounds().squaredExteriorDistance(place));
    Nearest nearest{place, std::min(most, 2.0 * farthest + 1.0)};
    if (const int face = obstacle.find_nearest_face(place, nearest.least); face >= 0)
        take_face(obstacle, face, nearest);
    const Box3 box(place.array() - nearest.least, place.array() + nearest.least);
    std::vector<int> near;
    if (!obstacle.mesh().segments.empty()) {
        obstacle.find_feature_edges(box, near);
        for (const int f : near)
            if (const FeatureEdge& feature = obstacle.features().edges[f]; feature.kind == FeatureKind::Wire)
                take_wire(obstacle, feature.edge, nearest);
    }
    if (!obstacle.mesh().lone_points.empty()) {
        obstacle.find_corners(box, near);
        for (const int c : near) {
            const int point = obstacle.features().corners[c].point;
            if (obstacle.topology().edge_count_at(point) == 0)
                nearest.take(obstacle.mesh().points[point], at_point(point));
        }
    }
    if (nearest.on.element < 0) return std::nullopt;
    return nearest.on;
}

Placement find_way(const Obstacle& from, const Obstacle& to, const SurfacePlace& on)
{
    const Mat3 turn = turn_of(from, to, on);
    return {turn, on.at(to.mesh().points) - turn * on.at(from.mesh().points)};
}

double longest_way(const std::vector<Vec3>& begin, const std::vector<Vec3>& end)
{
    double longest = 0.0;
    for (std::size_t p = 0; p < end.size(); ++p) longest = std::max(longest, (end[p] - begin[p]).norm());
    return longest;
}

Vec3 riding_velocity(const Obstacle& pose, const std::vector<Vec3>& velocities, const SurfacePlace& on,
                     const Vec3& place)
{
    return on.at(velocities) + spin_of(pose, velocities, on).cross(place - on.at(pose.mesh().points));
}

}  // namespace arris
