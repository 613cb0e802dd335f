// SPDX-License-Identifier: GPL-3.0-or-later
//
// Contacts of a cloth face and a corner or a node of a polyline: the plane of the cloth face, through the
// corner. The nearest point of the cloth may lie on an edge between two faces, or on the cloth's border. Then
// the direction between the closest points replaces the face's normal.

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "geometry/box_tree.h"
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

// Sine by which a polyline must drop away on both sides of a node for a face to rest on that node: a bend of
// 1 degree.
constexpr double kStandsOut = 0.01;

using Triangle = std::array<Vec3, 3>;

struct CornerPair {
    int face;
    Face vertices;
    int element;
    Vec3 point;
    ContactBegin begin;
    double thickness;
    double touch;  // distance that counts as a touch
};

template <class Field>
Triangle triangle_of(const Field& positions, const Face& face)
{
    return {positions[face[0]], positions[face[1]], positions[face[2]]};
}

// Unit normal; zero where the triangle has no area.
Vec3 normal_of(const Triangle& t)
{
    return (t[1] - t[0]).cross(t[2] - t[0]).stableNormalized();
}

// Corners of one face at fraction `time` of the way from begin to `reference`.
Triangle triangle_at(const CornerPair& pair, const ClothMotion& motion, const std::vector<Vec3>& reference,
                     int face, double time)
{
    const Face& vertices = (*motion.faces)[face];
    Triangle now;
    for (int i = 0; i < 3; ++i) {
        const Vec3 begin = pair.begin[vertices[i]];
        now[i] = begin + time * (reference[vertices[i]] - begin);
    }
    return now;
}

const MeshEdge& edge_between(const ClothMotion& motion, int a, int b)
{
    const std::array<int, 2> key = {std::min(a, b), std::max(a, b)};
    return *std::lower_bound(motion.edges->begin(), motion.edges->end(), key,
                             [](const MeshEdge& e, const std::array<int, 2>& k) {
                                 return std::array{e.a, e.b} < k;
                             });
}

// Unit vector in the triangle's plane, perpendicular to edge `edge`, towards the interior.
Vec3 into_triangle(const Triangle& triangle, const Vec3& normal, int edge)
{
    return normal.cross((triangle[(edge + 1) % 3] - triangle[edge]).stableNormalized());
}

int edge_of(const Face& face, const MeshEdge& edge)
{
    for (int i = 0; i < 3; ++i)
        if (face[i] != edge.a && face[i] != edge.b) return (i + 1) % 3;
    return 0;
}

// Orients `normal` to the side from which the cloth came, as for contacts of edges. Where the way of the
// cloth's point does not decide, the side of the face on which the corner was at begin does. Zero where that
// does not decide either.
Vec3 towards_begin(const CornerPair& pair, const ClothPoint& cloth_point, const Vec3& normal)
{
    const Vec3 way = cloth_point.at(pair.begin) - pair.point;
    const double along = normal.dot(way);
    if (way.norm() > pair.touch && std::abs(along) > kLevel * way.norm())
        return along > 0.0 ? normal : Vec3(-normal);
    const Triangle begin = triangle_of(pair.begin, pair.vertices);
    const Vec3 begin_normal = normal_of(begin);
    const Vec3 between = closest_on_triangle(pair.point, begin, begin_normal).point - pair.point;
    const double height = begin_normal.dot(between);
    if (!(std::abs(height) > std::max(pair.touch, kLevel * between.norm()))) return Vec3::Zero();
    return height > 0.0 ? normal : Vec3(-normal);
}

// The normal of a touch on an edge of the cloth. Between two faces this is the mean of their normals. On the
// border it points to where the cloth came from, but never from over the face itself.
Vec3 normal_on_edge(const CornerPair& pair, const ClothMotion& motion, const std::vector<Vec3>& reference,
                    const MeshEdge& edge, const ClothPoint& cloth_point, double time)
{
    const Triangle now = triangle_at(pair, motion, reference, pair.face, time);
    const Vec3 normal = normal_of(now);
    if (edge.face_right >= 0) {
        const int other = edge.face_left == pair.face ? edge.face_right : edge.face_left;
        const Vec3 sum = normal + normal_of(triangle_at(pair, motion, reference, other, time));
        const bool is_folded_flat = !(sum.norm() > kLevel);
        return towards_begin(pair, cloth_point, is_folded_flat ? normal : Vec3(sum.normalized()));
    }
    const int i = edge_of(pair.vertices, edge);
    const Vec3 along = (now[(i + 1) % 3] - now[i]).stableNormalized();
    const Vec3 way = cloth_point.at(pair.begin) - pair.point;
    const Vec3 across = way - along.dot(way) * along;
    if (!(across.norm() > pair.touch)) return towards_begin(pair, cloth_point, normal);
    if (into_triangle(now, normal, i).dot(across) >= 0.0) return across.normalized();
    return towards_begin(pair, cloth_point, normal);
}

// The cloth's point with these weights on a face; on edge `edge` the third vertex is left out.
ClothPoint cloth_point_on(const CornerPair& pair, const std::array<double, 3>& weights, int edge)
{
    ClothPoint cloth_point{{pair.vertices[0], pair.vertices[1], pair.vertices[2]}, weights};
    if (edge < 0) return cloth_point;
    const int across = (edge + 2) % 3;
    cloth_point.vertices[across] = -1;
    cloth_point.weights[across] = 0.0;
    const double sum = weights[edge] + weights[(edge + 1) % 3];
    for (double& w : cloth_point.weights) w /= sum;
    return cloth_point;
}

bool is_at_vertex(const std::array<double, 3>& weights)
{
    return std::max({weights[0], weights[1], weights[2]}) > 1.0 - kEndWeight;
}

const MeshEdge& cloth_edge(const CornerPair& pair, const ClothMotion& motion, int edge)
{
    return edge_between(motion, pair.vertices[edge], pair.vertices[(edge + 1) % 3]);
}

std::optional<ObstacleContact> contact_of(const Obstacle& obstacle, const ClothMotion& motion,
                                          const CornerPair& pair, const ClothPoint& cloth_point,
                                          const Vec3& normal)
{
    if (!(normal.squaredNorm() > 0.0)) return std::nullopt;
    return make_contact(obstacle, motion, pair.begin, ContactKind::Triangle, cloth_point, pair.element,
                        normal, pair.point, pair.thickness);
}

std::optional<ObstacleContact> contact_of_touch(const Obstacle& obstacle, const ClothMotion& motion,
                                                const std::vector<Vec3>& reference, const CornerPair& pair,
                                                double time, const std::array<double, 3>& weights)
{
    if (is_at_vertex(weights)) return std::nullopt;
    const int least = static_cast<int>(std::min_element(weights.begin(), weights.end()) - weights.begin());
    const int edge = weights[least] < kEndWeight ? (least + 1) % 3 : -1;
    const ClothPoint cloth_point = cloth_point_on(pair, weights, edge);
    const Vec3 face_normal = normal_of(triangle_at(pair, motion, reference, pair.face, time));
    Vec3 normal =
        edge < 0 ? towards_begin(pair, cloth_point, face_normal)
                 : normal_on_edge(pair, motion, reference, cloth_edge(pair, motion, edge), cloth_point, time);
    // The cloth's own plane may lead into the solid, if part of the cloth has sunk into the solid already.
    if (!normal.isZero(0.0) && !is_in_point_cone(obstacle, pair.element, normal)) {
        const Vec3 outside =
            face_normal_towards(obstacle, pair.element, cloth_point.at(pair.begin) - pair.point);
        if (!outside.isZero(0.0)) normal = outside;
    }
    return contact_of(obstacle, motion, pair, cloth_point, normal);
}

// Whether the edge is nearest to the point, compared with every face beside the edge.
bool is_nearest(const CornerPair& pair, const ClothMotion& motion, const std::vector<Vec3>& reference,
                const MeshEdge& edge, const Vec3& to_cloth)
{
    for (const int f : {edge.face_left, edge.face_right}) {
        if (f < 0) continue;
        const Triangle triangle = triangle_of(reference, (*motion.faces)[f]);
        const Vec3 into = into_triangle(triangle, normal_of(triangle), edge_of((*motion.faces)[f], edge));
        if (!(-to_cloth.dot(into) <= kLevel * to_cloth.norm() + pair.touch)) return false;
    }
    return true;
}

// The plane at the reference position, if the distance has a local minimum there.
std::optional<ObstacleContact> contact_at_rest(const Obstacle& obstacle, const ClothMotion& motion,
                                               const std::vector<Vec3>& reference, const CornerPair& pair)
{
    const Triangle triangle = triangle_of(reference, pair.vertices);
    const Vec3 face_normal = normal_of(triangle);
    const PointOnTriangle closest = closest_on_triangle(pair.point, triangle, face_normal);
    if (is_at_vertex(closest.weights)) return std::nullopt;
    const Vec3 to_cloth = closest.point - pair.point;
    const double distance = to_cloth.norm();
    if (!(distance <= longest_reach(motion, pair.vertices, pair.thickness))) return std::nullopt;

    const ClothPoint cloth_point = cloth_point_on(pair, closest.weights, closest.edge);
    const bool has_direction = distance > kTinyDistance * pair.thickness;
    Vec3 normal = to_cloth / distance;
    if (closest.edge >= 0) {
        const MeshEdge& edge = cloth_edge(pair, motion, closest.edge);
        if (!is_nearest(pair, motion, reference, edge, to_cloth)) return std::nullopt;
        if (!has_direction) normal = normal_on_edge(pair, motion, reference, edge, cloth_point, 1.0);
    } else {
        normal = has_direction ? Vec3(face_normal.dot(to_cloth) > 0.0 ? face_normal : Vec3(-face_normal))
                               : towards_begin(pair, cloth_point, face_normal);
    }
    if (!is_in_point_cone(obstacle, pair.element, normal)) return std::nullopt;
    // Reject a plane behind which the cloth began: it would pull the cloth through to where its free motion
    // ends.
    if (!(normal.dot(cloth_point.at(pair.begin) - pair.point) >= -pair.touch)) return std::nullopt;
    return contact_of(obstacle, motion, pair, cloth_point, normal);
}

CornerPair make_pair(const Obstacle& obstacle, const ClothMotion& motion, int face, int element,
                     double thickness)
{
    return {face,
            (*motion.faces)[face],
            element,
            obstacle.mesh().points[element],
            begin_from_point(obstacle, motion, element),
            thickness,
            touch_distance(obstacle, thickness)};
}

struct TimedContact {
    ObstacleContact contact;
    double time;
};

std::optional<TimedContact> find_pair_contact(const Obstacle& obstacle, const ClothMotion& motion,
                                              const std::vector<Vec3>& reference, const CornerPair& pair)
{
    const std::optional<SweepHit> hit =
        sweep_face_point(triangle_of(pair.begin, pair.vertices), triangle_of(reference, pair.vertices),
                         pair.point, pair.touch);
    const std::optional<ObstacleContact> contact =
        hit ? contact_of_touch(obstacle, motion, reference, pair, hit->time, hit->weights)
            : contact_at_rest(obstacle, motion, reference, pair);
    if (!contact) return std::nullopt;
    return TimedContact{*contact, hit ? hit->time : kNever};
}

// Whether a face needs its contact with a node. It needs every corner. Of nodes inside polylines it needs
// those that stand out against the face; of touched neighbouring nodes only the first in time. Under cloth
// that lies flat around a rim, all nodes are equally near.
bool is_needed(const FeatureNode& node, const TimedContact& found, const std::vector<TimedContact>& all)
{
    if (node.is_corner) return true;
    if (found.contact.vertices[2] < 0) return false;  // a contact of a cloth edge instead
    if (found.time >= kNever)
        return std::max(node.away[0].dot(found.contact.normal), node.away[1].dot(found.contact.normal)) <
               -kStandsOut;
    return std::none_of(all.begin(), all.end(), [&](const TimedContact& other) {
        const int p = other.contact.element;
        const bool is_beside = p == node.neighbours[0] || p == node.neighbours[1];
        return is_beside && (other.time < found.time || (other.time <= found.time && p < node.point));
    });
}

Box3 box_of_way(const ClothMotion& motion, const std::vector<Vec3>& reference, const Face& face,
                double margin)
{
    Box3 box;
    for (const int v : face) box.extend(motion.begin[v]).extend(reference[v]);
    return Box3(box.min().array() - margin, box.max().array() + margin);
}

bool has_same_place(const ObstacleContact& a, const ObstacleContact& b)
{
    return a.vertices == b.vertices && a.element == b.element;
}

}  // namespace

std::optional<ObstacleContact> make_face_contact(const Obstacle& obstacle, const ClothMotion& motion,
                                                 const std::vector<Vec3>& reference, int face, int element,
                                                 double thickness)
{
    const CornerPair pair = make_pair(obstacle, motion, face, element, thickness);
    const std::optional<TimedContact> found = find_pair_contact(obstacle, motion, reference, pair);
    if (!found) return std::nullopt;
    return found->contact;
}

std::vector<ObstacleContact> find_face_contacts(const Obstacle& obstacle, const ClothMotion& motion,
                                                const std::vector<Vec3>& reference, double thickness)
{
    const std::vector<FeatureNode> nodes = find_feature_nodes(obstacle);
    Box3 bounds;
    std::vector<Box3> places;
    for (const FeatureNode& node : nodes) {
        places.emplace_back(obstacle.mesh().points[node.point]);
        bounds.extend(places.back());
    }
    const BoxTree tree(places);

    const auto find = [&](int first, int last, std::vector<ObstacleContact>& contacts) {
        std::vector<int> near;
        std::vector<TimedContact> found;
        std::vector<int> found_nodes;
        for (int f = first; f < last; ++f) {
            const Face& face = (*motion.faces)[f];
            const Box3 box = box_of_way(motion, reference, face, longest_reach(motion, face, thickness));
            if (!bounds.intersects(box)) continue;
            tree.find(box, near);
            found.clear();
            found_nodes.clear();
            for (const int n : near) {
                const CornerPair pair = make_pair(obstacle, motion, f, nodes[n].point, thickness);
                const auto contact = find_pair_contact(obstacle, motion, reference, pair);
                if (!contact) continue;
                found.push_back(*contact);
                found_nodes.push_back(n);
            }
            for (std::size_t k = 0; k < found.size(); ++k)
                if (is_needed(nodes[found_nodes[k]], found[k], found)) contacts.push_back(found[k].contact);
        }
    };
    std::vector<ObstacleContact> contacts =
        collect_in_batches<ObstacleContact>(static_cast<int>(motion.faces->size()), find);
    std::stable_sort(contacts.begin(), contacts.end(),
                     [](const ObstacleContact& a, const ObstacleContact& b) {
                         return std::pair(a.vertices, a.element) < std::pair(b.vertices, b.element);
                     });
    // A contact on an edge is found from both of its faces; keep one.
    contacts.erase(std::unique(contacts.begin(), contacts.end(), has_same_place), contacts.end());
    return contacts;
}

}  // namespace arris
