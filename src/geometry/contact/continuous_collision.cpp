// SPDX-License-Identifier: GPL-3.0-or-later
// Both elements are convex and the cloth's points move linearly. Two certificates therefore prove, over an
// interval of time, that the elements do not meet:
//  - plane: along a fixed direction n every difference "point of the cloth - point of the obstacle" is linear
//    in time. The elements are apart while all these differences are positive. n comes from the present
//    closest features, so that the plane holds for long;
//  - volume: elements that touch have four coplanar points, that is a root of a cubic in time. The root is
//    enclosed by Bernstein coefficients (as the inclusion functions of Wang et al. 2021, "A Large-scale
//    Benchmark and an Inclusion-based Algorithm for Continuous Collision Detection").
// Time advances from certificate to certificate until it reaches the end, or the gap is below `distance`.
// Only certificates decide, each with a bound on its rounding error. A poor direction costs a round or an
// unnecessary report, never a miss. All computations use differences of the given points, whose rounding does
// not grow with the distance from the origin.
#include "geometry/contact/continuous_collision.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "geometry/closest_point.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

constexpr int kMaxRounds = 256;  // 3 are usual; more only where planar elements pivot at a tiny gap
// Rounding bound, relative to size, of the Bernstein coefficients of a product of three differences, and of
// their subdivision (repeated averaging).
constexpr double kVolumeRounding = 8.0 * kProductRounding;

/// Differences between the elements' points at the step's begin and end, as the certificates need them.
struct Pair {
    int gaps;                                  ///< 3: point and triangle, 4: two segments
    std::array<Vec3, 4> gap_begin, gap_end;    ///< each point of the cloth minus each of the obstacle
    std::array<Vec3, 3> side_begin, side_end;  ///< sides of the triangle, or the two segments
};

/// A certificate: along `normal` the elements are `separation` apart now, and remain apart until `until`.
struct Plane {
    Vec3 normal = Vec3::Zero();
    double separation = 0.0;
    double until = 0.0;  ///< kNever: to the step's end
};

struct Touch {
    double time;
    Vec3 normal;
};

Vec3 at(const Vec3& begin, const Vec3& end, double time)
{
    return begin + time * (end - begin);
}

/// Bounds on the components of all differences during the step.
struct Extent {
    Vec3 low, high;
    double sum = 0.0;

    explicit Extent(const Pair& pair) : low(pair.gap_begin[0]), high(low)
    {
        for (int k = 0; k < pair.gaps; ++k) {
            low = low.cwiseMin(pair.gap_begin[k]).cwiseMin(pair.gap_end[k]);
            high = high.cwiseMax(pair.gap_begin[k]).cwiseMax(pair.gap_end[k]);
            sum += pair.gap_begin[k].sum() + pair.gap_end[k].sum();
        }
    }
    bool is_finite() const { return std::isfinite(sum); }  // a minimum may drop a NaN, a sum does not
    /// Whether the swept boxes are disjoint. Exact, because the sign of a difference is exact.
    bool is_apart() const { return (low.array() > 0.0).any() || (high.array() < 0.0).any(); }
    double size() const { return low.cwiseAbs().cwiseMax(high.cwiseAbs()).sum(); }
};

Plane make_plane(const Pair& pair, const Vec3& normal, double time, double margin)
{
    Plane plane{normal, std::numeric_limits<double>::infinity(), kNever};
    for (int k = 0; k < pair.gaps; ++k) {
        const double begin = normal.dot(pair.gap_begin[k]);
        const double end = normal.dot(pair.gap_end[k]);
        plane.separation = std::min(plane.separation, begin + time * (end - begin));
        if (end <= margin && begin > end)
            plane.until =
                std::min(plane.until, (begin - margin) / (begin - end) * (1.0 - 0.25 * kProductRounding));
    }
    if (!(plane.separation > margin)) plane.until = time;
    return plane;
}

/// The best certificate among the directions offered: the plane that holds longest, and the largest
/// separation.
struct Search {
    const Pair& pair;
    double time, margin;
    Plane longest = Plane();
    double separation = -std::numeric_limits<double>::infinity();
    Vec3 widest = Vec3::Zero();  ///< direction of `separation`

    /// `direction` may have any length; it is made orthogonal to `side` if that is given.
    void offer(const Vec3& direction, const Vec3* side = nullptr)
    {
        if (longest.until >= kNever) return;
        const double length = direction.norm();
        if (!(length > 0.0)) return;
        Vec3 normal = direction / length;
        // Project twice: the first projection may leave a short vector, whose component along the side is
        // inexact.
        for (int pass = 0; side && pass < 2; ++pass) {
            const double square = side->squaredNorm();
            if (square > 0.0) normal -= normal.dot(*side) / square * *side;
            const double rest = normal.norm();
            if (!(rest > 0.0)) return;
            normal /= rest;
        }
        const Plane plane = make_plane(pair, normal, time, margin);
        if (plane.until > longest.until || longest.normal.isZero(0.0)) longest = plane;
        if (plane.separation > separation) {
            separation = plane.separation;
            widest = normal;
        }
    }

    void offer_facing(const Vec3& direction, const Vec3& gap, const Vec3& side)
    {
        offer(direction.dot(gap) < 0.0 ? Vec3(-direction) : direction, &side);
    }
};

/// Offers the direction between the closest points, for each case: interiors, sides and corners.
void offer_directions(const Pair& pair, double time, Search& search)
{
    std::array<Vec3, 4> gap;
    std::array<Vec3, 3> side;
    const int sides = pair.gaps == 3 ? 3 : 2;
    for (int k = 0; k < pair.gaps; ++k) gap[k] = at(pair.gap_begin[k], pair.gap_end[k], time);
    for (int k = 0; k < sides; ++k) side[k] = at(pair.side_begin[k], pair.side_end[k], time);

    search.offer_facing(side[0].cross(side[1]), gap[0], side[0]);
    if (pair.gaps == 3) {
        for (int k = 0; k < 3; ++k) search.offer(gap[k], &side[k]);
    } else {  // gaps (0, 0), (0, 1), (1, 0), (1, 1): ends of the cloth's segment side[0] and of the
              // obstacle's side[1]
        search.offer(gap[0], &side[1]);
        search.offer(gap[2], &side[1]);
        search.offer(gap[0], &side[0]);
        search.offer(gap[1], &side[0]);
    }
    for (int k = 0; k < pair.gaps; ++k) search.offer(gap[k]);
}

/// Six times the signed volume of the four points during a step: a cubic in time, as Bernstein coefficients.
struct Volume {
    std::array<double, 4> coefficients;
    double margin;  ///< rounding bound

    explicit Volume(const Pair& pair)
    {
        const std::array<const Vec3*, 2> w{&pair.gap_begin[0], &pair.gap_end[0]};
        const std::array<const Vec3*, 2> a{&pair.side_begin[0], &pair.side_end[0]};
        const std::array<const Vec3*, 2> b{&pair.side_begin[1], &pair.side_end[1]};
        coefficients.fill(0.0);
        for (int j = 0; j < 2; ++j) {
            for (int k = 0; k < 2; ++k) {
                const Vec3 cross = a[j]->cross(*b[k]);
                for (int i = 0; i < 2; ++i) coefficients[i + j + k] += w[i]->dot(cross);
            }
        }
        coefficients[1] /= 3.0;
        coefficients[2] /= 3.0;
        const auto size = [](const std::array<const Vec3*, 2>& v) {
            return std::max(v[0]->lpNorm<1>(), v[1]->lpNorm<1>());
        };
        margin = kVolumeRounding * size(w) * size(a) * size(b);
    }
};

struct Halves {
    std::array<double, 4> left, right;
};

Halves split(const std::array<double, 4>& c, double at)
{
    const auto mix = [at](double p, double q) { return p + at * (q - p); };
    const double c01 = mix(c[0], c[1]), c12 = mix(c[1], c[2]), c23 = mix(c[2], c[3]);
    const double c012 = mix(c01, c12), c123 = mix(c12, c23);
    const double middle = mix(c012, c123);
    return {{c[0], c01, c012, middle}, {middle, c123, c23, c[3]}};
}

double value(const std::array<double, 4>& c, double x)
{
    const double y = 1.0 - x;
    return ((c[0] * y + 3.0 * c[1] * x) * y + 3.0 * c[2] * x * x) * y + c[3] * x * x * x;
}

/// As first_root, by Newton's method, for a cubic that is monotonic. Returns nothing where the result is not
/// certain.
std::optional<double> only_root(const std::array<double, 4>& c, double margin)
{
    const std::array<double, 3> slope{3.0 * (c[1] - c[0]), 3.0 * (c[2] - c[1]), 3.0 * (c[3] - c[2])};
    const bool rises = slope[0] > 0.0 && slope[1] > 0.0 && slope[2] > 0.0;
    const bool falls = slope[0] < 0.0 && slope[1] < 0.0 && slope[2] < 0.0;
    if (!rises && !falls) return std::nullopt;
    constexpr int kSteps = 8;
    double x = 0.0, tangent = slope[0];
    for (int step = 0; step < kSteps; ++step) {
        const double before = x;
        x = std::clamp(x - value(c, x) / tangent, 0.0, 1.0);
        const double y = 1.0 - x;
        tangent = slope[0] * y * y + 2.0 * slope[1] * x * y + slope[2] * x * x;
        if (std::abs(x - before) < kComputed) break;
    }
    // The cubic is monotonic: a value with the sign of the start has no root before it.
    x -= kComputed + 2.0 * margin / std::abs(tangent);
    const double here = value(c, x);
    if (!(x > 0.0) || !(rises ? here < -margin : here > margin)) return std::nullopt;
    return x;
}

/// A lower bound on the cubic's first root between `low` and `high`, within kComputed of where the cubic
/// comes within `margin` of zero; kNever where there is none.
double first_root(const std::array<double, 4>& c, double margin, double low, double high)
{
    const auto [least, greatest] = std::minmax_element(c.begin(), c.end());
    if (*least > margin || *greatest < -margin) return kNever;
    if (high - low < kComputed || std::abs(c[0]) <= margin) return low;
    if (const std::optional<double> root = only_root(c, margin)) return low + *root * (high - low);
    const Halves halves = split(c, 0.5);
    const double middle = 0.5 * (low + high);
    const double root = first_root(halves.left, margin, low, middle);
    return root < kNever ? root : first_root(halves.right, margin, middle, high);
}

double next_coplanar(const Volume& volume, double from)
{
    return first_root(split(volume.coefficients, from).right, volume.margin, from, 1.0);
}

Search search_at(const Pair& pair, double time, double margin)
{
    Search search{pair, time, margin};
    offer_directions(pair, time, search);
    return search;
}

/// Gap that counts as a touch: at most half of the gap at begin. A pair that begins nearer than `distance`
/// has met nothing yet, so it may move on or apart.
double touching_gap(const Pair& pair, double distance, const Vec3& normal, double margin)
{
    double begin = make_plane(pair, normal, 0.0, margin).separation;  // a lower bound, as along one direction
                                                                      // only
    if (begin < 2.0 * distance) begin = search_at(pair, 0.0, margin).separation;
    return std::max(std::min(distance, 0.5 * begin), 4.0 * margin);
}

std::optional<Touch> first_touch(const Pair& pair, double distance)
{
    assert(distance > 0.0);
    const Extent extent(pair);
    if (!extent.is_finite()) return Touch{0.0, Vec3::Zero()};
    if (extent.is_apart()) return std::nullopt;
    const double margin = kProductRounding * extent.size();

    const Volume volume(pair);
    double time = next_coplanar(volume, 0.0);
    Vec3 normal = Vec3::Zero();
    for (int round = 0; round < kMaxRounds && time < kNever; ++round) {
        const Search search = search_at(pair, time, margin);
        if (search.longest.until >= kNever) return std::nullopt;
        if (search.separation > margin || round == 0) normal = search.widest;
        const bool is_near = !(search.separation > distance);
        if (is_near && !(search.separation > touching_gap(pair, distance, normal, margin)))
            return Touch{time, normal};
        if (!(search.longest.until > time)) return Touch{time, normal};
        time = next_coplanar(volume, std::min(search.longest.until, 1.0));
    }
    if (time >= kNever) return std::nullopt;
    return Touch{time, normal};
}

/// Barycentric weights of the triangle's point closest to the origin.
std::array<double, 3> weights_of_least(const std::array<Vec3, 3>& corners)
{
    const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).stableNormalized();
    return closest_on_triangle(Vec3::Zero(), corners, normal).weights;
}

std::array<Vec3, 3> gaps_at(const Pair& pair, double time)
{
    std::array<Vec3, 3> gaps;
    for (int k = 0; k < 3; ++k) gaps[k] = at(pair.gap_begin[k], pair.gap_end[k], time);
    return gaps;
}

}  // namespace

std::optional<ClothSweepHit> sweep_cloth_vertex_face(const std::array<Vec3, 4>& begin,
                                                     const std::array<Vec3, 4>& end, double distance)
{
    Pair pair;
    pair.gaps = 3;
    for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        pair.gap_begin[k] = begin[0] - begin[1 + k];
        pair.gap_end[k] = end[0] - end[1 + k];
        pair.side_begin[k] = begin[1 + next] - begin[1 + k];
        pair.side_end[k] = end[1 + next] - end[1 + k];
    }
    const std::optional<Touch> touch = first_touch(pair, distance);
    if (!touch) return std::nullopt;
    const std::array<double, 3> w = weights_of_least(gaps_at(pair, touch->time));
    return ClothSweepHit{touch->time, {1.0, -w[0], -w[1], -w[2]}, touch->normal};
}

std::optional<ClothSweepHit> sweep_cloth_edges(const std::array<Vec3, 4>& begin,
                                               const std::array<Vec3, 4>& end, double distance)
{
    Pair pair;
    pair.gaps = 4;
    for (int k = 0; k < 4; ++k) {
        pair.gap_begin[k] = begin[k / 2] - begin[2 + k % 2];
        pair.gap_end[k] = end[k / 2] - end[2 + k % 2];
    }
    for (int k = 0; k < 2; ++k) {
        pair.side_begin[k] = begin[2 * k + 1] - begin[2 * k];
        pair.side_end[k] = end[2 * k + 1] - end[2 * k];
    }
    const std::optional<Touch> touch = first_touch(pair, distance);
    if (!touch) return std::nullopt;
    // Relative to the second element's first point, so that no digits are lost far from the origin.
    const Vec3 start = at(pair.gap_begin[0], pair.gap_end[0], touch->time);
    const Vec3 first = at(pair.side_begin[0], pair.side_end[0], touch->time);
    const Vec3 second = at(pair.side_begin[1], pair.side_end[1], touch->time);
    const SegmentPair closest = closest_between_segments({start, start + first}, {Vec3::Zero(), second});
    return ClothSweepHit{
        touch->time, {1.0 - closest.s, closest.s, closest.t - 1.0, -closest.t}, touch->normal};
}

std::optional<SweepHit> sweep_vertex_face(const Vec3& begin, const Vec3& end,
                                          const std::array<Vec3, 3>& triangle_begin,
                                          const std::array<Vec3, 3>& triangle_end, double distance)
{
    const auto& [p, q, r] = triangle_begin;
    const auto& [a, b, c] = triangle_end;
    const std::optional<ClothSweepHit> hit =
        sweep_cloth_vertex_face({begin, p, q, r}, {end, a, b, c}, distance);
    if (!hit) return std::nullopt;
    const std::array<double, 4>& w = hit->weights;
    const Vec3 point = a - w[2] * (b - a) - w[3] * (c - a);
    return SweepHit{hit->time, {1.0, 0.0, 0.0}, {-w[1], -w[2], -w[3]}, point, hit->normal};
}

std::optional<SweepHit> sweep_edge_edge(const std::array<Vec3, 2>& begin, const std::array<Vec3, 2>& end,
                                        const std::array<Vec3, 2>& segment_begin,
                                        const std::array<Vec3, 2>& segment_end, double distance)
{
    const auto& [p, q] = segment_begin;
    const auto& [a, b] = segment_end;
    const std::optional<ClothSweepHit> hit =
        sweep_cloth_edges({begin[0], begin[1], p, q}, {end[0], end[1], a, b}, distance);
    if (!hit) return std::nullopt;
    const std::array<double, 4>& w = hit->weights;
    return SweepHit{hit->time, {w[0], w[1], 0.0}, {-w[2], -w[3], 0.0}, at(a, b, -w[3]), hit->normal};
}

std::optional<SweepHit> sweep_face_point(const std::array<Vec3, 3>& begin, const std::array<Vec3, 3>& end,
                                         const Vec3& point_begin, const Vec3& point_end, double distance)
{
    Pair pair;
    pair.gaps = 3;
    for (int k = 0; k < 3; ++k) {
        pair.gap_begin[k] = begin[k] - point_begin;
        pair.gap_end[k] = end[k] - point_end;
        pair.side_begin[k] = begin[(k + 1) % 3] - begin[k];
        pair.side_end[k] = end[(k + 1) % 3] - end[k];
    }
    const std::optional<Touch> touch = first_touch(pair, distance);
    if (!touch) return std::nullopt;

    return SweepHit{
        touch->time, weights_of_least(gaps_at(pair, touch->time)), {1.0, 0.0, 0.0}, point_end, touch->normal};
}

}  // namespace arris
