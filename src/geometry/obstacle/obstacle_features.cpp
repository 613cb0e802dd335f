// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/obstacle_features.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "geometry/cgal.h"
#include "geometry/obstacle/face_planes.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

// Absorbs rounding of angles near a threshold, so that edges modelled at exactly that angle are all alike.
// Mesh files have single precision or six digits, which turn a face of 5 mm by up to 8e-3 degrees.
constexpr double kTurnSlack = 1e-2;  // degrees
// Degrees. Where a feature turns by more, it has a corner. Wires and solid corners have one at twice that: up
// to there a wire's two edges share one plane halfway between them, and a cone's tip is blunt.
constexpr double kCornerTurn = 30.0;

double angle_between(const Vec3& a, const Vec3& b)
{
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

double degrees(double radians)
{
    return radians * 180.0 / std::numbers::pi;
}

/// The edge vector in the direction in which `face` runs along the edge; not unit.
Vec3 direction_in(const ObstacleMesh& mesh, const ObstacleTopology& topology, int face, int edge)
{
    const std::array<int, 3>& sides = topology.face_edges[face];
    const int i = static_cast<int>(std::find(sides.begin(), sides.end(), edge) - sides.begin());
    return mesh.points[mesh.faces[face][(i + 1) % 3]] - mesh.points[mesh.faces[face][i]];
}

/// Angle between the normals of the faces beside an inner edge, radians; negative at a reflex edge.
double signed_turn(const ObstacleMesh& mesh, const ObstacleTopology& topology, const FacePlanes& planes,
                   int edge)
{
    const auto [f, g] = topology.edges[edge].faces;
    const double turn = angle_between(planes.normals[f], planes.normals[g]);
    const Vec3 axis = planes.normals[f].cross(planes.normals[g]);
    return axis.dot(direction_in(mesh, topology, f, edge)) < 0.0 ? -turn : turn;
}

int apex_across(const ObstacleMesh& mesh, const std::array<int, 2>& side, int face)
{
    for (const int p : mesh.faces[face])
        if (p != side[0] && p != side[1]) return p;
    return -1;
}

/// Whether a solid's sharp edge is convex. Faces folded flat onto one another count as convex: cloth reaches
/// the edge of a plate without thickness, but no crack without width.
bool is_convex(const ObstacleMesh& mesh, const ObstacleTopology& topology, const FacePlanes& planes, int edge)
{
    const auto [f, g] = topology.edges[edge].faces;
    if (planes.is_borrowed[f] || planes.is_borrowed[g])
        return signed_turn(mesh, topology, planes, edge) > 0.0;
    const Face& face = mesh.faces[f];
    const int apex = apex_across(mesh, topology.edges[edge].points, g);
    return CGAL::orientation(to_cgal(mesh.points[face[0]]), to_cgal(mesh.points[face[1]]),
                             to_cgal(mesh.points[face[2]]), to_cgal(mesh.points[apex])) != CGAL::POSITIVE;
}

/// Whether an inner edge is sharp in this pose.
bool is_sharp(const ObstacleMesh& mesh, const ObstacleTopology& topology, const FacePlanes& planes, int edge,
              double feature_angle)
{
    const auto [f, g] = topology.edges[edge].faces;
    if (!(degrees(angle_between(planes.normals[f], planes.normals[g])) > feature_angle + kTurnSlack))
        return false;
    const bool is_sheet = !topology.is_solid[topology.component[f]];
    return is_sheet || is_convex(mesh, topology, planes, edge);
}

/// Marks the inner edges that are sharp in this pose; others stay as they are.
void mark_sharp(const ObstacleMesh& mesh, const ObstacleTopology& topology, const FacePlanes& planes,
                double feature_angle, std::vector<char>& is_marked)
{
    for (int e = 0; e < topology.surface_edge_count; ++e)
        if (!is_marked[e] && topology.edges[e].faces[1] >= 0 &&
            is_sharp(mesh, topology, planes, e, feature_angle))
            is_marked[e] = 1;
}

std::vector<FeatureEdge> make_feature_edges(const ObstacleTopology& topology, const FacePlanes& planes,
                                            const std::vector<char>& is_marked)
{
    std::vector<FeatureEdge> found;
    for (int e = 0; e < static_cast<int>(topology.edges.size()); ++e) {
        const auto [f, g] = topology.edges[e].faces;
        if (f < 0)
            found.push_back({e, FeatureKind::Wire, {Vec3::Zero(), Vec3::Zero()}, -1});
        else if (g < 0)
            found.push_back({e, FeatureKind::Border, {planes.normals[f], planes.normals[f]}, -1});
        else if (is_marked[e])
            found.push_back({e, FeatureKind::Convex, {planes.normals[f], planes.normals[g]}, -1});
    }
    return found;
}

/// Feature edges at a point: their count, and the first two.
struct EdgesAt {
    int count = 0;
    std::array<int, 2> edges = {-1, -1};

    int other_than(int edge) const { return edges[0] == edge ? edges[1] : edges[0]; }
};

std::vector<EdgesAt> gather_at_points(const ObstacleTopology& topology, const std::vector<FeatureEdge>& edges,
                                      std::size_t point_count)
{
    std::vector<EdgesAt> at(point_count);
    for (int k = 0; k < static_cast<int>(edges.size()); ++k)
        for (const int p : topology.edges[edges[k].edge].points) {
            if (at[p].count < 2) at[p].edges[at[p].count] = k;
            ++at[p].count;
        }
    return at;
}

int other_end(const ObstacleEdge& edge, int point)
{
    return edge.points[0] == point ? edge.points[1] : edge.points[0];
}

/// Whether the point is a corner: features meet, end, bend sharply or change kind there.
bool is_node(const ObstacleMesh& mesh, const ObstacleTopology& topology,
             const std::vector<FeatureEdge>& edges, const EdgesAt& at, int point)
{
    if (at.count != 2) return at.count > 0;
    const FeatureEdge& first = edges[at.edges[0]];
    const FeatureEdge& second = edges[at.edges[1]];
    if (first.kind != second.kind) return true;
    const Vec3& from = mesh.points[other_end(topology.edges[first.edge], point)];
    const Vec3& to = mesh.points[other_end(topology.edges[second.edge], point)];
    const double turn = angle_between((mesh.points[point] - from).stableNormalized(),
                                      (to - mesh.points[point]).stableNormalized());
    const double most = first.kind == FeatureKind::Wire ? 2.0 * kCornerTurn : kCornerTurn;
    return degrees(turn) > most + kTurnSlack;
}

/// Index of a corner of a face: 3 face + corner.
int corner_of(const ObstacleMesh& mesh, int face, int point)
{
    const Face& f = mesh.faces[face];
    return 3 * face + static_cast<int>(std::find(f.begin(), f.end(), point) - f.begin());
}

double angle_at(const ObstacleMesh& mesh, const Face& face, int corner)
{
    const Vec3& p = mesh.points[face[corner]];
    return angle_between((mesh.points[face[(corner + 1) % 3]] - p).stableNormalized(),
                         (mesh.points[face[(corner + 2) % 3]] - p).stableNormalized());
}

/// Maps each corner of a face (3 face + corner) to the representative of its fan. A fan is a set of corners
/// at one point that are joined through edges. Surfaces that meet in a point alone have a fan each.
std::vector<int> find_fans(const ObstacleMesh& mesh, const ObstacleTopology& topology)
{
    std::vector<int> parent(3 * mesh.faces.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int c) {
        while (parent[c] != c) c = parent[c] = parent[parent[c]];
        return c;
    };
    for (int e = 0; e < topology.surface_edge_count; ++e) {
        const auto [f, g] = topology.edges[e].faces;
        if (g < 0) continue;
        for (const int p : topology.edges[e].points)
            parent[root(corner_of(mesh, f, p))] = root(corner_of(mesh, g, p));
    }
    for (int c = 0; c < static_cast<int>(parent.size()); ++c) parent[c] = root(c);
    return parent;
}

/// Marks the apexes of cones: points where the angles of a closed fan of faces sum to much less than 360
/// degrees. A pit in a solid, reflex on the whole, is not marked.
void mark_apexes(const ObstacleMesh& mesh, const ObstacleTopology& topology, const FacePlanes& planes,
                 const std::vector<int>& fan_of, std::vector<char>& is_corner)
{
    struct Fan {
        double angle = 0.0, turn = 0.0;
        bool is_open = false;
    };
    std::vector<Fan> fans(fan_of.size());
    for (int e = 0; e < topology.surface_edge_count; ++e) {
        const auto [f, g] = topology.edges[e].faces;
        const double turn = g < 0 ? 0.0 : signed_turn(mesh, topology, planes, e);
        for (const int p : topology.edges[e].points) {
            Fan& fan = fans[fan_of[corner_of(mesh, f, p)]];
            fan.turn += turn;
            fan.is_open |= g < 0;
        }
    }
    for (int c = 0; c < static_cast<int>(fans.size()); ++c)
        fans[fan_of[c]].angle += angle_at(mesh, mesh.faces[c / 3], c % 3);

    for (int c = 0; c < static_cast<int>(fans.size()); ++c) {
        const Fan& fan = fans[c];
        if (fan_of[c] != c || fan.is_open) continue;
        if (360.0 - degrees(fan.angle) <= 2.0 * kCornerTurn + kTurnSlack) continue;
        const bool is_sheet = !topology.is_solid[topology.component[c / 3]];
        if (is_sheet || fan.turn > 0.0) is_corner[mesh.faces[c / 3][c % 3]] = 1;
    }
}

/// Numbers the chains of feature edges between corners, in the order of their first edges.
std::vector<FeaturePolyline> chain(const ObstacleMesh& mesh, const ObstacleTopology& topology,
                                   const std::vector<EdgesAt>& at, const std::vector<char>& is_corner,
                                   std::vector<FeatureEdge>& edges)
{
    std::vector<FeaturePolyline> polylines;
    const auto add = [&](int k) {
        const auto& [a, b] = topology.edges[edges[k].edge].points;
        edges[k].polyline = static_cast<int>(polylines.size()) - 1;
        polylines.back().length += (mesh.points[b] - mesh.points[a]).norm();
    };
    for (int seed = 0; seed < static_cast<int>(edges.size()); ++seed) {
        if (edges[seed].polyline >= 0) continue;
        polylines.emplace_back();
        add(seed);
        for (int point : topology.edges[edges[seed].edge].points) {
            // A chain ends at a corner, or where a closed chain returns to its start.
            int k = seed;
            while (!is_corner[point]) {
                k = at[point].other_than(k);
                if (edges[k].polyline >= 0) {
                    polylines.back().is_closed = true;
                    break;
                }
                add(k);
                point = other_end(topology.edges[edges[k].edge], point);
            }
        }
    }
    return polylines;
}

std::vector<int> find_patches(const ObstacleMesh& mesh, const ObstacleTopology& topology,
                              const FacePlanes& planes, double diagonal)
{
    std::vector<int> patch(mesh.faces.size(), -1);
    int count = 0;
    for (int seed = 0; seed < static_cast<int>(mesh.faces.size()); ++seed) {
        if (patch[seed] >= 0) continue;
        // Compare every face with the seed, so that a finely curved surface does not drift into one patch.
        const Vec3& normal = planes.normals[seed];
        const Vec3& origin = mesh.points[mesh.faces[seed][0]];
        const auto is_in_plane = [&](int f) {
            return angle_between(normal, planes.normals[f]) <= kSinglePrecision &&
                   std::all_of(mesh.faces[f].begin(), mesh.faces[f].end(), [&](int p) {
                       return std::abs(normal.dot(mesh.points[p] - origin)) <= kSinglePrecision * diagonal;
                   });
        };
        label_connected(topology, seed, count++, is_in_plane, patch);
    }
    return patch;
}

/// Distinct normals of the planes around a point, in the order of their first faces there.
std::vector<Vec3> normals_around(const ObstacleTopology& topology, const FacePlanes& planes,
                                 const std::vector<int>& patch, int point)
{
    std::vector<int> seen;
    std::vector<Vec3> normals;
    for (const int f : topology.faces_at(point)) {
        const Vec3& normal = planes.normals[f];
        if (std::find(seen.begin(), seen.end(), patch[f]) != seen.end()) continue;
        seen.push_back(patch[f]);
        if (std::none_of(normals.begin(), normals.end(),
                         [&](const Vec3& n) { return (n - normal).norm() <= kSinglePrecision; }))
            normals.push_back(normal);
    }
    return normals;
}

/// Marks the nodes of a pose; other points stay as they are.
void mark_nodes(const ObstacleMesh& mesh, const ObstacleTopology& topology, const FacePlanes& planes,
                const std::vector<FeatureEdge>& edges, const std::vector<EdgesAt>& at,
                const std::vector<int>& fan_of, std::vector<char>& is_corner)
{
    mark_apexes(mesh, topology, planes, fan_of, is_corner);
    for (int p = 0; p < static_cast<int>(mesh.points.size()); ++p)
        if (is_node(mesh, topology, edges, at[p], p)) is_corner[p] = 1;
}

/// Distinct normals of the faces around a point, for a pose in which no faces share a plane.
std::vector<Vec3> normals_in_pose(const ObstacleTopology& topology, int point)
{
    constexpr double kDistinct = 0.087;  // of unit normals: 5 degrees
    std::vector<Vec3> normals;
    for (const int f : topology.faces_at(point)) {
        const Vec3& normal = topology.face_normals[f];
        if (!normal.isZero(0.0) && std::none_of(normals.begin(), normals.end(), [&](const Vec3& n) {
                return (n - normal).norm() <= kDistinct;
            }))
            normals.push_back(normal);
    }
    return normals;
}

/// Features of a mesh with these planes, of what is sharp in one of the poses that `visit` visits twice:
/// visit(use) calls use(pose, its topology, its planes).
template <class Visit>
ObstacleFeatures find_features_in(const ObstacleMesh& mesh, const ObstacleTopology& topology,
                                  const FacePlanes& planes, double feature_angle, const Visit& visit)
{
    std::vector<char> is_marked(topology.edges.size(), 0);
    visit([&](const ObstacleMesh& pose, const ObstacleTopology& posed, const FacePlanes& of_pose) {
        mark_sharp(pose, posed, of_pose, feature_angle, is_marked);
    });
    ObstacleFeatures features;
    features.edges = make_feature_edges(topology, planes, is_marked);
    features.patch = find_patches(mesh, topology, planes, diagonal_of(mesh));

    const std::vector<EdgesAt> at = gather_at_points(topology, features.edges, mesh.points.size());
    const std::vector<int> fan_of = find_fans(mesh, topology);
    std::vector<char> is_corner(mesh.points.size(), 0);
    for (const int p : mesh.lone_points) is_corner[p] = 1;
    visit([&](const ObstacleMesh& pose, const ObstacleTopology& posed, const FacePlanes& of_pose) {
        mark_nodes(pose, posed, of_pose, features.edges, at, fan_of, is_corner);
    });
    features.polylines = chain(mesh, topology, at, is_corner, features.edges);
    for (int p = 0; p < static_cast<int>(mesh.points.size()); ++p)
        if (is_corner[p])
            features.corners.push_back({p, normals_around(topology, planes, features.patch, p)});
    return features;
}

}  // namespace

ObstacleFeatures find_features(const ObstacleMesh& mesh, const ObstacleTopology& topology,
                               double feature_angle)
{
    const FacePlanes planes = find_planes(mesh, topology, diagonal_of(mesh));
    return find_features_in(mesh, topology, planes, feature_angle,
                            [&](const auto& use) { use(mesh, topology, planes); });
}

ObstacleFeatures find_features_of_poses(const ObstacleMesh& mesh, const ObstacleTopology& topology,
                                        double feature_angle, const VisitPoses& visit_poses)
{
    const FacePlanes planes = find_planes(mesh, topology, diagonal_of(mesh));
    return find_features_in(mesh, topology, planes, feature_angle, [&](const auto& use) {
        visit_poses([&](const ObstacleMesh& pose, const ObstacleTopology& posed) {
            use(pose, posed, find_planes(pose, posed, diagonal_of(pose)));
        });
    });
}

void pose_features(const ObstacleMesh& mesh, const ObstacleTopology& topology, double feature_angle,
                   ObstacleFeatures& features)
{
    const FacePlanes planes = find_planes(mesh, topology, diagonal_of(mesh));
    std::vector<char> has_edge(mesh.points.size(), 0), has_awake(mesh.points.size(), 0);
    for (FeatureEdge& feature : features.edges) {
        const auto [f, g] = topology.edges[feature.edge].faces;
        if (f >= 0) feature.normals = {planes.normals[f], planes.normals[g < 0 ? f : g]};
        feature.is_awake = feature.kind != FeatureKind::Convex ||
                           is_sharp(mesh, topology, planes, feature.edge, feature_angle);
        for (const int p : topology.edges[feature.edge].points) {
            has_edge[p] = 1;
            has_awake[p] |= feature.is_awake;
        }
    }
    for (FeatureCorner& corner : features.corners) {
        corner.normals = normals_in_pose(topology, corner.point);
        corner.is_awake = has_awake[corner.point] || !has_edge[corner.point];
    }
}

}  // namespace arris
