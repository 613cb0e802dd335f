// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/check/sweep_violation.h"

#include <algorithm>

#include "geometry/contact/contact_begin.h"

namespace arris {
namespace {

// Sine below which the way to a point runs along a plane: it then gives no side of the plane, and the plane
// would hold nothing back.
constexpr double kAlongPlane = 1e-3;

/// The data of a hit, for any pair of elements.
struct Meeting {
    const ClothMotion& motion;
    ContactKind kind;
    ClothPoint cloth_point;
    int element;
    Vec3 point;
    Vec3 begin;  ///< of the cloth's point
    double thickness;
    double touch;  ///< m, touch_distance

    Vec3 end() const { return cloth_point.at(motion.end); }
};

/// Returns nothing unless the plane separates the cloth's point at begin, which came along `way`, from that
/// point at the end. Only the begin determines the stand-off. In contacts made before the solve, the end
/// shows what slides along a curve; here the end is the violation. A gap below the touch distance has to grow
/// to it: rounding would close such a gap again, solve after solve.
std::optional<ObstacleContact> as_violation(const Meeting& meeting, ObstacleContact contact,
                                            const Vec3& begin, double least_sine)
{
    const ClothPoint cloth_point{contact.vertices, contact.weights};
    const Vec3 way = begin - contact.point;
    const double begin_gap = contact.normal.dot(way);
    if (!(begin_gap > least_sine * way.norm())) return std::nullopt;
    contact.least_gap = std::min(meeting.thickness, std::max(begin_gap, meeting.touch));
    const double end_gap = contact.normal.dot(cloth_point.at(meeting.motion.end) - contact.point);
    if (!(end_gap < contact.least_gap)) return std::nullopt;
    return contact;
}

/// Tries the plane through the meeting point with this normal.
std::optional<ObstacleContact> try_normal(const Meeting& meeting, const Vec3& normal, double least_sine)
{
    if (!(normal.squaredNorm() > 0.0)) return std::nullopt;
    const ObstacleContact contact = make_contact(meeting.kind, meeting.cloth_point, meeting.element, normal,
                                                 meeting.point, meeting.thickness);
    return as_violation(meeting, contact, meeting.begin, least_sine);
}

/// The plane of the hit. If that fails, the plane across the way of the cloth's point, which began before the
/// plane and ended behind it.
std::optional<ObstacleContact> by_hit(const Meeting& meeting, const SweepHit& hit)
{
    const std::optional<ObstacleContact> contact = try_normal(meeting, hit.normal, 0.0);
    return contact ? contact : try_normal(meeting, (meeting.begin - meeting.end()).stableNormalized(), 0.0);
}

}  // namespace

std::optional<ObstacleContact> make_vertex_violation(const Obstacle& obstacle, const ClothMotion& motion,
                                                     int vertex, int face, const SweepHit& hit,
                                                     const Vec3& begin, double thickness)
{
    const Meeting meeting{motion, ContactKind::Vertex, {{vertex, -1, -1}, hit.weights},    face, hit.point,
                          begin,  thickness,           touch_distance(obstacle, thickness)};
    const Vec3& normal = obstacle.topology().face_normals[face];
    const bool is_above = normal.dot(meeting.begin - hit.point) > 0.0;
    const auto contact = try_normal(meeting, is_above ? normal : Vec3(-normal), kAlongPlane);
    return contact ? contact : by_hit(meeting, hit);
}

std::optional<ObstacleContact> make_edge_violation(const Obstacle& obstacle, const ClothMotion& motion,
                                                   int cloth_edge, int edge, const SweepHit& hit,
                                                   const Vec3& begin, double thickness)
{
    const MeshEdge& cloth = (*motion.edges)[cloth_edge];
    const Meeting meeting{motion, ContactKind::Edge, {{cloth.a, cloth.b, -1}, hit.weights}, edge, hit.point,
                          begin,  thickness,         touch_distance(obstacle, thickness)};
    const auto found = make_edge_contact(obstacle, motion, motion.end, {cloth.a, cloth.b}, edge, thickness);
    // The begin determines the side, however nearly the cloth moved along the edge: the hit's own normal may
    // point inside.
    const auto began = [&] { return begin_from_edge(obstacle, motion, {cloth.a, cloth.b}, edge); };
    const auto contact = found ? as_violation(meeting, *found, found->at(began()), 0.0) : std::nullopt;
    return contact ? contact : by_hit(meeting, hit);
}

std::optional<ObstacleContact> make_face_violation(const Obstacle& obstacle, const ClothMotion& motion,
                                                   int cloth_face, int point, const SweepHit& hit,
                                                   const Vec3& begin, double thickness)
{
    const Meeting meeting{motion,
                          ContactKind::Triangle,
                          {(*motion.faces)[cloth_face], hit.weights},
                          point,
                          hit.point,
                          begin,
                          thickness,
                          touch_distance(obstacle, thickness)};
    const auto found = make_face_contact(obstacle, motion, motion.end, cloth_face, point, thickness);
    const auto contact =
        found
            ? as_violation(meeting, *found, found->at(begin_from_point(obstacle, motion, point)), kAlongPlane)
            : std::nullopt;
    return contact ? contact : by_hit(meeting, hit);
}

}  // namespace arris
