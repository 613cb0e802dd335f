// SPDX-License-Identifier: GPL-3.0-or-later
//
// Branch and bound. Within a triangle no point is farther from the surface than the triangle's farthest
// corner is from any one obstacle face. (A face is convex, and so is the distance to it.) Over a flat surface
// this bound is exact. Where the surface is farther from the triangle's middle than its corners are, the
// whole triangle is inside or outside.
//
// Penetration that is shallow compared with the cloth face is too fine for this search. Such places are
// sampled where the surfaces meet. A local search then improves the best point of all.
#include "geometry/check/deepest_point.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Triangle_3.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

#include "geometry/cgal.h"
#include "geometry/check/penetration.h"
#include "geometry/closest_point.h"
#include "geometry/obstacle/obstacle_touch.h"

namespace arris {
namespace {

using Triangle = Kernel::Triangle_3;
using Tree = CGAL::AABB_tree<
    CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, std::vector<Triangle>::const_iterator>>>;

constexpr double kAccuracy = 0.01;       // relative to the depth
constexpr double kFinestPart = 1e-4;     // relative to the longest side of the triangle entered: shallower
                                         // places are sampled
constexpr int kMostEvaluations = 40000;  // two seconds on 100 000 obstacle faces; a time limit would make the
                                         // result depend on the machine

/// Distances to the faces of an obstacle's solids.
class SolidSurface {
  public:
    struct Nearest {
        double distance;
        int face;
    };

    explicit SolidSurface(const Obstacle& obstacle) : obstacle_(obstacle)
    {
        const ObstacleMesh& mesh = obstacle.mesh();
        const ObstacleTopology& topology = obstacle.topology();
        for (int f = 0; f < static_cast<int>(mesh.faces.size()); ++f) {
            if (!topology.is_solid[topology.component[f]]) continue;
            const auto& [a, b, c] = mesh.faces[f];
            faces_.push_back(f);
            triangles_.emplace_back(to_cgal(mesh.points[a]), to_cgal(mesh.points[b]),
                                    to_cgal(mesh.points[c]));
        }
        tree_.insert(triangles_.cbegin(), triangles_.cend());
    }

    Nearest nearest(const Vec3& place) const
    {
        const auto id = tree_.closest_point_and_primitive(to_cgal(place)).second;
        const int face = faces_[id - triangles_.cbegin()];
        return {distance(face, place), face};
    }

    double distance(int face, const Vec3& place) const
    {
        const auto& [a, b, c] = obstacle_.mesh().faces[face];
        const std::vector<Vec3>& points = obstacle_.mesh().points;
        const PointOnTriangle on = closest_on_triangle(place, {points[a], points[b], points[c]},
                                                       obstacle_.topology().face_normals[face]);
        return (place - on.point).norm();
    }

    int any_face() const { return faces_.front(); }

  private:
    const Obstacle& obstacle_;
    std::vector<int> faces_;
    std::vector<Triangle> triangles_;
    Tree tree_;
};

/// A part of a cloth face that may contain the deepest point.
struct Part {
    std::array<Vec3, 3> corners;
    ClothSide side;
    int face;
    double finest;                                           ///< m, smaller depths are left to the samples
    double bound = std::numeric_limits<double>::infinity();  ///< m, upper bound on the depth of its points
    int number = 0;                                          ///< order of entry, which decides between equal
                                                             ///< bounds

    bool operator<(const Part& other) const
    {
        return bound != other.bound ? bound < other.bound : number > other.number;
    }
};

class DepthSearch {
  public:
    explicit DepthSearch(const Obstacle& obstacle)
        : obstacle_(obstacle), surface_(obstacle), near_(surface_.any_face())
    {
    }

    const DeepestPoint& best() const { return best_; }

    void sample(const Vec3& place, ClothSide side, int face)
    {
        if (is_spent() || surface_.distance(near_, place) <= best_.depth) return;
        take_if_deeper(place, find_nearest(place).distance, side, face);
    }

    /// Enters a part into the search, unless none of its points can be deeper than the best.
    void enter(Part part)
    {
        part.bound = std::min(part.bound, bound_by(near_, part.corners));
        if (is_hopeless(part)) return;
        const Vec3 middle = (part.corners[0] + part.corners[1] + part.corners[2]) / 3.0;
        const SolidSurface::Nearest nearest = find_nearest(middle);
        part.bound = std::min(part.bound, bound_by(nearest.face, part.corners));
        if (part.side == ClothSide::Unknown && nearest.distance > radius_around(middle, part.corners)) {
            if (winding_number(obstacle_, middle) == 0) return;
            part.side = ClothSide::Inside;
        }
        take_if_deeper(middle, nearest.distance, part.side, part.face);
        if (is_hopeless(part)) return;
        part.number = entered_++;
        parts_.push(part);
    }

    /// Halves the part with the greatest bound, until no part can contain a deeper point.
    void run()
    {
        while (!parts_.empty() && !is_spent()) {
            const Part part = parts_.top();
            parts_.pop();
            if (is_hopeless(part)) continue;
            int i = 0;
            for (int k = 1; k < 3; ++k)
                if (side_of(part, k).squaredNorm() > side_of(part, i).squaredNorm()) i = k;
            const Vec3 middle = part.corners[i] + side_of(part, i) / 2.0;
            for (const int moved : {i, (i + 1) % 3}) {
                Part half = part;
                half.corners[moved] = middle;
                enter(half);
            }
        }
    }

    /// Searches around the best point, within its cloth face (with these corners), for a deeper one at
    /// shrinking distances. The directions rotate from round to round, so that none is preferred.
    void improve(const std::array<Vec3, 3>& corners)
    {
        constexpr int kMostRounds = 200;
        constexpr int kDirections = 6;
        const Vec3 u = corners[1] - corners[0], v = corners[2] - corners[0];
        const Vec3 normal = u.cross(v).stableNormalized();
        const Vec3 along = u.stableNormalized(), across = normal.cross(along);
        double reach = std::max(u.norm(), v.norm()) / 4.0, turn = 0.0;
        evaluations_ = 0;
        for (int round = 0; round < kMostRounds && reach > kAccuracy * best_.depth; ++round) {
            const double depth = best_.depth;
            const Vec3 centre = best_.place;
            for (int k = 0; k < kDirections; ++k) {
                const double angle = turn + 2.0 * std::numbers::pi * k / kDirections;
                const Vec3 way = reach * (std::cos(angle) * along + std::sin(angle) * across);
                sample(closest_on_triangle(centre + way, corners, normal).point, ClothSide::Unknown,
                       best_.face);
            }
            turn += 1.0;  // rad, not a rational fraction of a full turn
            if (best_.depth <= depth * (1.0 + kAccuracy * kAccuracy)) reach /= 2.0;
        }
    }

  private:
    static Vec3 side_of(const Part& part, int i) { return part.corners[(i + 1) % 3] - part.corners[i]; }

    static double radius_around(const Vec3& middle, const std::array<Vec3, 3>& corners)
    {
        double squared = 0.0;
        for (const Vec3& p : corners) squared = std::max(squared, (p - middle).squaredNorm());
        return std::sqrt(squared);
    }

    double bound_by(int face, const std::array<Vec3, 3>& corners) const
    {
        double bound = 0.0;
        for (const Vec3& p : corners) bound = std::max(bound, surface_.distance(face, p));
        return bound;
    }

    bool is_spent() const { return evaluations_ >= kMostEvaluations; }

    bool is_hopeless(const Part& part) const
    {
        return is_spent() || part.bound <= std::max(best_.depth * (1.0 + kAccuracy), part.finest);
    }

    SolidSurface::Nearest find_nearest(const Vec3& place)
    {
        ++evaluations_;
        const SolidSurface::Nearest nearest = surface_.nearest(place);
        near_ = nearest.face;
        return nearest;
    }

    void take_if_deeper(const Vec3& place, double depth, ClothSide side, int face)
    {
        if (depth <= best_.depth) return;
        if (side == ClothSide::Unknown && winding_number(obstacle_, place) == 0) return;
        best_ = {depth, face, place};
    }

    const Obstacle& obstacle_;
    SolidSurface surface_;
    int near_;  ///< face nearest to the last place evaluated; bounds the depth of places nearby
    std::priority_queue<Part> parts_;
    int entered_ = 0, evaluations_ = 0;
    DeepestPoint best_;
};

double longest_side(const std::array<Vec3, 3>& t)
{
    return std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
}

/// Barycentric coordinates of a point in a triangle of non-zero area.
Vec3 coordinates_in(const std::array<Vec3, 3>& t, const Vec3& p)
{
    const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
    Vec3 coordinates;
    for (int i = 0; i < 3; ++i) coordinates[i] = (t[(i + 1) % 3] - p).cross(t[(i + 2) % 3] - p).dot(normal);
    return coordinates / normal.squaredNorm();
}

/// The smallest factor by which the triangle can be scaled about its point `centre` and still contain
/// `others`.
double shrinkage(const std::array<Vec3, 3>& t, const Vec3& centre, const std::vector<Vec3>& others)
{
    const Vec3 at = coordinates_in(t, centre);
    double factor = 0.0;
    for (const Vec3& p : others) {
        const Vec3 way = at - coordinates_in(t, p);
        for (int i = 0; i < 3; ++i)
            if (way[i] > 0.0) factor = std::max(factor, way[i] / at[i]);
    }
    return factor;
}

/// Samples a cloth face where it intersects the surface: at the mean of all intersections, and midway between
/// pairs of them. If a convex obstacle pokes through, one of these samples is inside, however small the
/// obstacle is. Where the intersections are close together, the triangle around them enters the search as a
/// part of that size.
void search_meetings(const Obstacle& obstacle, const std::array<Vec3, 3>& corners, int face,
                     DepthSearch& search)
{
    constexpr int kMostInPairs = 8;
    constexpr double kMargin = 3.0;  // midpoints of the sides of a cut span a third to a half of the cut
    ObstacleTouch touch;
    find_touches(obstacle, corners, touch);
    if (touch.faces.empty()) return;
    std::vector<Vec3> middles;
    Vec3 sum = Vec3::Zero();
    for (const int f : touch.faces) {
        const auto& [a, b, c] = obstacle.mesh().faces[f];
        const std::vector<Vec3>& points = obstacle.mesh().points;
        middles.push_back(middle_of_touch(corners, {points[a], points[b], points[c]}));
        sum += middles.back() - middles.front();
    }
    const Vec3 centre = middles.front() + sum / static_cast<double>(middles.size());
    search.sample(centre, ClothSide::Unknown, face);
    // If there are more, take evenly spaced ones.
    const int n = static_cast<int>(middles.size()), m = std::min(n, kMostInPairs);
    for (int i = 0; i < m; ++i)
        for (int j = 0; j < i; ++j)
            search.sample((middles[i * n / m] + middles[j * n / m]) / 2.0, ClothSide::Unknown, face);

    const double factor = kMargin * shrinkage(corners, centre, middles);
    if (!(factor > 0.0 && factor < 1.0)) return;  // also rejects a cloth face without area
    std::array<Vec3, 3> around;
    for (int i = 0; i < 3; ++i) around[i] = centre + factor * (corners[i] - centre);
    search.enter({around, ClothSide::Unknown, face, kFinestPart * longest_side(around)});
}

}  // namespace

DeepestPoint find_deepest(const Obstacle& obstacle, const std::vector<Vec3>& positions,
                          const std::vector<Face>& faces, const std::vector<ClothSide>& sides)
{
    DepthSearch search(obstacle);
    const auto corners_of = [&](int f) {
        return std::array<Vec3, 3>{positions[faces[f][0]], positions[faces[f][1]], positions[faces[f][2]]};
    };
    std::vector<char> is_sampled(positions.size(), 0);
    for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
        if (sides[f] == ClothSide::Outside) continue;
        for (const int v : faces[f]) {
            if (!is_sampled[v]) search.sample(positions[v], sides[f], f);
            is_sampled[v] = 1;
        }
        if (sides[f] == ClothSide::Unknown) search_meetings(obstacle, corners_of(f), f, search);
    }
    for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
        if (sides[f] == ClothSide::Outside) continue;
        const std::array<Vec3, 3> corners = corners_of(f);
        search.enter({corners, sides[f], f, kFinestPart * longest_side(corners)});
    }
    search.run();
    if (search.best().face >= 0) search.improve(corners_of(search.best().face));
    return search.best();
}

}  // namespace arris
