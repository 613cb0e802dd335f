// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/self_contact/self_contact_search.h"

#include <Eigen/Geometry>
#include <cmath>
#include <optional>
#include <tuple>

#include "geometry/closest_point.h"
#include "geometry/contact/contact_plane.h"
#include "geometry/contact/continuous_collision.h"
#include "geometry/tolerances.h"

namespace arris {

namespace {

constexpr double kNear = 2.0;  // thicknesses: nearer pairs have a plane at their closest points

/// Cosine of 45 degrees. A vertex is above a border where its direction from the border leans by less from
/// the normal of the border's face.
const double kAbove = std::sqrt(0.5);

/// Height of a ridge, of the thickness. Edges that cross have a plane where both are ridges. Of flatter
/// layers the planes of vertices keep all parts apart, but for about this height.
constexpr double kRidge = 0.1;

/// A closest pair of points, and whether moving either along its surface leads no nearer.
struct Closest {
    ClothPointPair pair;
    double distance;
    Vec3 normal;  ///< of the plane between them, unit; zero where they touch
    bool is_least;
};

class Search {
  public:
    Search(const SelfSurface& surface, const SelfMotion& motion, double thickness)
        : surface_(surface), motion_(motion), thickness_(thickness)
    {
    }

    void vertex_face(int v, int face, std::vector<SelfContact>& found) const
    {
        const Face& f = surface_.faces[face];
        const std::array<int, 4> vertices = vertex_and_face(surface_, v, face);
        const double thickness = kept_distance(surface_, vertices, 1, thickness_);
        if (is_near_at_begin(box_at(v), box_at(f[0], f[1], f[2]), thickness) &&
            take_near(closest_vertex_face(v, face, thickness), thickness, found))
            return;
        const auto hit = sweep_cloth_vertex_face(corners(motion_.begin, vertices),
                                                 corners(motion_.end, vertices), thickness);
        if (!hit) return;
        const auto over_border = normal_over_border(v, face, hit->time, thickness);
        take_hit({SelfContactKind::VertexFace, vertices, hit->weights}, over_border.value_or(hit->normal),
                 thickness, found);
    }

    void edge_edge(int first, int second, std::vector<SelfContact>& found) const
    {
        const MeshEdge &a = surface_.edges[first], &b = surface_.edges[second];
        const std::array<int, 4> vertices = two_edges(surface_, first, second);
        const double thickness = kept_distance(surface_, vertices, 2, thickness_);
        if (is_near_at_begin(box_at(a.a, a.b), box_at(b.a, b.b), thickness) &&
            take_near(closest_edges(first, second), thickness, found))
            return;
        const auto hit =
            sweep_cloth_edges(corners(motion_.begin, vertices), corners(motion_.end, vertices), thickness);
        if (hit && is_ridge(a, -hit->normal, hit->time) && is_ridge(b, hit->normal, hit->time))
            take_hit({SelfContactKind::EdgeEdge, vertices, hit->weights}, hit->normal, thickness, found);
    }

  private:
    template <typename... Vertices>
    Box3 box_at(int v, Vertices... others) const
    {
        Box3 box(motion_.begin[v]);
        (box.extend(motion_.begin[others]), ...);
        return box;
    }

    static bool is_near_at_begin(const Box3& a, const Box3& b, double thickness)
    {
        const double reach = kNear * thickness;
        return a.squaredExteriorDistance(b) < reach * reach;
    }

    Vec3 place(int v, double time) const
    {
        return motion_.begin[v] + time * (motion_.end[v] - motion_.begin[v]);
    }

    /// Way from an edge to the third vertex of its face, across the edge.
    Vec3 way_across(const MeshEdge& edge, int face, double time) const
    {
        const Vec3 a = place(edge.a, time);
        const Vec3 along = (place(edge.b, time) - a).normalized(),
                   side = place(surface_.apex(edge, face), time) - a;
        return side - along.dot(side) * along;
    }

    /// Whether an edge stands out towards `direction` (unit) from its faces.
    bool is_ridge(const MeshEdge& edge, const Vec3& direction, double time) const
    {
        for (const int face : {edge.face_left, edge.face_right})
            if (face >= 0 && way_across(edge, face, time).dot(direction) > -kRidge * thickness_) return false;
        return true;
    }

    /// Whether going from a surface's point along `way` leads no nearer to a point at `gap` from it.
    static bool leads_no_nearer(const Vec3& way, const Vec3& gap)
    {
        // Level parts, as of two plane layers, have a plane wherever they face each other.
        return way.dot(gap) <= kLevel * way.norm() * gap.norm();
    }

    /// Whether going from a vertex along any face around it leads no nearer to a point at `gap` from it.
    bool leads_no_nearer(int vertex, const Vec3& gap) const
    {
        for (const int face : surface_.faces_at[vertex])
            for (const int w : surface_.faces[face])
                if (w != vertex && !leads_no_nearer(motion_.begin[w] - motion_.begin[vertex], gap))
                    return false;
        return true;
    }

    Vec3 normal_of(int face, double time) const
    {
        const Face& f = surface_.faces[face];
        const Vec3 a = place(f[0], time);
        return (place(f[1], time) - a).cross(place(f[2], time) - a).stableNormalized();
    }

    PointOnTriangle closest_on(int face, int v, double time) const
    {
        const Face& f = surface_.faces[face];
        return closest_on_triangle(place(v, time), {place(f[0], time), place(f[1], time), place(f[2], time)},
                                   normal_of(face, time));
    }

    Closest closest_vertex_face(int v, int face, double thickness) const
    {
        const Face& f = surface_.faces[face];
        const PointOnTriangle at = closest_on(face, v, 0.0);
        const Vec3 gap = motion_.begin[v] - at.point;
        Closest closest{{SelfContactKind::VertexFace,
                         {v, f[0], f[1], f[2]},
                         {1.0, -at.weights[0], -at.weights[1], -at.weights[2]}},
                        gap.norm(),
                        gap.stableNormalized(),
                        true};
        if (at.edge >= 0) {  // reported once, by the left face
            const MeshEdge& edge = surface_.edges[surface_.edges_of[face][at.edge]];
            closest.is_least =
                face == edge.face_left &&
                (edge.face_right < 0 || leads_no_nearer(way_across(edge, edge.face_right, 0.0), gap));
        } else if (at.corner >= 0) {  // reported once, by the first face
            const int corner = f[at.corner];
            closest.is_least = face == surface_.faces_at[corner].front() && leads_no_nearer(corner, gap);
        }
        if (closest.is_least)
            closest.normal = normal_over_border(v, face, 0.0, thickness).value_or(closest.normal);
        return closest;
    }

    /// Edges of the cloth's border that hold the point of a face; none where it is not on the border.
    std::vector<int> border_at(int face, const PointOnTriangle& at) const
    {
        std::vector<int> border;
        if (at.edge >= 0) {
            const int e = surface_.edges_of[face][at.edge];
            if (surface_.edges[e].face_right < 0) border.push_back(e);
        } else if (at.corner >= 0) {
            const int corner = surface_.faces[face][at.corner];
            for (const int f : surface_.faces_at[corner])
                for (const int e : surface_.edges_of[f]) {
                    const MeshEdge& edge = surface_.edges[e];
                    if (edge.face_right < 0 && (edge.a == corner || edge.b == corner)) border.push_back(e);
                }
        }
        return border;
    }

    /// Distance of a vertex from an edge of the border, across it; negative on the face's side.
    double distance_beyond(const MeshEdge& edge, int v, double time) const
    {
        return -way_across(edge, edge.face_left, time)
                    .stableNormalized()
                    .dot(place(v, time) - place(edge.a, time));
    }

    /// Normal of the border's face at `time`, towards a vertex whose nearest point of `face` is on the
    /// border. None where the vertex is not above the border: neither at `time` nor where its free motion
    /// ends, or reaches the layer's surface before. The direction from the nearest point leans, and as a
    /// plane it would stop a border that slides over the vertex.
    std::optional<Vec3> normal_over_border(int v, int face, double time, double thickness) const
    {
        const PointOnTriangle at = closest_on(face, v, time);
        const std::vector<int> border = border_at(face, at);
        if (border.empty()) return std::nullopt;
        const Vec3 gap = place(v, time) - at.point;
        int seen = face;  // of the border's faces the one that `gap` is nearest to the normal of
        for (const int e : border) {
            const int other = surface_.edges[e].face_left;
            if (std::abs(normal_of(other, time).dot(gap)) > std::abs(normal_of(seen, time).dot(gap)))
                seen = other;
        }
        const Vec3 normal = normal_of(seen, time);
        const double side = normal.dot(gap) > 0.0 ? 1.0 : -1.0, height = side * normal.dot(gap);
        // Lower vertices hang over the border: the layer's plane would hold them, and one that leans lets
        // them down.
        if (height >= std::max((1.0 - kRidge) * thickness, kAbove * gap.norm())) return side * normal;
        // Low beside the border, the vertex comes at it from the side.
        if (height < kAbove * std::min(gap.norm(), thickness)) return std::nullopt;
        const Face& f = surface_.faces[face];
        Vec3 gap_at_end = motion_.end[v];
        for (int k = 0; k < 3; ++k) gap_at_end -= at.weights[k] * motion_.end[f[k]];
        const double height_at_end = side * normal_of(seen, 1.0).dot(gap_at_end);
        const double share = height_at_end < 0.0 ? height / (height - height_at_end) : 1.0;
        for (const int e : border) {
            const double from = distance_beyond(surface_.edges[e], v, time),
                         to = distance_beyond(surface_.edges[e], v, 1.0);
            if (from + share * (to - from) >= std::max(height_at_end, 0.0)) return std::nullopt;
        }
        return side * normal;
    }

    Closest closest_edges(int first, int second) const
    {
        const std::vector<Vec3>& x = motion_.begin;
        const MeshEdge &a = surface_.edges[first], &b = surface_.edges[second];
        const SegmentPair at = closest_between_segments({x[a.a], x[a.b]}, {x[b.a], x[b.b]});
        const Vec3 difference = at.first - at.second, normal = difference.stableNormalized();
        const auto is_inside = [](double s) { return s > 0.0 && s < 1.0; };
        return {{SelfContactKind::EdgeEdge, {a.a, a.b, b.a, b.b}, {1.0 - at.s, at.s, at.t - 1.0, -at.t}},
                difference.norm(),
                normal,
                is_inside(at.s) && is_inside(at.t) && is_ridge(a, -normal, 0.0) && is_ridge(b, normal, 0.0)};
    }

    /// True where the pair is near: its plane is known, or that of a nearer pair beside it is.
    bool take_near(const Closest& closest, double thickness, std::vector<SelfContact>& found) const
    {
        if (!(closest.distance > 0.0) || closest.distance >= kNear * thickness) return false;
        if (!closest.is_least) return true;
        const SelfContact contact = make_self_contact(closest.pair, closest.normal, motion_.begin, thickness);
        if (contact.normal.dot(contact.difference(motion_.end)) < contact.least_gap + thickness)
            found.push_back(contact);
        return true;
    }

    void take_hit(const ClothPointPair& pair, const Vec3& normal, double thickness,
                  std::vector<SelfContact>& found) const
    {
        const SelfContact contact = make_self_contact(pair, normal, motion_.begin, thickness);
        if (contact.least_gap > 0.0) found.push_back(contact);
    }

    const SelfSurface& surface_;
    const SelfMotion& motion_;
    double thickness_;
};

/// Keeps up to three planes of each vertex, the nearest first.
void keep_nearest_planes(std::vector<SelfContact>& contacts)
{
    std::vector<SelfContact> kept;
    std::size_t first = 0;  // of the present vertex, in `kept`
    for (const SelfContact& contact : contacts) {
        if (contact.kind == SelfContactKind::VertexFace) {
            if (kept.empty() || kept.back().vertices[0] != contact.vertices[0]) first = kept.size();
            const auto is_like = [&](const SelfContact& other) {
                return other.normal.dot(contact.normal) > kSameDirection;
            };
            if (kept.size() - first >= kMostPlanes ||
                std::any_of(kept.begin() + static_cast<std::ptrdiff_t>(first), kept.end(), is_like))
                continue;
        }
        kept.push_back(contact);
    }
    contacts = std::move(kept);
}

}  // namespace

SelfContact make_self_contact(const ClothPointPair& pair, const Vec3& normal, const std::vector<Vec3>& begin,
                              double thickness)
{
    return {pair, normal, std::min(thickness, normal.dot(pair.difference(begin))), thickness};
}

std::vector<SelfContact> find_self_contacts(const SelfSurface& surface, const SelfMotion& motion,
                                            double thickness)
{
    std::vector<SelfContact> contacts = collect_near_pairs<SelfContact>(surface, motion, kNear * thickness,
                                                                        Search(surface, motion, thickness));
    // By vertex, nearest first; edges last.
    const auto distance = [&](const SelfContact& c) { return c.normal.dot(c.difference(motion.begin)); };
    const auto is_before = [&](const SelfContact& a, const SelfContact& b) {
        const double at_a = distance(a), at_b = distance(b);
        return std::tie(a.kind, a.vertices[0], at_a, a.vertices) <
               std::tie(b.kind, b.vertices[0], at_b, b.vertices);
    };
    std::sort(contacts.begin(), contacts.end(), is_before);
    keep_nearest_planes(contacts);
    return contacts;
}

}  // namespace arris
