// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// p -> rotation p + translation.
struct Placement {
    Mat3 rotation = Mat3::Identity();
    Vec3 translation = Vec3::Zero();

    Vec3 operator()(const Vec3& p) const { return rotation * p + translation; }
    Vec3 inverse(const Vec3& p) const { return rotation.transpose() * (p - translation); }
    Placement inverse() const { return {rotation.transpose(), -(rotation.transpose() * translation)}; }
};

/// The placement that applies `first`, then `second`.
inline Placement operator*(const Placement& second, const Placement& first)
{
    return {second.rotation * first.rotation, second(first.translation)};
}

/// Converts world points to the frame that `placement` puts into the world.
inline std::vector<Vec3> to_local(const Placement& placement, const std::vector<Vec3>& world)
{
    std::vector<Vec3> points;
    points.reserve(world.size());
    for (const Vec3& x : world) points.push_back(placement.inverse(x));
    return points;
}

/// A rotation by `degrees` about `axis` (any length but zero).
Mat3 rotation_about(const Vec3& axis, double degrees);

struct Keyframe {
    double time = 0.0;  ///< s
    Vec3 translate = Vec3::Zero();
    Eigen::Quaterniond rotate = Eigen::Quaterniond::Identity();
};

/// Motion of a rigid body in time.
/// Without keyframes: p(t) = pivot + velocity tau + R(angular_velocity tau)(p(0) - pivot),
///     tau = clamp(t - start, 0, stop - start).
/// With keyframes: p(t) = translate(t) + R(t) p(0). Between keyframes the translation is linear and the
/// rotation is a slerp by the shorter arc. Outside the keyframes both are constant.
struct RigidMotion {
    Vec3 velocity = Vec3::Zero();          ///< m/s
    Vec3 angular_velocity = Vec3::Zero();  ///< rad/s
    Vec3 pivot = Vec3::Zero();             ///< m, world
    double start = 0.0;                    ///< s
    double stop = std::numeric_limits<double>::infinity();
    std::vector<Keyframe> keyframes;  ///< ascending in time

    /// Maps a point's place at time 0 (with keyframes: in the body's frame) to its place at `time`.
    Placement at(double time) const;

    /// Velocity (m/s) just after `time` of the body's point that is at `place` (world) at `time`.
    Vec3 velocity_after(double time, const Vec3& place) const;

    /// Whether the body moves at any time.
    bool is_moving() const;

    /// The greatest angular speed at any time, rad/s.
    double fastest_turn() const;

    /// Times after 0 at which the velocity jumps: start, stop, keyframes. Ascending.
    std::vector<double> jumps() const;
};

}  // namespace arris
