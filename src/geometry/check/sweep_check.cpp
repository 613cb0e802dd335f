// SPDX-License-Identifier: GPL-3.0-or-later
// Two surfaces that are apart first meet in one of two ways: a vertex of one touches a face of the other, or
// two edges touch. So sweeping these pairs over the step checks everything. All other pairs are known to stay
// apart: by their boxes, or by a plane between the swept cloth face and a face of the obstacle.
//
// Every cloth vertex and edge belongs to one cloth face and is swept with that face only. Neighbouring cloth
// faces share one query of the obstacle.
#include "geometry/check/sweep_check.h"

#include <algorithm>
#include <cassert>
#include <span>
#include <tuple>

#include "geometry/check/face_groups.h"
#include "geometry/check/sweep_violation.h"
#include "geometry/check/swept_face.h"
#include "geometry/cloth/element_owners.h"
#include "geometry/obstacle/obstacle_touch.h"
#include "geometry/obstacle/surface_ride.h"
#include "geometry/sort_unique.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

constexpr int kMostViolations = 9;  // per cloth face

/// Findings for one cloth face.
struct FaceFinding {
    int face;
    bool is_touching = false;        ///< touches the obstacle at the end
    bool is_met = false;             ///< met a point of the obstacle
    std::vector<int> vertices = {};  ///< its own vertices that met a face
    std::vector<int> edges = {};
    std::vector<ObstacleContact> violations = {};

    bool is_clean() const { return !is_touching && !is_met && vertices.empty() && edges.empty(); }
};

std::vector<Box3> sweep_boxes(const std::vector<Face>& faces, const std::vector<Vec3>& begin,
                              const std::vector<Vec3>& end)
{
    std::vector<Box3> boxes(faces.size());
    for (std::size_t f = 0; f < boxes.size(); ++f)
        for (const int v : faces[f]) boxes[f].extend(begin[v]).extend(end[v]);
    return boxes;
}

Box3 box_of(std::span<const Vec3> points)
{
    Box3 box;
    for (const Vec3& p : points) box.extend(p);
    return box;
}

/// An element of the cloth met an element of the obstacle.
struct Meeting {
    ContactKind kind;
    int cloth_element, obstacle_element;
    SweepHit hit;
    Vec3 begin;    ///< of the cloth's point, carried with the obstacle's element
    double depth;  ///< distance past the meeting point, against its normal, at which the cloth's point ends
};

/// A face, wire segment or lone point of the obstacle. `element` is a face, a topology edge or a point.
struct Near {
    int element;
    Box3 box;
};

/// Checks cloth faces that lie close together; reuses its lists.
class GroupSearch {
  public:
    GroupSearch(const Obstacle& obstacle, const ClothMotion& motion, double thickness,
                const std::vector<Box3>& boxes, const std::vector<OwnedElements>& owned)
        : obstacle_(obstacle),
          motion_(motion),
          thickness_(thickness),
          sides_(motion.sides.get()),
          begin_(sides_ ? sides_->cloth : motion.begin),
          points_at_begin_((sides_ ? *sides_->obstacle : obstacle).mesh().points),
          way_(sides_ ? longest_way(points_at_begin_, obstacle.mesh().points) : 0.0),
          boxes_(boxes),
          owned_(owned)
    {
    }

    /// Appends findings that are not clean.
    void operator()(std::span<const int> faces, const Box3& group, std::vector<FaceFinding>& findings)
    {
        // The face boxes compared below are exact; the query's box need not be.
        const double margin = kTouching * group.diagonal().norm() + way_;
        const Box3 query(group.min().array() - margin, group.max().array() + margin);
        if (!query.intersects(obstacle_.bounds())) return;
        collect_group(query);
        for (const int f : faces) {
            FaceFinding finding{f};
            search_face(boxes_[f], owned_[f], finding);
            if (!finding.is_clean()) findings.push_back(std::move(finding));
        }
    }

  private:
    void collect_group(const Box3& group)
    {
        const ObstacleMesh& mesh = obstacle_.mesh();
        const ObstacleFeatures& features = obstacle_.features();
        near_faces_.clear();
        near_wires_.clear();
        near_points_.clear();
        obstacle_.find_faces(group, found_);
        for (const int f : found_) near_faces_.push_back({f, box_of(way_of_face(f))});
        if (!mesh.segments.empty()) {
            obstacle_.find_feature_edges(group, found_);
            for (const int f : found_) {
                const FeatureEdge& feature = features.edges[f];
                if (feature.kind == FeatureKind::Wire)
                    near_wires_.push_back({feature.edge, box_of(way_of_edge(feature.edge))});
            }
        }
        if (!mesh.lone_points.empty()) {
            obstacle_.find_corners(group, found_);
            for (const int c : found_) {
                const int p = features.corners[c].point;
                if (obstacle_.topology().edge_count_at(p) == 0)
                    near_points_.push_back(
                        {p, Box3(mesh.points[p], mesh.points[p]).extend(points_at_begin_[p])});
            }
        }
    }

    void search_face(const Box3& box, const OwnedElements& owned, FaceFinding& finding)
    {
        copy_touching(near_faces_, box, faces_);
        copy_touching(near_wires_, box, edges_);
        copy_touching(near_points_, box, points_);
        if (faces_.empty() && edges_.empty() && points_.empty()) return;
        const SweptFace swept(begin_, motion_.end, (*motion_.faces)[finding.face]);
        keep_reachable(swept);
        if (faces_.empty() && edges_.empty() && points_.empty()) return;
        if (swept.is_moving() || sides_) {
            distance_ = kTouching * box.diagonal().norm();
            meetings_.clear();
            sweep_vertices(owned, finding);
            sweep_edges(owned, finding);
            sweep_face(swept, finding);
            keep_deepest(finding);
        }
        find_touches(obstacle_, swept.end(), touch_);
        finding.is_touching = touch_.is_any();
    }

    static void copy_touching(const std::vector<Near>& all, const Box3& box, std::vector<int>& chosen)
    {
        chosen.clear();
        for (const Near& near : all)
            if (near.box.intersects(box)) chosen.push_back(near.element);
    }

    /// Drops elements that a plane separates from the swept face; adds the edges and points of the remaining
    /// ones.
    void keep_reachable(const SweptFace& swept)
    {
        const ObstacleMesh& mesh = obstacle_.mesh();
        const ObstacleTopology& topology = obstacle_.topology();
        std::erase_if(faces_,
                      [&](int f) { return swept.is_apart(way_of_face(f), &topology.face_normals[f]); });
        std::erase_if(edges_, [&](int e) { return swept.is_apart(way_of_edge(e)); });
        std::erase_if(points_, [&](int p) {
            return swept.is_apart(std::array<Vec3, 2>{points_at_begin_[p], mesh.points[p]});
        });
        for (const int e : edges_) {
            const std::array<int, 2>& ends = topology.edges[e].points;
            points_.insert(points_.end(), ends.begin(), ends.end());
        }
        for (const int f : faces_) {
            edges_.insert(edges_.end(), topology.face_edges[f].begin(), topology.face_edges[f].end());
            points_.insert(points_.end(), mesh.faces[f].begin(), mesh.faces[f].end());
        }
        sort_unique(edges_);
        sort_unique(points_);
    }

    /// A vertex reports only the first face it meets; the others lie behind that face.
    void sweep_vertices(const OwnedElements& owned, FaceFinding& finding)
    {
        for (const int v : owned.vertices) {
            if (v < 0) continue;
            std::optional<SweepHit> first;
            int first_face = -1;
            for (const int f : faces_) {
                const auto hit = sweep_vertex_face(begin_[v], motion_.end[v], triangle(points_at_begin_, f),
                                                   triangle(obstacle_.mesh().points, f), distance_);
                if (!hit || (first && hit->time >= first->time)) continue;
                first = hit;
                first_face = f;
            }
            if (!first) continue;
            finding.vertices.push_back(v);
            note(ContactKind::Vertex, v, first_face, *first, {v, -1, -1});
        }
    }

    void sweep_edges(const OwnedElements& owned, FaceFinding& finding)
    {
        for (const int c : owned.edges) {
            if (c < 0) continue;
            const int a = (*motion_.edges)[c].a, b = (*motion_.edges)[c].b;
            bool is_met = false;
            for (const int e : edges_) {
                const auto hit = sweep_edge_edge({begin_[a], begin_[b]}, {motion_.end[a], motion_.end[b]},
                                                 segment(points_at_begin_, e),
                                                 segment(obstacle_.mesh().points, e), distance_);
                if (!hit) continue;
                is_met = true;
                note(ContactKind::Edge, c, e, *hit, {a, b, -1});
            }
            if (is_met) finding.edges.push_back(c);
        }
    }

    void sweep_face(const SweptFace& swept, FaceFinding& finding)
    {
        const Face& face = (*motion_.faces)[finding.face];
        for (const int p : points_) {
            const auto hit = sweep_face_point(swept.begin(), swept.end(), points_at_begin_[p],
                                              obstacle_.mesh().points[p], distance_);
            if (!hit) continue;
            finding.is_met = true;
            note(ContactKind::Triangle, finding.face, p, *hit, face);
        }
    }

    void note(ContactKind kind, int cloth_element, int obstacle_element, const SweepHit& hit,
              const std::array<int, 3>& vertices)
    {
        const ClothPoint point{vertices, hit.weights};
        Meeting meeting{kind, cloth_element, obstacle_element, hit, point.at(begin_), 0.0};
        if (sides_) {
            const Placement way = find_way(*sides_->obstacle, obstacle_, place_of(meeting));
            meeting.begin = way(meeting.begin);
            meeting.hit.normal = way.rotation * hit.normal;
        }
        meeting.depth = meeting.hit.normal.dot(hit.point - point.at(motion_.end));
        meetings_.push_back(meeting);
    }

    /// The meeting point's place on the obstacle.
    SurfacePlace place_of(const Meeting& m) const
    {
        const int o = m.obstacle_element;
        if (m.kind == ContactKind::Vertex)
            return {SurfaceKind::Triangle, o, obstacle_.mesh().faces[o], m.hit.on_obstacle};
        if (m.kind == ContactKind::Triangle) return {SurfaceKind::Point, o, {o, -1, -1}, {1.0, 0.0, 0.0}};
        const auto& [a, b] = obstacle_.topology().edges[o].points;
        return {SurfaceKind::Edge, o, {a, b, -1}, m.hit.on_obstacle};
    }

    /// A coarse cloth face may meet hundreds of elements of a fine obstacle.
    void keep_deepest(FaceFinding& finding)
    {
        const auto is_deeper = [](const Meeting& a, const Meeting& b) {
            return std::tie(b.depth, a.kind, a.cloth_element, a.obstacle_element) <
                   std::tie(a.depth, b.kind, b.cloth_element, b.obstacle_element);
        };
        const std::size_t count = std::min<std::size_t>(meetings_.size(), kMostViolations);
        std::partial_sort(meetings_.begin(), meetings_.begin() + count, meetings_.end(), is_deeper);
        for (std::size_t i = 0; i < count; ++i)
            if (const auto contact = make_contact_of(meetings_[i])) finding.violations.push_back(*contact);
    }

    std::optional<ObstacleContact> make_contact_of(const Meeting& m) const
    {
        const int c = m.cloth_element, o = m.obstacle_element;
        if (m.kind == ContactKind::Vertex)
            return make_vertex_violation(obstacle_, motion_, c, o, m.hit, m.begin, thickness_);
        if (m.kind == ContactKind::Edge)
            return make_edge_violation(obstacle_, motion_, c, o, m.hit, m.begin, thickness_);
        return make_face_violation(obstacle_, motion_, c, o, m.hit, m.begin, thickness_);
    }

    std::array<Vec3, 3> triangle(const std::vector<Vec3>& points, int face) const
    {
        const Face& f = obstacle_.mesh().faces[face];
        return {points[f[0]], points[f[1]], points[f[2]]};
    }

    std::array<Vec3, 2> segment(const std::vector<Vec3>& points, int edge) const
    {
        const std::array<int, 2>& ends = obstacle_.topology().edges[edge].points;
        return {points[ends[0]], points[ends[1]]};
    }

    // Points that span all places of an element during the step.

    std::array<Vec3, 6> way_of_face(int face) const
    {
        const auto [a, b, c] = triangle(points_at_begin_, face);
        const auto [p, q, r] = triangle(obstacle_.mesh().points, face);
        return {a, b, c, p, q, r};
    }

    std::array<Vec3, 4> way_of_edge(int edge) const
    {
        const auto [a, b] = segment(points_at_begin_, edge);
        const auto [p, q] = segment(obstacle_.mesh().points, edge);
        return {a, b, p, q};
    }

    const Obstacle& obstacle_;
    const ClothMotion& motion_;
    double thickness_;
    const MovingSides* sides_;                  ///< null where the obstacle rests
    const std::vector<Vec3>& begin_;            ///< of the cloth's vertices on their way
    const std::vector<Vec3>& points_at_begin_;  ///< of the obstacle
    double way_;                                ///< m, the longest of the obstacle's points
    const std::vector<Box3>& boxes_;            ///< of the cloth faces on their ways
    const std::vector<OwnedElements>& owned_;   ///< by the cloth faces
    double distance_ = 0.0;
    std::vector<Near> near_faces_, near_wires_, near_points_;  ///< near the group
    std::vector<int> faces_, edges_, points_;                  ///< of these, near the present face
    std::vector<Meeting> meetings_;                            ///< of the present face
    std::vector<int> found_;
    ObstacleTouch touch_;
};

/// Cloth faces with any part that met or touches the obstacle.
std::vector<int> find_unclean(const ClothMotion& motion, const std::vector<FaceFinding>& findings)
{
    std::vector<char> is_vertex_met(motion.begin.size(), 0);
    std::vector<int> unclean;
    for (const FaceFinding& finding : findings) {
        for (const int v : finding.vertices) is_vertex_met[v] = 1;
        for (const int e : finding.edges) {
            const MeshEdge& edge = (*motion.edges)[e];
            unclean.push_back(edge.face_left);
            if (edge.face_right >= 0) unclean.push_back(edge.face_right);
        }
        if (finding.is_met || finding.is_touching) unclean.push_back(finding.face);
    }
    const int face_count = static_cast<int>(motion.faces->size());
    for (int f = 0; f < face_count; ++f) {
        const Face& face = (*motion.faces)[f];
        if (is_vertex_met[face[0]] || is_vertex_met[face[1]] || is_vertex_met[face[2]]) unclean.push_back(f);
    }
    sort_unique(unclean);
    return unclean;
}

SweepReport summarize(const ClothMotion& motion, const std::vector<FaceFinding>& findings)
{
    SweepReport report;
    if (findings.empty()) return report;
    for (const FaceFinding& finding : findings) {
        report.crossings += static_cast<int>(finding.vertices.size() + finding.edges.size()) + finding.is_met;
        report.intersections += finding.is_touching;
        report.violations.insert(report.violations.end(), finding.violations.begin(),
                                 finding.violations.end());
    }
    report.faces = find_unclean(motion, findings);
    const auto key = [](const ObstacleContact& c) { return std::tie(c.kind, c.vertices, c.element); };
    std::stable_sort(report.violations.begin(), report.violations.end(),
                     [&](const auto& a, const auto& b) { return key(a) < key(b); });
    // A point that meets the edge between two cloth faces meets both faces.
    const auto last = std::unique(report.violations.begin(), report.violations.end(),
                                  [&](const auto& a, const auto& b) { return key(a) == key(b); });
    report.violations.erase(last, report.violations.end());
    return report;
}

}  // namespace

SweepReport check_sweep(const Obstacle& obstacle, const ClothMotion& motion, double thickness)
{
    assert(motion.begin.size() == motion.end.size());
    const std::vector<Box3> boxes =
        sweep_boxes(*motion.faces, motion.sides ? motion.sides->cloth : motion.begin, motion.end);
    Box3 met = obstacle.bounds();
    if (motion.sides) met.extend(motion.sides->obstacle->bounds());
    std::vector<int> faces;  // that may meet it
    for (std::size_t f = 0; f < boxes.size(); ++f)
        if (boxes[f].intersects(met)) faces.push_back(static_cast<int>(f));
    if (faces.empty()) return {};

    const std::vector<OwnedElements> owned =
        assign_owners(static_cast<int>(motion.begin.size()), *motion.faces, *motion.edges);
    const GroupSearch search(obstacle, motion, thickness, boxes, owned);
    return summarize(motion, collect_in_groups<FaceFinding>(boxes, std::move(faces), search));
}

}  // namespace arris
