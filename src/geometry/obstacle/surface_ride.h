// SPDX-License-Identifier: GPL-3.0-or-later
// Things that ride on the surface of an obstacle that deforms. What is near a place of the surface moves with
// it like a rigid body: with the place, and turning as the surface turns there.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "geometry/obstacle/obstacle.h"
#include "geometry/rigid_motion.h"

namespace arris {

enum class SurfaceKind { Triangle, Edge, Point };

/// A place in the interior of a face or an edge, or at a point, which is the same material in each pose.
struct SurfacePlace {
    SurfaceKind kind = SurfaceKind::Point;
    int element = -1;                                 ///< face, edge of the topology, or point of the mesh
    std::array<int, 3> points = {-1, -1, -1};         ///< of the element; -1 where there are fewer
    std::array<double, 3> weights = {0.0, 0.0, 0.0};  ///< >= 0, sum 1

    Vec3 at(const std::vector<Vec3>& field) const
    {
        Vec3 sum = Vec3::Zero();
        for (int i = 0; i < 3 && points[i] >= 0; ++i) sum += weights[i] * field[points[i]];
        return sum;
    }
};

/// The place of the obstacle's surface, wires and lone points that is nearest to `place` (in the obstacle's
/// frame). Returns nothing where nothing is nearer than `most`, m.
std::optional<SurfacePlace> find_nearest(const Obstacle& obstacle, const Vec3& place,
                                         double most = std::numeric_limits<double>::infinity());

/// The way from one pose to another of what rides at a place. A face turns with its normal and its first
/// side; an edge with itself and halfway between its faces; a wire by the least rotation; a point with what
/// meets there, in the mean.
Placement find_way(const Obstacle& from, const Obstacle& to, const SurfacePlace& on);

/// Velocity, m/s, of what rides at a place of the surface and is at `place`. `velocities`: of the pose's
/// points, m/s.
Vec3 riding_velocity(const Obstacle& pose, const std::vector<Vec3>& velocities, const SurfacePlace& on,
                     const Vec3& place);

/// Greatest distance, m, of a point from its other place.
double longest_way(const std::vector<Vec3>& begin, const std::vector<Vec3>& end);

}  // namespace arris
