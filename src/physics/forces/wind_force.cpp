// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/forces/wind_force.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace arris {

WindForce::WindForce(const Wind& wind) : wind_(wind)
{
    if (!wind.gust) return;
    // mt19937_64 is specified to the bit, so a seed means the same gust everywhere.
    const std::uint64_t draw = std::mt19937_64(static_cast<std::uint64_t>(wind.gust->seed))();
    gust_phase_ = 2.0 * std::numbers::pi * std::ldexp(static_cast<double>(draw >> 11), -53);
}

Vec3 WindForce::velocity_at(double time) const
{
    if (!wind_.gust) return wind_.velocity;
    const double angle = 2.0 * std::numbers::pi * wind_.gust->frequency * time + gust_phase_;
    return wind_.velocity * (1.0 + wind_.gust->amplitude * std::sin(angle));
}

void WindForce::add(const FaceState& face, FaceSystem& system) const
{
    const Vec3 doubled = (face.x[1] - face.x[0]).cross(face.x[2] - face.x[0]);
    const double twice_world_area = doubled.norm();
    if (!(twice_world_area > 0.0)) return;  // no wind acts on a face without area
    const Vec3 n = doubled / twice_world_area;

    const Vec3 material = (system.v_last(0) + system.v_last(1) + system.v_last(2)) / 3.0;
    const double w_n = n.dot(velocity_at(system.time()) - material);
    const double pressure_per_speed =
        0.5 * wind_.air_density * wind_.drag * 0.5 * twice_world_area * std::abs(w_n);
    const Mat3 viscosity = 2.0 * pressure_per_speed / 9.0 * n * n.transpose();
    for (int i = 0; i < 3; ++i) {
        system.add_force(i, pressure_per_speed / 3.0 * w_n * n);
        for (int j = 0; j <= i; ++j) system.add_viscosity(i, j, viscosity);
    }
}

}  // namespace arris
