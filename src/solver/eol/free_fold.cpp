// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/eol/free_fold.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/tolerances.h"
#include "solver/model/hysteresis.h"

namespace arris {

namespace {

Vec3 across(const FeatureFrame& frame, const Vec3& place)
{
    const Vec3 way = place - frame.point;
    return way - frame.tangent.dot(way) * frame.tangent;
}

/// Direction along face k of the edge, leading beyond the edge.
Vec3 find_onward(const FeatureEdge& edge, int k, const Vec3& tangent)
{
    const Vec3 along = edge.normals[k].cross(tangent);
    return along.dot(edge.normals[1 - k]) < 0.0 ? Vec3(-along) : along;
}

/// Degree in [0, 1] to which the cloth arrives along a face: 1 up to 14 degrees, 0 beyond 20. Reduced for
/// slow flow: without flow no cloth arrives.
double share_of(const ArrivingCloth& arriving, const Vec3& onward)
{
    const double none = std::cos(20.0 * M_PI / 180.0), all = std::cos(14.0 * M_PI / 180.0);
    const double along = std::clamp((-onward.dot(arriving.direction) - none) / (all - none), 0.0, 1.0);
    return along * std::min(arriving.flow / kFreeFlow, 1.0);
}

Vec3 turned(const Vec3& from, const Vec3& to, double share)
{
    return ((1.0 - share) * from + share * to).normalized();
}

/// The direction nearest to `outward` that leads into neither face; `between` where none exists. A fold that
/// returns over one face thus moves down onto that face: along the bisector, its bound would hold it above.
Vec3 turned_between(const FeatureEdge& edge, const Vec3& outward, const Vec3& between)
{
    Vec3 nearest = outward;
    for (const Vec3& normal : edge.normals)
        if (const double into = normal.dot(nearest); into < 0.0) nearest -= into * normal;
    nearest = nearest.stableNormalized();
    for (const Vec3& normal : edge.normals)
        if (!(normal.dot(nearest) >= -kAccumulated)) return between;
    return nearest.isZero(0.0) ? between : nearest;
}

}  // namespace

bool has_left_feature(const Vec3& nearest, const Vec3& place, double thickness)
{
    // Farther off than any mitre and the chatter on it.
    return (place - nearest).norm() > kOnFeature / kStayRatio * thickness;
}

FeatureFrame turn_to_free_fold(const FeatureEdge& edge, const ArrivingCloth& arriving, const Vec3& place,
                               double thickness, const FeatureFrame& frame)
{
    constexpr double kOver = 0.5;  // stand-offs, over which outward turns: vertices chatter
    const double stand_off = frame.mitre * thickness;
    const Vec3 off = across(frame, place);
    const double share = std::clamp((frame.outward.dot(off) / stand_off - 1.0) / kOver, 0.0, 1.0);
    if (!(share > 0.0)) return frame;

    // Away from the place where the edge holds the vertex, to which it can then return.
    Vec3 outward = (off - stand_off * frame.outward).stableNormalized();
    outward = turned_between(edge, outward, frame.outward);
    const std::array<Vec3, 2> onward = {find_onward(edge, 0, frame.tangent),
                                        find_onward(edge, 1, frame.tangent)};
    const std::array<double, 2> shares = {share_of(arriving, onward[0]), share_of(arriving, onward[1])};
    const Vec3 along = shares[0] * onward[0] + shares[1] * onward[1];  // at a thin edge, along both
    outward = turned(outward, along.stableNormalized(), std::max(shares[0], shares[1]));

    FeatureFrame free = frame;
    free.outward = turned(frame.outward, outward, share);
    free.mitre = frame.mitre * frame.outward.dot(free.outward);
    return free;
}

}  // namespace arris
