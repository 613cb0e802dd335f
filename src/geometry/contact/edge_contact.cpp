// SPDX-License-Identifier: GPL-3.0-or-later
//
// Contacts of a cloth edge and a feature edge. Two lines that cross in space are kept apart along the cross
// product of their directions. On a touch the normal points to the side from which the cloth came; without a
// touch it is the direction between the closest points. Closest points give a contact only where that
// direction lies in the feature's normal cone. The normal is clamped into the cone.
//
// A closest point on a polyline may be the node between two segments; it then belongs to the segment of lower
// index. Of touches with adjacent segments only the first in time counts, as the others follow from it.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "geometry/closest_point.h"
#include "geometry/batches.h"
#include "geometry/contact/contact_plane.h"
#include "geometry/contact/continuous_collision.h"
#include "geometry/contact/obstacle_contact.h"
#include "geometry/obstacle/feature_nodes.h"
#include "geometry/obstacle/normal_cone.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

using Segment = std::array<Vec3, 2>;

struct EdgePair {
    std::array<int, 2> vertices;
    int element;
    ContactBegin begins;
    Segment begin, reference, segment;
    double thickness;
};

struct TimedContact {
    ObstacleContact contact;
    double time;
};

EdgePair make_pair(const Obstacle& obstacle, const ClothMotion& motion, const std::vector<Vec3>& reference,
                   const std::array<int, 2>& v, int element, double thickness)
{
    const std::array<int, 2>& ends = obstacle.topology().edges[element].points;
    const std::vector<Vec3>& points = obstacle.mesh().points;
    const ContactBegin begin = begin_from_edge(obstacle, motion, v, element);
    return {v,
            element,
            begin,
            {begin[v[0]], begin[v[1]]},
            {reference[v[0]], reference[v[1]]},
            {points[ends[0]], points[ends[1]]},
            thickness};
}

Vec3 at(const Segment& segment, double s)
{
    return segment[0] + s * (segment[1] - segment[0]);
}

double sine_between(const Vec3& a, const Vec3& b)
{
    const double lengths = std::sqrt(a.squaredNorm() * b.squaredNorm());
    return lengths > 0.0 ? a.cross(b).norm() / lengths : 0.0;
}

// The side, 1 or -1, of the plane through `point` on which the cloth edge was at begin; 0 if it came within
// the plane. A point of the cloth that meets the plane later comes from its side at begin. If that point
// moved in the plane, the edges' closest points at begin decide.
int side_of_begin(const Obstacle& obstacle, const EdgePair& pair, double s, const Vec3& point,
                  const Vec3& normal)
{
    const SegmentPair closest = closest_between_segments(pair.begin, pair.segment);
    const double least = touch_distance(obstacle, pair.thickness);
    for (const Vec3& from : {Vec3(at(pair.begin, s) - point), Vec3(closest.first - closest.second)}) {
        const double height = normal.dot(from);
        if (from.norm() > least && std::abs(height) > kLevel * from.norm()) return height > 0.0 ? 1 : -1;
    }
    return 0;
}

// Direction from the feature to where the cloth's point came from, perpendicular to `along`.
Vec3 approach_direction(const EdgePair& pair, double s, const Vec3& point, const Vec3& along)
{
    const Vec3 unit = along.stableNormalized();
    const auto across = [&](const Vec3& d) { return Vec3(d - unit.dot(d) * unit); };
    const Vec3 way = across(at(pair.begin, s) - point);
    if (way.norm() > kTinyDistance * pair.thickness) return way;
    const SegmentPair closest = closest_between_segments(pair.begin, pair.segment);
    return across(closest.first - closest.second);
}

// The direction that keeps apart edges that touch at `time`; zero where the cloth's side is unknown.
Vec3 normal_of_touch(const Obstacle& obstacle, const EdgePair& pair, double time, double s, const Vec3& point)
{
    const Vec3 edge = pair.segment[1] - pair.segment[0];
    const Segment now = {pair.begin[0] + time * (pair.reference[0] - pair.begin[0]),
                         pair.begin[1] + time * (pair.reference[1] - pair.begin[1])};
    const Vec3 cloth = now[1] - now[0];
    const bool is_crossing = sine_between(cloth, edge) > kParallel;
    Vec3 normal = Vec3::Zero();
    if (is_crossing) {
        normal = cloth.cross(edge).normalized();
        normal *= side_of_begin(obstacle, pair, s, point, normal);
    }
    // Separate parallel edges, and edges that approach within their common plane, along the direction of
    // approach.
    if (!(normal.squaredNorm() > 0.0)) {
        normal = approach_direction(pair, s, point, is_crossing ? cloth : edge);
        if (!(normal.norm() > touch_distance(obstacle, pair.thickness))) return Vec3::Zero();
        normal.normalize();
        if (is_crossing) return normal;  // the normal at a node, which is in no single edge's cone
    }
    // The clamped normal must still have the cloth's begin on its free side, or the contact would hold
    // nothing back. Where another part of the cloth has sunk into a face, the cross product may point inside.
    // The way from the begin does not.
    const Vec3 from = at(pair.begin, s) - point;
    const Vec3 clamped = clamp_to_edge_cone(obstacle, pair.element, normal);
    if (clamped.dot(from) >= 0.0) return clamped;
    if (!(from.norm() > touch_distance(obstacle, pair.thickness))) return normal;
    const Vec3 outside = clamp_to_edge_cone(obstacle, pair.element, from.normalized());
    return outside.dot(from) >= 0.0 ? outside : normal;
}

bool is_feature(const Obstacle& obstacle, int edge)
{
    const std::vector<FeatureEdge>& edges = obstacle.features().edges;
    const auto found = std::lower_bound(edges.begin(), edges.end(), edge,
                                        [](const FeatureEdge& f, int e) { return f.edge < e; });
    return found != edges.end() && found->edge == edge;
}

// A node inside a polyline belongs to its feature edge of lowest index. Corners belong to contacts of cloth
// faces.
bool owns_node(const Obstacle& obstacle, const EdgePair& pair, int point)
{
    if (is_corner(obstacle.features(), point)) return false;
    const ObstacleTopology& topology = obstacle.topology();
    const Vec3 cloth = pair.reference[1] - pair.reference[0];
    bool has_crossing = false;
    for (int k = 0; k < topology.edge_count_at(point); ++k) {
        const int e = topology.edge_at(point, k);
        if (!is_feature(obstacle, e)) continue;
        if (e < pair.element) return false;
        const auto& [a, b] = topology.edges[e].points;
        has_crossing = has_crossing ||
                       sine_between(cloth, obstacle.mesh().points[b] - obstacle.mesh().points[a]) > kStraight;
    }
    return has_crossing;
}

std::optional<ObstacleContact> contact_of(const Obstacle& obstacle, const ClothMotion& motion,
                                          const EdgePair& pair, double s, const Vec3& normal,
                                          const Vec3& point)
{
    if (!(normal.squaredNorm() > 0.0)) return std::nullopt;
    const ClothPoint cloth_point{{pair.vertices[0], pair.vertices[1], -1}, {1.0 - s, s, 0.0}};
    return make_contact(obstacle, motion, pair.begins, ContactKind::Edge, cloth_point, pair.element, normal,
                        point, pair.thickness);
}

bool is_inside(double s)
{
    return s > kEndWeight && s < 1.0 - kEndWeight;
}

// The plane between the closest points at the reference position, if they are a local minimum of distance.
std::optional<ObstacleContact> contact_at_rest(const Obstacle& obstacle, const ClothMotion& motion,
                                               const EdgePair& pair)
{
    const SegmentPair closest = closest_between_segments(pair.reference, pair.segment);
    if (!is_inside(closest.s)) return std::nullopt;
    const Vec3 between = closest.first - closest.second;
    const double distance = between.norm();
    if (!(distance <= longest_reach(motion, pair.vertices, pair.thickness))) return std::nullopt;

    const bool has_direction = distance > kTinyDistance * pair.thickness;
    Vec3 normal = has_direction ? Vec3(between / distance)
                                : normal_of_touch(obstacle, pair, 1.0, closest.s, closest.second);
    if (closest.t > 0.0 && closest.t < 1.0) {
        if (!(sine_between(pair.reference[1] - pair.reference[0], pair.segment[1] - pair.segment[0]) >
              kParallel))
            return std::nullopt;
        if (!is_in_edge_cone(obstacle, pair.element, normal)) return std::nullopt;
        normal = clamp_to_edge_cone(obstacle, pair.element, normal);
    } else {
        const int point = obstacle.topology().edges[pair.element].points[closest.t > 0.0 ? 1 : 0];
        if (!owns_node(obstacle, pair, point) || !is_in_point_cone(obstacle, point, normal))
            return std::nullopt;
    }
    // Reject a plane behind which the cloth began: it would pull the cloth through to where its free motion
    // ends.
    if (!(normal.dot(at(pair.begin, closest.s) - closest.second) >=
          -touch_distance(obstacle, pair.thickness)))
        return std::nullopt;
    return contact_of(obstacle, motion, pair, closest.s, normal, closest.second);
}

std::optional<TimedContact> find_pair_contact(const Obstacle& obstacle, const ClothMotion& motion,
                                              const EdgePair& pair)
{
    const std::optional<SweepHit> hit =
        sweep_edge_edge(pair.begin, pair.reference, pair.segment, touch_distance(obstacle, pair.thickness));
    std::optional<ObstacleContact> contact;
    if (!hit) {
        contact = contact_at_rest(obstacle, motion, pair);
    } else if (is_inside(hit->weights[1])) {
        const Vec3 normal = normal_of_touch(obstacle, pair, hit->time, hit->weights[1], hit->point);
        contact = contact_of(obstacle, motion, pair, hit->weights[1], normal, hit->point);
    }
    if (!contact) return std::nullopt;
    return TimedContact{*contact, hit ? hit->time : kNever};
}

// Whether another segment of the polyline that shares a node with this one was touched earlier.
bool follows_from_another(const Obstacle& obstacle, const std::vector<TimedContact>& found, std::size_t i)
{
    if (found[i].time >= kNever) return false;
    const std::array<int, 2>& points = obstacle.topology().edges[found[i].contact.element].points;
    for (std::size_t k = 0; k < found.size(); ++k) {
        const bool is_earlier = found[k].time < found[i].time || (k < i && found[k].time <= found[i].time);
        if (k == i || !is_earlier) continue;
        for (const int p : obstacle.topology().edges[found[k].contact.element].points)
            if ((p == points[0] || p == points[1]) && !is_corner(obstacle.features(), p)) return true;
    }
    return false;
}

Box3 box_of_way(const EdgePair& pair, double margin)
{
    Box3 box(pair.begin[0]);
    for (const Vec3& p : {pair.begin[1], pair.reference[0], pair.reference[1]}) box.extend(p);
    return Box3(box.min().array() - margin, box.max().array() + margin);
}

}  // namespace

std::optional<ObstacleContact> make_edge_contact(const Obstacle& obstacle, const ClothMotion& motion,
                                                 const std::vector<Vec3>& reference,
                                                 const std::array<int, 2>& vertices, int element,
                                                 double thickness)
{
    const EdgePair pair = make_pair(obstacle, motion, reference, vertices, element, thickness);
    const std::optional<TimedContact> found = find_pair_contact(obstacle, motion, pair);
    if (!found) return std::nullopt;
    return found->contact;
}

std::vector<ObstacleContact> find_edge_contacts(const Obstacle& obstacle, const ClothMotion& motion,
                                                const std::vector<Vec3>& reference, double thickness)
{
    const std::vector<FeatureEdge>& features = obstacle.features().edges;
    if (features.empty()) return {};
    Box3 bounds;
    for (const FeatureEdge& f : features)
        for (const int p : obstacle.topology().edges[f.edge].points) bounds.extend(obstacle.mesh().points[p]);

    const auto find = [&](int first, int last, std::vector<ObstacleContact>& contacts) {
        std::vector<int> near;
        std::vector<TimedContact> found;
        for (int i = first; i < last; ++i) {
            const std::array<int, 2> v = {(*motion.edges)[i].a, (*motion.edges)[i].b};
            const EdgePair any = make_pair(obstacle, motion, reference, v, features[0].edge, thickness);
            const Box3 box = box_of_way(any, longest_reach(motion, v, thickness));
            if (!bounds.intersects(box)) continue;
            obstacle.find_feature_edges(box, near);
            found.clear();
            for (const int f : near) {
                const EdgePair pair = make_pair(obstacle, motion, reference, v, features[f].edge, thickness);
                if (const auto contact = find_pair_contact(obstacle, motion, pair)) found.push_back(*contact);
            }
            for (std::size_t k = 0; k < found.size(); ++k)
                if (!follows_from_another(obstacle, found, k)) contacts.push_back(found[k].contact);
        }
    };
    return collect_in_batches<ObstacleContact>(static_cast<int>(motion.edges->size()), find);
}

}  // namespace arris
