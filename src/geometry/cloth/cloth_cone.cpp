// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/cloth_cone.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>

#include "geometry/middle_direction.h"
#include "geometry/tolerances.h"

namespace arris {

namespace {

/// The direction in a sector's arc nearest to `to`.
Vec3 nearest_in(const FaceSector& sector, const Vec3& to)
{
    const Vec3& end = sector[0].dot(to) > sector[1].dot(to) ? sector[0] : sector[1];
    const Vec3 normal = sector[0].cross(sector[1]).stableNormalized();
    const Vec3 foot = (to - normal.dot(to) * normal).stableNormalized();
    const bool is_between =
        sector[0].cross(foot).dot(normal) > 0.0 && foot.cross(sector[1]).dot(normal) > 0.0;
    return is_between ? foot : end;
}

/// The part of `to` perpendicular to the sector's nearest direction; all of `to` if that is more than a right
/// angle away. Its length is the sine to the sector.
Vec3 away_from(const FaceSector& sector, const Vec3& to)
{
    const Vec3 nearest = nearest_in(sector, to);
    return to - std::max(nearest.dot(to), 0.0) * nearest;
}

double least_sine(const std::vector<FaceSector>& sectors, const Vec3& direction)
{
    double least = 1.0;
    for (const FaceSector& sector : sectors) least = std::min(least, sine_to_sector(sector, direction));
    return least;
}

}  // namespace

double sine_to_sector(const FaceSector& sector, const Vec3& direction)
{
    return away_from(sector, direction).norm();
}

Vec3 find_cone_axis(const std::vector<FaceSector>& sectors, const Vec3& inside)
{
    constexpr int kMostTurns = 20;
    constexpr double kGain = 1e-3;  // relative gain of room below which the iteration stops
    Vec3 axis = inside;
    double room = least_sine(sectors, axis);
    for (int turn = 0; turn < kMostTurns && room > kLevel; ++turn) {
        std::vector<Vec3> away;
        for (const FaceSector& sector : sectors) away.push_back(away_from(sector, axis).normalized());
        const std::optional<Vec3> next = find_middle(away);
        const double gained = next ? least_sine(sectors, *next) : 0.0;
        if (!(gained > (1.0 + kGain) * room)) break;
        axis = *next;
        room = gained;
    }
    return axis;
}

}  // namespace arris
