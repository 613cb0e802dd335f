// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/rigid_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/input_error.h"

namespace arris {
namespace {

// Rodrigues: R = cos I + sin [k]_x + (1 - cos) k k^T for a unit axis k.
Mat3 rodrigues(const Vec3& k, double cosine, double sine)
{
    Mat3 cross;
    cross << 0.0, -k.z(), k.y(),  //
        k.z(), 0.0, -k.x(),       //
        -k.y(), k.x(), 0.0;
    return cosine * Mat3::Identity() + sine * cross + (1.0 - cosine) * (k * k.transpose());
}

Mat3 rotation_by_vector(const Vec3& rotation)
{
    const double angle = rotation.stableNorm();
    if (!(angle > 0.0)) return Mat3::Identity();
    return rodrigues(rotation / angle, std::cos(angle), std::sin(angle));
}

Placement placement_of(const Keyframe& key)
{
    return {key.rotate.normalized().toRotationMatrix(), key.translate};
}

Placement between(const Keyframe& from, const Keyframe& to, double time)
{
    const double s = (time - from.time) / (to.time - from.time);
    // Eigen's slerp takes the shorter arc.
    const Eigen::Quaterniond rotation = from.rotate.normalized().slerp(s, to.rotate.normalized());
    return {rotation.toRotationMatrix(), from.translate + s * (to.translate - from.translate)};
}

Placement at_keyframes(const std::vector<Keyframe>& keys, double time)
{
    const auto later = std::upper_bound(keys.begin(), keys.end(), time,
                                        [](double t, const Keyframe& key) { return t < key.time; });
    if (later == keys.begin()) return placement_of(keys.front());
    if (later == keys.end()) return placement_of(keys.back());
    return between(*(later - 1), *later, time);
}

Vec3 velocity_at_keyframes(const std::vector<Keyframe>& keys, double time, const Vec3& place)
{
    const auto later = std::upper_bound(keys.begin(), keys.end(), time,
                                        [](double t, const Keyframe& key) { return t < key.time; });
    if (later == keys.begin() || later == keys.end()) return Vec3::Zero();
    const Keyframe &from = *(later - 1), &to = *later;
    Eigen::Quaterniond turn = to.rotate.normalized() * from.rotate.normalized().conjugate();
    if (turn.w() < 0.0) turn.coeffs() *= -1.0;  // the shorter arc
    const Eigen::AngleAxisd turned(turn);
    const Vec3 angular = turned.axis() * turned.angle();
    const Vec3 origin = between(from, to, time).translation;
    return (to.translate - from.translate + angular.cross(place - origin)) / (to.time - from.time);
}

// q and -q are one rotation.
bool same_pose(const Keyframe& k, const Keyframe& l)
{
    return k.translate == l.translate &&
           (k.rotate.coeffs() == l.rotate.coeffs() || k.rotate.coeffs() == -l.rotate.coeffs());
}

}  // namespace

Mat3 rotation_about(const Vec3& axis, double degrees)
{
    const double largest = axis.cwiseAbs().maxCoeff();
    if (!std::isfinite(degrees) || !axis.allFinite() || !(largest > 0.0))
        throw InputError(
            fmt::format("rotation about ({}, {}, {}) by {} degrees: the axis must have a length, "
                        "and all must be finite",
                        axis.x(), axis.y(), axis.z(), degrees));
    // Whole quarter turns are taken off first, exactly, so that multiples of 90 degrees have no round-off.
    const double turned = std::remainder(degrees, 360.0);
    const double quarters = std::round(turned / 90.0);
    const double rest = (turned - 90.0 * quarters) * std::numbers::pi / 180.0;
    const double c = std::cos(rest);
    const double s = std::sin(rest);
    const Vec3 k = (axis / largest).normalized();  // exact along the coordinate axes
    switch (static_cast<int>(quarters) & 3) {
        case 0:
            return rodrigues(k, c, s);
        case 1:
            return rodrigues(k, -s, c);
        case 2:
            return rodrigues(k, -c, -s);
        default:
            return rodrigues(k, s, -c);
    }
}

Placement RigidMotion::at(double time) const
{
    if (!keyframes.empty()) return at_keyframes(keyframes, time);
    const double tau = std::clamp(time - start, 0.0, std::max(stop - start, 0.0));
    const Mat3 rotation = rotation_by_vector(angular_velocity * tau);
    return {rotation, pivot - rotation * pivot + velocity * tau};
}

Vec3 RigidMotion::velocity_after(double time, const Vec3& place) const
{
    if (!keyframes.empty()) return velocity_at_keyframes(keyframes, time, place);
    if (time < start || !(time < stop)) return Vec3::Zero();
    return velocity + angular_velocity.cross(place - pivot - velocity * (time - start));
}

bool RigidMotion::is_moving() const
{
    if (!keyframes.empty())
        return std::any_of(keyframes.begin(), keyframes.end(),
                           [&](const Keyframe& key) { return !same_pose(key, keyframes.front()); });
    const double fastest = std::max(velocity.cwiseAbs().maxCoeff(), angular_velocity.cwiseAbs().maxCoeff());
    return fastest > 0.0 && stop > start;
}

double RigidMotion::fastest_turn() const
{
    if (keyframes.empty()) return stop > start ? angular_velocity.stableNorm() : 0.0;
    double fastest = 0.0;
    for (std::size_t k = 1; k < keyframes.size(); ++k) {
        const double turn =
            keyframes[k - 1].rotate.normalized().angularDistance(keyframes[k].rotate.normalized());
        fastest = std::max(fastest, turn / (keyframes[k].time - keyframes[k - 1].time));
    }
    return fastest;
}

std::vector<double> RigidMotion::jumps() const
{
    std::vector<double> times;
    if (!is_moving()) return times;
    if (keyframes.empty()) {
        times = {start, stop};
    } else {
        for (const Keyframe& key : keyframes) times.push_back(key.time);
    }
    std::erase_if(times, [](double t) { return !(t > 0.0) || !std::isfinite(t); });
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

}  // namespace arris
