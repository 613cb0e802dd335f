// SPDX-License-Identifier: GPL-3.0-or-later
//
// Contacts of a vertex: the local minima of its distance to the obstacle (normal_cone.h). Above a table near
// its rim this is the plane of the top alone. Beyond the rim it is one plane at the rim, so that the vertex
// may slide off or back. In a reflex edge there are two planes, in a reflex corner three.
//
// A plane behind which the vertex began would pull it through to where its free motion ends, although the
// cloth around it may be held. Examples are a vertex that falls beside a wire, or shoots over a rim and down
// the side. Such a plane is left out, except for the small angle by which a smooth surface turns away during
// the step.

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/batches.h"
#include "geometry/closest_point.h"
#include "geometry/contact/contact_plane.h"
#include "geometry/contact/obstacle_contact.h"
#include "geometry/obstacle/normal_cone.h"

namespace arris {
namespace {

// How far behind a plane the begin may lie, relative to the distance moved: a surface that turns by about 30
// degrees.
constexpr double kTurnAway = 0.25;

struct Minimum {
    double distance;
    Vec3 point, normal;
    int element;
    bool is_vague = false;  // too near to have a direction of its own; `normal` is a guess
};

// Sorts, equal elements in their order. They are nearly always few, and std::stable_sort allocates even for
// one.
template <class Key>
void sort_by(std::vector<Minimum>& minima, const Key& key)
{
    constexpr std::size_t kFew = 16;
    if (minima.size() > kFew) {
        std::stable_sort(minima.begin(), minima.end(),
                         [&](const Minimum& a, const Minimum& b) { return key(a) < key(b); });
        return;
    }
    for (std::size_t k = 1; k < minima.size(); ++k)
        for (std::size_t j = k; j > 0 && key(minima[j]) < key(minima[j - 1]); --j)
            std::swap(minima[j], minima[j - 1]);
}

bool contains(const std::vector<int>& sorted_or_not, int wanted)
{
    return std::find(sorted_or_not.begin(), sorted_or_not.end(), wanted) != sorted_or_not.end();
}

// Finds the minima around one place after another; reuses its lists.
class MinimaFinder {
  public:
    MinimaFinder(const Obstacle& obstacle, double thickness)
        : thickness_(thickness),
          obstacle_(obstacle),
          mesh_(obstacle.mesh()),
          topology_(obstacle.topology()),
          touch_(touch_distance(obstacle, thickness)),
          tiny_(kTinyDistance * thickness)
    {
        for (const FeatureEdge& f : obstacle.features().edges)
            has_wires_ = has_wires_ || f.kind == FeatureKind::Wire;
        has_lone_points_ = !mesh_.lone_points.empty();
    }

    // Minima of the distance from `place` up to `reach`, the nearest first. `begin`, the vertex's former
    // position, decides the side where `place` does not.
    const std::vector<Minimum>& find(const Vec3& place, const Vec3& begin, double reach)
    {
        place_ = place;
        begin_ = begin;
        reach_ = reach;
        minima_.clear();
        seen_edges_.clear();
        seen_points_.clear();
        const Box3 box(place.array() - reach, place.array() + reach);
        obstacle_.find_faces(box, near_);
        for (const int f : near_) visit_face(f);
        if (has_wires_) visit_wires(box);
        if (has_lone_points_) visit_lone_points(box);
        drop_vague();
        sort_by(minima_, [](const Minimum& m) { return m.distance; });
        return minima_;
    }

  private:
    void visit_face(int f)
    {
        const Face& c = mesh_.faces[f];
        const Vec3& normal = topology_.face_normals[f];
        const double height = normal.dot(place_ - mesh_.points[c[0]]);
        const bool is_solid = topology_.is_solid[topology_.component[f]] != 0;
        // Skip solid faces seen from behind: at a convex edge, another face has the place in front.
        if (std::abs(height) > reach_ || (is_solid && height < -touch_)) return;
        const PointOnTriangle closest =
            closest_on_triangle(place_, {mesh_.points[c[0]], mesh_.points[c[1]], mesh_.points[c[2]]}, normal);
        if (closest.corner >= 0) return visit_point(c[closest.corner], f);
        if (closest.edge >= 0) return visit_edge(topology_.face_edges[f][closest.edge], closest.point, f);
        const bool is_front = is_solid || is_on_front(f, height);
        add({std::abs(height), closest.point, is_front ? normal : Vec3(-normal), f},
            thickness_ + turn_away());
    }

    double turn_away() const { return kTurnAway * (place_ - begin_).norm(); }

    // Adds a minimum, unless the begin was more than `most_behind` behind its plane.
    void add(const Minimum& minimum, double most_behind)
    {
        if (minimum.normal.dot(begin_ - minimum.point) >= -most_behind) minima_.push_back(minimum);
    }

    // Whether an edge is a wire or border. Cloth may hang over such an edge, so its two sides differ.
    bool is_thin(int edge) const { return topology_.edges[edge].faces[1] < 0; }

    bool is_thin_at(int point) const
    {
        for (int k = 0; k < topology_.edge_count_at(point); ++k)
            if (is_thin(topology_.edge_at(point, k))) return true;
        return topology_.edge_count_at(point) == 0;
    }

    // Whether the vertex is on the front side of a sheet's face.
    bool is_on_front(int f, double height) const
    {
        if (std::abs(height) > touch_) return height > 0.0;
        return topology_.face_normals[f].dot(begin_ - mesh_.points[mesh_.faces[f][0]]) > 0.0;
    }

    void visit_edge(int edge, const Vec3& point, int element)
    {
        const Vec3 direction = place_ - point;
        const double distance = direction.norm();
        if (distance > reach_ || contains(seen_edges_, edge)) return;
        seen_edges_.push_back(edge);
        if (distance > touch_ && !is_in_edge_cone(obstacle_, edge, direction / distance)) return;
        const bool is_vague = !(distance > tiny_);
        Vec3 along = direction;
        if (is_vague)
            along = (begin_ - point).norm() > tiny_ ? Vec3(begin_ - point) : outward_of_edge(obstacle_, edge);
        if (!(along.squaredNorm() > 0.0)) return;
        add({distance, point, clamp_to_edge_cone(obstacle_, edge, along), element, is_vague},
            is_thin(edge) ? touch_ : thickness_ + turn_away());
    }

    void visit_point(int point, int element)
    {
        const Vec3 direction = place_ - mesh_.points[point];
        const double distance = direction.norm();
        if (distance > reach_ || contains(seen_points_, point)) return;
        seen_points_.push_back(point);
        if (distance > touch_ && !is_in_point_cone(obstacle_, point, direction / distance)) return;
        const bool is_vague = !(distance > tiny_);
        const Vec3 normal = is_vague ? vague_normal(point) : Vec3(direction / distance);
        if (!(normal.squaredNorm() > 0.0)) return;
        add({distance, mesh_.points[point], normal, element, is_vague},
            is_thin_at(point) ? touch_ : thickness_ + turn_away());
    }

    // Normal at a point that is too near: towards the begin of the vertex if that lies in the cone, else the
    // mean normal of the faces.
    Vec3 vague_normal(int point) const
    {
        const Vec3 from = begin_ - mesh_.points[point];
        const Vec3 outward = outward_of_point(obstacle_, point);
        const bool has_from = from.norm() > tiny_;
        if (has_from && is_in_point_cone(obstacle_, point, from.normalized())) return from.normalized();
        if (outward.squaredNorm() > 0.0) return outward.normalized();
        return has_from ? Vec3(from.normalized()) : Vec3::Zero();
    }

    void visit_wires(const Box3& box)
    {
        obstacle_.find_feature_edges(box, near_);
        for (const int f : near_) {
            const FeatureEdge& feature = obstacle_.features().edges[f];
            if (feature.kind != FeatureKind::Wire) continue;
            const auto& [a, b] = topology_.edges[feature.edge].points;
            const double t = closest_on_segment(place_, mesh_.points[a], mesh_.points[b]);
            if (t > 0.0 && t < 1.0) {
                visit_edge(feature.edge, mesh_.points[a] + t * (mesh_.points[b] - mesh_.points[a]), f);
            } else {
                visit_point(t > 0.0 ? b : a, f);
            }
        }
    }

    void visit_lone_points(const Box3& box)
    {
        obstacle_.find_corners(box, near_);
        for (const int c : near_) {
            const int point = obstacle_.features().corners[c].point;
            if (topology_.edge_count_at(point) == 0) visit_point(point, c);
        }
    }

    // Drops guessed normals where a minimum at the place has a clear direction: the guess would be a
    // redundant plane.
    void drop_vague()
    {
        const bool has_clear = std::any_of(minima_.begin(), minima_.end(), [&](const Minimum& m) {
            return !m.is_vague && m.distance <= tiny_;
        });
        if (has_clear) std::erase_if(minima_, [](const Minimum& m) { return m.is_vague; });
    }

    double thickness_;
    const Obstacle& obstacle_;
    const ObstacleMesh& mesh_;
    const ObstacleTopology& topology_;
    double touch_, tiny_;
    bool has_wires_ = false, has_lone_points_ = false;
    Vec3 place_, begin_;
    double reach_ = 0.0;
    std::vector<Minimum> minima_;
    std::vector<int> near_, seen_edges_, seen_points_;
};

// Chooses the nearest minima whose directions differ.
void choose(const std::vector<Minimum>& minima, std::vector<Minimum>& chosen)
{
    chosen.clear();
    for (const Minimum& m : minima) {
        if (chosen.size() == kMostPlanes) return;
        const bool is_new = std::none_of(chosen.begin(), chosen.end(), [&](const Minimum& c) {
            return c.normal.dot(m.normal) >= kSameDirection;
        });
        if (is_new) chosen.push_back(m);
    }
}

}  // namespace

std::vector<ObstacleContact> find_vertex_contacts(const Obstacle& obstacle, const ClothMotion& motion,
                                                  const std::vector<Vec3>& reference, double thickness)
{
    const auto find = [&](int first, int last, std::vector<ObstacleContact>& contacts) {
        MinimaFinder finder(obstacle, thickness);
        std::vector<Minimum> chosen;
        for (int v = first; v < last; ++v) {
            const double longest = longest_reach(motion, {&v, 1}, thickness);
            if (!(obstacle.bounds().squaredExteriorDistance(reference[v]) <= longest * longest)) continue;
            // Search farther only where nothing is nearer: on a fine mesh each doubling costs four times as
            // much.
            chosen.clear();
            for (double reach = kReachThicknesses * thickness; chosen.empty(); reach *= 2.0) {
                choose(finder.find(reference[v], motion.begin[v], std::min(reach, longest)), chosen);
                if (reach >= longest) break;
            }
            sort_by(chosen, [](const Minimum& m) { return m.element; });
            for (const Minimum& m : chosen)
                contacts.push_back(make_contact(obstacle, motion, ContactBegin(motion), ContactKind::Vertex,
                                                {{v, -1, -1}, {1.0, 0.0, 0.0}}, m.element, m.normal, m.point,
                                                thickness));
        }
    };
    return collect_in_batches<ObstacleContact>(static_cast<int>(reference.size()), find);
}

}  // namespace arris
