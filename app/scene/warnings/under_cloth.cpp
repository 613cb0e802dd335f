// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/warnings/under_cloth.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace arris {
namespace {

/// Axes of a view along gravity: across, across, up.
Mat3 view_along(const Vec3& gravity)
{
    const Vec3 up = -gravity.normalized();
    // World axes where gravity is one: boxes around things then fit the scene's own boxes.
    const Vec3 first = std::abs(up.z()) > 0.5 ? Vec3::UnitX() : Vec3::UnitZ();
    Mat3 view;
    view.row(0) = (first - first.dot(up) * up).normalized();
    view.row(1) = up.cross(view.row(0).transpose());
    view.row(2) = up;
    return view;
}

Box3 box_of(const std::vector<Vec3>& points, const Mat3& view)
{
    Box3 box;
    for (const Vec3& x : points) box.extend(view * x);
    return box;
}

/// The steepest of the faces that the cloth can lie on, rad. Nearly upright faces are sides.
double find_steepest(const ObstacleMesh& mesh, const Mat3& rotation, const Vec3& up)
{
    constexpr double kSide = 85.0 * std::numbers::pi / 180.0;
    double steepest = 0.0;
    for (const auto& [a, b, c] : mesh.faces) {
        const Vec3 normal =
            (mesh.points[b] - mesh.points[a]).cross(mesh.points[c] - mesh.points[a]).stableNormalized();
        const Vec3 turned = rotation * normal;
        const double slope = std::atan2(turned.cross(up).norm(), turned.dot(up));
        if (slope < kSide) steepest = std::max(steepest, slope);
    }
    return steepest;
}

bool moves_along(const RigidMotion& motion, const Vec3& up, double duration)
{
    if (!motion.is_moving() ||
        !(motion.keyframes.empty() ? motion.start < duration : motion.keyframes.front().time < duration))
        return false;
    if (motion.fastest_turn() > 0.0) return true;
    const auto is_along = [&](const Vec3& way) { return up.cross(way).norm() > 1e-9 * way.norm(); };
    if (motion.keyframes.empty()) return is_along(motion.velocity);
    return std::any_of(motion.keyframes.begin(), motion.keyframes.end(), [&](const Keyframe& key) {
        return is_along(key.translate - motion.keyframes.front().translate);
    });
}

}  // namespace

std::vector<UnderCloth> find_under_cloth(const RunConfig& config)
{
    const Mat3 view = view_along(config.scene.gravity->acceleration);
    const Box3 cloth = box_of(config.cloth.world, view);
    std::vector<UnderCloth> found;
    for (const MovingObstacle& obstacle : config.scene.obstacles) {
        const ObstaclePose pose = obstacle.at(0.0);
        std::vector<Vec3> points;
        for (const Vec3& p : pose->mesh().points) points.push_back(pose.placement(p));
        const Box3 box = box_of(points, view);
        UnderCloth under;
        under.name = obstacle.name();
        under.up = view.row(2);
        under.width = std::numeric_limits<double>::infinity();
        bool is_under = box.max().z() <= cloth.max().z();
        int beyond = 0;  // directions
        for (int d = 0; d < 2; ++d) {
            const bool is_beyond_low = cloth.min()[d] < box.min()[d];
            const bool is_beyond_high = cloth.max()[d] > box.max()[d];
            is_under = is_under && cloth.min()[d] <= box.max()[d] && cloth.max()[d] >= box.min()[d];
            beyond += is_beyond_low || is_beyond_high;
            if (!(is_beyond_low && is_beyond_high)) continue;
            under.is_straddled = true;
            under.width = std::min(under.width, box.sizes()[d] / cloth.sizes()[d]);
        }
        under.is_overhung = beyond > 0;
        under.is_around_corner = beyond == 2;
        if (!is_under) continue;
        under.steepest = find_steepest(pose->mesh(), pose.placement.rotation, under.up);
        under.is_moving_along =
            obstacle.is_deforming() || moves_along(obstacle.motion(), under.up, config.duration);
        found.push_back(std::move(under));
    }
    return found;
}

}  // namespace arris
