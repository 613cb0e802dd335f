// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/deform/slit.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <queue>
#include <unordered_set>
#include <utility>

#include "geometry/check/penetration.h"
#include "geometry/closest_point.h"
#include "geometry/batches.h"
#include "geometry/self_contact/self_intersection.h"
#include "geometry/sort_unique.h"

namespace arris {
namespace {

constexpr int kMostRounds = 10;
constexpr int kRings = 3;
constexpr double kNearSlits = 3.0;  // along the mesh: what is nearer is one part
constexpr double kSettled = 0.01;   // of the width: what may be missing at the end
constexpr double kJustOut = 1e-3;   // of the width: where a place is asked for being inside another part

std::vector<std::vector<int>> find_neighbours(const ObstacleTopology& topology, std::size_t point_count)
{
    std::vector<std::vector<int>> neighbours(point_count);
    for (int e = 0; e < topology.surface_edge_count; ++e) {
        const auto& [a, b] = topology.edges[e].points;
        neighbours[a].push_back(b);
        neighbours[b].push_back(a);
    }
    return neighbours;
}

/// Joins the values of each point and its neighbours, ring after ring.
template <class Value, class Join>
std::vector<Value> join_rings(const std::vector<std::vector<int>>& neighbours, std::vector<Value> values,
                              const Join& join)
{
    std::vector<Value> next(values.size());
    for (int ring = 0; ring < kRings; ++ring) {
        for (std::size_t p = 0; p < values.size(); ++p) next[p] = join(values, p, neighbours[p]);
        values.swap(next);
    }
    return values;
}

Box3 box_around(const Vec3& place, double radius)
{
    return {place.array() - radius, place.array() + radius};
}

double distance_to(const Obstacle& pose, int face, const Vec3& place)
{
    const std::vector<Vec3>& points = pose.mesh().points;
    const auto& [a, b, c] = pose.mesh().faces[face];
    return (closest_on_triangle(place, {points[a], points[b], points[c]}, pose.topology().face_normals[face])
                .point -
            place)
        .norm();
}

}  // namespace

std::vector<std::array<int, 2>> find_crossing_faces(const ObstacleMesh& mesh, const std::vector<Vec3>& points)
{
    return find_self_intersections(points, mesh.faces);
}

SlitFinder::SlitFinder(const ObstacleMesh& mesh, double width)
    : shape_(mesh, 180.0),
      width_(width),
      around_(find_neighbours(shape_.topology(), mesh.points.size())),
      neighbours_(around_),
      is_buried_(mesh.points.size(), 0)
{
    const std::vector<Vec3> normals = find_normals(mesh.points);
    const std::vector<std::array<int, 2>> crossing = find_crossing_faces(mesh, mesh.points);
    is_buried_ = find_inside(shape_, normals, crossing);
    std::vector<std::array<int, 2>> links;  // point and face
    for (const auto& [first, second] : crossing)
        for (const int p : mesh.faces[first]) links.push_back({p, second});
    std::vector<int> found;
    for (std::size_t p = 0; p < mesh.points.size(); ++p) {
        shape_.find_faces(box_around(mesh.points[p], width), found);
        for (const int f : found)
            if (shape_.topology().face_normals[f].dot(normals[p]) < 0.0 &&
                distance_to(shape_, f, mesh.points[p]) < width)
                links.push_back({static_cast<int>(p), f});
    }
    for (const auto& [p, f] : links)
        for (const int q : mesh.faces[f])
            if (p != q) {
                neighbours_[p].push_back(q);
                neighbours_[q].push_back(p);
            }
    for (std::vector<int>& around : neighbours_) sort_unique(around);
}

// In the mean over some rings, by area: faces that have turned over in a crease are small.
std::vector<Vec3> SlitFinder::find_normals(const std::vector<Vec3>& points) const
{
    std::vector<Vec3> areas(points.size(), Vec3::Zero());
    for (const auto& [a, b, c] : shape_.mesh().faces) {
        const Vec3 area = (points[b] - points[a]).cross(points[c] - points[a]);
        for (const int p : {a, b, c}) areas[p] += area;
    }
    std::vector<Vec3> normals = join_rings(
        around_, areas, [](const std::vector<Vec3>& of, std::size_t p, const std::vector<int>& around) {
            Vec3 sum = of[p];
            for (const int q : around) sum += of[q];
            return sum;
        });
    for (Vec3& normal : normals) normal.stableNormalize();
    return normals;
}

// The greatest value within some rings, then the mean over as many: nowhere less than the value.
std::vector<double> SlitFinder::spread(const std::vector<double>& values) const
{
    const auto greatest = [](const std::vector<double>& of, std::size_t p, const std::vector<int>& around) {
        double most = of[p];
        for (const int q : around) most = std::max(most, of[q]);
        return most;
    };
    const auto mean = [](const std::vector<double>& of, std::size_t p, const std::vector<int>& around) {
        double sum = of[p];
        for (const int q : around) sum += of[q];
        return sum / static_cast<double>(around.size() + 1);
    };
    return join_rings(around_, join_rings(around_, values, greatest), mean);
}

// Skin in the crease of a joint is crushed: each edge counts with its lesser length.
bool SlitFinder::is_one_part(const std::vector<Vec3>& points, int point, const Face& face) const
{
    const std::vector<Vec3>& own = shape_.mesh().points;
    const auto length = [&](int p, int q) {
        return std::min((own[q] - own[p]).norm(), (points[q] - points[p]).norm());
    };
    const double most = kNearSlits * width_;
    for (const int p : face)  // most are beside each other
        if (std::binary_search(neighbours_[point].begin(), neighbours_[point].end(), p) &&
            length(point, p) <= most)
            return true;
    using Open = std::pair<double, int>;
    std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
    open.push({0.0, point});
    std::unordered_set<int> seen;
    while (!open.empty()) {
        const auto [distance, p] = open.top();
        open.pop();
        if (std::find(face.begin(), face.end(), p) != face.end()) return true;
        if (!seen.insert(p).second) continue;
        for (const int q : neighbours_[p])
            if (const double there = distance + length(p, q); there <= most) open.push({there, q});
    }
    return false;
}

// Edges beside which nothing crosses join points on one side of all surfaces: one point of a region tells of
// all. A region without a crossing is asked for nothing: what is inside another part and does not cross it,
// as teeth are, belongs there.
std::vector<char> SlitFinder::find_inside(const Obstacle& pose, const std::vector<Vec3>& normals,
                                          const std::vector<std::array<int, 2>>& crossing) const
{
    const ObstacleTopology& topology = pose.topology();
    std::vector<char> crosses(topology.face_edges.size(), 0);
    for (const std::array<int, 2>& pair : crossing)
        for (const int f : pair) crosses[f] = 1;
    const auto joins = [&](const ObstacleEdge& edge) {
        return std::none_of(edge.faces.begin(), edge.faces.end(),
                            [&](int f) { return f >= 0 && crosses[f] != 0; });
    };
    std::vector<char> is_inside(normals.size(), 0), is_known(normals.size(), 0);
    const auto tell_region = [&](int seed) {
        if (is_known[seed] != 0) return;
        const Vec3 outside = pose.mesh().points[seed] + kJustOut * width_ * normals[seed];
        const char inside = winding_number(pose, outside) != 0 ? 1 : 0;
        std::vector<int> open(1, seed);
        is_known[seed] = 1;
        while (!open.empty()) {
            const int p = open.back();
            open.pop_back();
            is_inside[p] = inside;
            for (int k = 0; k < topology.edge_count_at(p); ++k) {
                const ObstacleEdge& edge = topology.edges[topology.edge_at(p, k)];
                const int q = edge.points[0] == p ? edge.points[1] : edge.points[0];
                if (edge.faces[0] < 0 || is_known[q] != 0 || !joins(edge)) continue;
                is_known[q] = 1;
                open.push_back(q);
            }
        }
    };
    for (const std::array<int, 2>& pair : crossing)
        for (const int f : pair)
            for (const int p : pose.mesh().faces[f]) tell_region(p);
    return is_inside;
}

// Each of two surfaces gives half of what is missing, and less where they do not look at each other. A point
// inside is there through the surface nearest to it: where that is of its own part, the skin has only folded.
double SlitFinder::find_missing(const Obstacle& pose, const Vec3& normal, int point, bool is_inside) const
{
    const Vec3& place = pose.mesh().points[point];
    std::vector<int> found;
    double radius = width_;
    while (true) {
        const Box3 box = box_around(place, radius);
        pose.find_faces(box, found);
        double nearest = radius, against = 0.0;
        bool is_apart = false;
        for (const int f : found) {
            const Face& face = pose.mesh().faces[f];
            const double opposed = -normal.dot(pose.topology().face_normals[f]);
            if (!(opposed > 0.0) || std::find(face.begin(), face.end(), point) != face.end()) continue;
            const double distance = distance_to(pose, f, place);
            if (!(distance < nearest)) continue;
            const bool is_other = is_buried_[face[0]] == 0 && !is_one_part(pose.mesh().points, point, face);
            if (!is_other && !is_inside) continue;
            nearest = distance;
            against = opposed;
            is_apart = is_other;
        }
        if (against > 0.0 && !is_apart) return 0.0;
        if (against > 0.0) return against * 0.5 * std::max(0.0, width_ - (is_inside ? -nearest : nearest));
        if (!is_inside || box.contains(pose.bounds())) return 0.0;
        radius *= 2.0;
    }
}

// What is missing of the width at each of the candidates' places.
std::vector<double> SlitFinder::find_missing(const std::vector<Vec3>& points,
                                             const std::vector<Vec3>& normals,
                                             const std::vector<int>& candidates) const
{
    const Obstacle pose(shape_, points);
    const std::vector<std::array<int, 2>> crossing = find_crossing_faces(shape_.mesh(), points);
    const std::vector<char> is_inside = find_inside(pose, normals, crossing);
    const auto find = [&](int begin, int end, std::vector<double>& missing) {
        for (int i = begin; i < end; ++i) {
            const int p = candidates[i];
            missing.push_back(find_missing(pose, normals[p], p, is_inside[p] != 0));
        }
    };
    const std::vector<double> of_candidates =
        collect_in_batches<double>(static_cast<int>(candidates.size()), find);
    std::vector<double> missing(points.size(), 0.0);
    for (std::size_t i = 0; i < candidates.size(); ++i) missing[candidates[i]] = of_candidates[i];
    // Faces of two parts may cross between points that are clear.
    for (const auto& [first, second] : crossing) {
        const Face &a = shape_.mesh().faces[first], &b = shape_.mesh().faces[second];
        if (std::any_of(a.begin(), a.end(),
                        [&](int p) { return is_buried_[p] != 0 || is_one_part(points, p, b); }))
            continue;
        const double opposed = -pose.topology().face_normals[first].dot(pose.topology().face_normals[second]);
        for (const Face& face : {a, b})
            for (const int p : face) missing[p] = std::max(missing[p], 0.5 * opposed * width_);
    }
    return missing;
}

std::vector<double> SlitFinder::find_retreat(const std::vector<Vec3>& points) const
{
    const std::vector<Vec3> normals = find_normals(points);
    std::vector<double> retreat(points.size(), 0.0), wide = retreat;
    double most = 0.0;
    std::vector<int> candidates(points.size());
    std::iota(candidates.begin(), candidates.end(), 0);
    std::erase_if(candidates, [&](int p) { return is_buried_[p] != 0; });
    for (int round = 0; round < kMostRounds; ++round) {
        const std::vector<double> missing = find_missing(apply(points, wide), normals, candidates);
        const double greatest = *std::max_element(missing.begin(), missing.end());
        if (greatest <= kSettled * width_) break;
        // Later rounds make up for normals that are askew. More would hollow out parts that lie deep in each
        // other.
        if (round == 0) most = greatest + width_;
        for (std::size_t p = 0; p < points.size(); ++p) retreat[p] = std::min(retreat[p] + missing[p], most);
        wide = spread(retreat);
        // Only what moves comes nearer to something or goes away.
        candidates.clear();
        for (std::size_t p = 0; p < points.size(); ++p)
            if (wide[p] > 0.0 && is_buried_[p] == 0) candidates.push_back(static_cast<int>(p));
    }
    return wide;
}

std::vector<Vec3> SlitFinder::apply(const std::vector<Vec3>& points, const std::vector<double>& retreat) const
{
    const std::vector<Vec3> normals = find_normals(points);
    std::vector<Vec3> moved = points;
    for (std::size_t p = 0; p < points.size(); ++p) moved[p] -= retreat[p] * normals[p];
    return moved;
}

}  // namespace arris
