// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/eol/wire_fold.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/closest_point.h"
#include "solver/model/eol_limits.h"

namespace arris {

namespace {

// rad. Cloth that hangs straight down loses 1e-5 of its height, and passes the wire at 5e-3 stand-offs.
constexpr double kLeastAngle = 5e-3;

/// Whether a way leads across a wire with this tangent. Edges along a fold do not, however near the wire the
/// fold's next vertex is: they are on no side of the fold.
bool leads_across(const Vec3& tangent, const Vec3& way)
{
    constexpr double kLeast = 0.17;  // sine of 10 degrees
    return tangent.cross(way).norm() > kLeast * tangent.norm() * way.norm();
}

}  // namespace

bool is_folded_around(const std::array<Vec3, 2>& segment, const Vec3& place, const Vec3& other,
                      const std::vector<Vec3>& around, double reach)
{
    constexpr double kNearer =
        1e-6;  // of the vertex's distance; edges along the fold are as far as the vertex
    const SegmentPair at = closest_between_segments({place, place}, segment);
    const Vec3 from = at.first - at.second, tangent = segment[1] - segment[0];
    // The side on which an edge from the vertex passes the segment, 1 or -1; 0 where it does not.
    const auto side_of = [&](const Vec3& end) {
        const SegmentPair nearest = closest_between_segments({place, end}, segment);
        const double gap = (nearest.first - nearest.second).norm();
        if (!leads_across(tangent, end - place)) return 0;
        if (!(gap < (1.0 - kNearer) * from.norm() && gap <= reach)) return 0;
        return tangent.dot((end - place).cross(from)) > 0.0 ? 1 : -1;
    };
    const int side = side_of(other);
    return side != 0 &&
           std::any_of(around.begin(), around.end(), [&](const Vec3& end) { return side_of(end) == -side; });
}

bool is_folded_beside(const std::array<Vec3, 2>& segment, const Vec3& place, const std::vector<Vec3>& around)
{
    const SegmentPair at = closest_between_segments({place, place}, segment);
    const Vec3 tangent = segment[1] - segment[0];
    const Vec3 normal = tangent.cross(at.second - at.first);
    bool is_before = false, is_behind = false;
    for (const Vec3& end : around) {
        if (!leads_across(tangent, end - place)) continue;
        (normal.dot(end - place) > 0.0 ? is_before : is_behind) = true;
    }
    return is_before != is_behind;
}

double angle_behind(const FeatureFrame& frame, const Vec3& place)
{
    const Vec3 from = place - frame.point;
    return std::atan2(frame.outward.cross(frame.tangent).dot(from), -frame.outward.dot(from));
}

Vec3 turn_outward(const FeatureFrame& wanted, const Vec3& place, const std::vector<Vec3>& beside, double dt)
{
    constexpr double kRoundOff = 1e-13;
    const Vec3& t = wanted.tangent;
    const Vec3 from = place - wanted.point - t.dot(place - wanted.point) * t;
    if (!(from.norm() > kRoundOff * place.norm())) return wanted.outward;
    const Vec3 outward = from.normalized();
    double turn =
        kTurnPerStep * std::atan2(t.dot(outward.cross(wanted.outward)), outward.dot(wanted.outward));
    turn = std::clamp(turn, -kMendingSpeed * dt / from.norm(), kMendingSpeed * dt / from.norm());
    for (const Vec3& neighbour : beside) {
        const double angle = angle_behind({wanted.point, t, outward, 1.0}, neighbour);
        const double room = kTurnPerStep * std::max(std::abs(angle) - kLeastAngle, 0.0);
        turn = angle > 0.0 ? std::min(turn, room) : std::max(turn, -room);
    }
    return Eigen::AngleAxisd(turn, t) * outward;
}

FoldPlaneBound find_fold_plane_bound(const FeatureFrame& frame, const Vec3& place, int side)
{
    const Vec3 from = place - frame.point, normal = side * frame.outward.cross(frame.tangent);
    const double wanted = std::max(-kLeastAngle * frame.outward.dot(from), 0.0);
    return {normal, std::min(normal.dot(from), wanted), wanted};
}

}  // namespace arris
