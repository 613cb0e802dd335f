// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/check/penetration.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "geometry/batches.h"
#include "geometry/cgal.h"
#include "geometry/check/deepest_point.h"
#include "geometry/obstacle/obstacle_touch.h"

namespace arris {
namespace {

bool is_solid(const Obstacle& obstacle, int face)
{
    return obstacle.topology().is_solid[obstacle.topology().component[face]];
}

std::array<Vec3, 3> corners_of(const std::vector<Vec3>& points, const Face& face)
{
    return {points[face[0]], points[face[1]], points[face[2]]};
}

/// Kind of element that a cloth face touches. `Thing`: sheets, wires or points only.
enum class Touch : char { Nothing, Thing, Solid };

std::vector<Touch> find_touching(const Obstacle& obstacle, const std::vector<Vec3>& positions,
                                 const std::vector<Face>& faces)
{
    std::vector<Touch> touches(faces.size(), Touch::Nothing);
    constexpr int kSize = 256;  // faces; most of them are far away and cheap
    for_each_batch(static_cast<int>(faces.size()), kSize, [&](int first, int last, int) {
        ObstacleTouch touch;
        for (int f = first; f < last; ++f) {
            find_touches(obstacle, corners_of(positions, faces[f]), touch);
            if (!touch.is_any()) continue;
            const bool is_in_solid = std::any_of(touch.faces.begin(), touch.faces.end(),
                                                 [&](int g) { return is_solid(obstacle, g); });
            touches[f] = is_in_solid ? Touch::Solid : Touch::Thing;
        }
    });
    return touches;
}

/// Side of each cloth face. Vertices joined by faces that touch no solid are all on one side, found at one of
/// them.
std::vector<ClothSide> find_sides(const Obstacle& obstacle, const std::vector<Vec3>& positions,
                                  const std::vector<Face>& faces, const std::vector<Touch>& touches)
{
    std::vector<int> parent(positions.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (std::size_t f = 0; f < faces.size(); ++f) {
        if (touches[f] == Touch::Solid) continue;
        parent[root(faces[f][1])] = root(faces[f][0]);
        parent[root(faces[f][2])] = root(faces[f][0]);
    }
    std::vector<std::optional<ClothSide>> side_of(positions.size());
    std::vector<ClothSide> sides(faces.size(), ClothSide::Unknown);
    for (std::size_t f = 0; f < faces.size(); ++f) {
        if (touches[f] == Touch::Solid) continue;
        const int v = root(faces[f][0]);
        if (!side_of[v])
            side_of[v] = winding_number(obstacle, positions[v]) == 0 ? ClothSide::Outside : ClothSide::Inside;
        sides[f] = *side_of[v];
    }
    return sides;
}

/// Approximate location at which a cloth face touches the obstacle.
Vec3 place_of_touch(const Obstacle& obstacle, const std::array<Vec3, 3>& corners)
{
    const std::vector<Vec3>& points = obstacle.mesh().points;
    ObstacleTouch touch;
    find_touches(obstacle, corners, touch);
    if (!touch.faces.empty())
        return middle_of_touch(corners, corners_of(points, obstacle.mesh().faces[touch.faces.front()]));
    if (touch.segments.empty()) return points[touch.lone_points.front()];
    const auto& [a, b] = obstacle.topology().edges[touch.segments.front()].points;
    return middle_of_touch(corners, {points[a], points[b], points[b]});
}

/// Directions spread over the sphere along a golden-angle spiral, aligned with no axis.
Vec3 spiral_direction(int i, int count)
{
    const double z = 1.0 - (2.0 * i + 1.0) / count, angle = std::numbers::pi * (3.0 - std::sqrt(5.0)) * i;
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
}

/// How a segment passes a face.
enum class Passage { Outward, Inward, Beside, Starts, Grazes };

Passage passage(const Point3& from, const Point3& to, const Point3& a, const Point3& b, const Point3& c)
{
    const CGAL::Orientation begin = CGAL::orientation(a, b, c, from), end = CGAL::orientation(a, b, c, to);
    if (begin == CGAL::COPLANAR && end != CGAL::COPLANAR) return Passage::Starts;
    if (begin == end) return begin == CGAL::COPLANAR ? Passage::Grazes : Passage::Beside;
    if (end == CGAL::COPLANAR) return Passage::Grazes;
    for (const CGAL::Orientation turn : {CGAL::orientation(from, to, a, b), CGAL::orientation(from, to, b, c),
                                         CGAL::orientation(from, to, c, a)})
        if (turn == CGAL::COPLANAR) return Passage::Grazes;
    return end == CGAL::POSITIVE ? Passage::Outward : Passage::Inward;
}

/// Signed count of solid faces crossed on a straight way out. Returns nothing where the way hits an edge or
/// point.
std::optional<int> count_crossings(const Obstacle& obstacle, const Vec3& from, const Vec3& to,
                                   std::vector<int>& found)
{
    const Point3 begin = to_cgal(from), end = to_cgal(to);
    obstacle.find_faces_touching(from, to, found);
    int count = 0;
    bool grazes = false;
    for (const int f : found) {
        if (!is_solid(obstacle, f)) continue;
        const auto [a, b, c] = corners_of(obstacle.mesh().points, obstacle.mesh().faces[f]);
        switch (passage(begin, end, to_cgal(a), to_cgal(b), to_cgal(c))) {
            case Passage::Outward:
                ++count;
                break;
            case Passage::Inward:
                --count;
                break;
            case Passage::Beside:
                break;
            case Passage::Starts:
                return 0;  // starts on the surface
            case Passage::Grazes:
                grazes = true;
                break;
        }
    }
    if (grazes) return std::nullopt;
    return count;
}

}  // namespace

int winding_number(const Obstacle& obstacle, const Vec3& place)
{
    assert(place.allFinite());
    const Box3& bounds = obstacle.bounds();
    if (!bounds.contains(place)) return 0;
    // The end lies beyond the bounds. It is also far enough that rounding does not align directions where the
    // obstacle is small and far from the origin.
    const double length = 2.0 * bounds.diagonal().norm() + 1e-3 * place.cwiseAbs().maxCoeff();
    constexpr int kDirections = 64;
    std::vector<int> found;
    for (int i = 0; i < kDirections; ++i) {
        const Vec3 out = place + length * spiral_direction(i, kDirections);
        if (const std::optional<int> count = count_crossings(obstacle, place, out, found)) return *count;
    }
    assert(false && "64 directions all meet an edge of the obstacle");
    return 0;
}

Penetration find_penetration(const Obstacle& obstacle, const std::vector<Vec3>& positions,
                             const std::vector<Face>& faces)
{
    assert(std::all_of(positions.begin(), positions.end(), [](const Vec3& p) { return p.allFinite(); }));
    Penetration penetration;
    const std::vector<Touch> touches = find_touching(obstacle, positions, faces);
    const auto is_touching = [](Touch t) { return t != Touch::Nothing; };
    penetration.faces = static_cast<int>(std::count_if(touches.begin(), touches.end(), is_touching));

    const std::vector<char>& solids = obstacle.topology().is_solid;
    if (std::find(solids.begin(), solids.end(), 1) != solids.end()) {
        const std::vector<ClothSide> sides = find_sides(obstacle, positions, faces, touches);
        const auto may_be_inside = [](ClothSide side) { return side != ClothSide::Outside; };
        if (std::any_of(sides.begin(), sides.end(), may_be_inside)) {
            const DeepestPoint deepest = find_deepest(obstacle, positions, faces, sides);
            penetration.depth = deepest.depth;
            penetration.face = deepest.face;
            penetration.place = deepest.place;
        }
    }
    if (penetration.face < 0 && penetration.faces > 0) {
        const auto first = std::find_if(touches.begin(), touches.end(), is_touching) - touches.begin();
        penetration.face = static_cast<int>(first);
        penetration.place = place_of_touch(obstacle, corners_of(positions, faces[first]));
    }
    return penetration;
}

}  // namespace arris
