// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastica.h"

#include <Eigen/Core>
#include <cmath>

#include "ode.h"

namespace arris {

namespace {

using Vec4 = Eigen::Vector4d;  // theta, theta', x, y

Vec4 shoot(const ElasticaLoad& load, double curvature)
{
    const auto slope = [&](double s, const Vec4& at) -> Vec4 {
        const double force = load.weight * (1.0 - s) + load.tip;
        const double stretch = 1.0 + load.extensibility * force * std::sin(at[0]);
        return {at[1], -stretch * force * std::cos(at[0]), stretch * std::cos(at[0]),
                stretch * std::sin(at[0])};
    };
    constexpr int kSteps = 1000;  // RK4's error is then below 1e-10
    return integrate_rk4(Vec4(0.0, curvature, 0.0, 0.0), 0.0, 1.0, kSteps, slope);
}

/// The curvature at the clamp, near `guess`, for which the moment at the tip is zero.
double find_curvature(const ElasticaLoad& load, double guess)
{
    constexpr double kOffset = 1e-4, kExact = 1e-13;
    constexpr int kMostIterations = 50;
    double before = guess, at = guess + kOffset;
    double moment_before = shoot(load, before)[1], moment = shoot(load, at)[1];
    for (int k = 0; k < kMostIterations && std::abs(moment) > kExact && at != before; ++k) {
        const double next = at - moment * (at - before) / (moment - moment_before);
        before = at;
        moment_before = moment;
        at = next;
        moment = shoot(load, at)[1];
    }
    return at;
}

}  // namespace

ElasticaTip solve_elastica(const ElasticaLoad& load)
{
    // The curvature at the clamp by secants, continued from zero load: this stays on the branch of the
    // straight strip.
    const int stages = 1 + static_cast<int>(std::ceil(0.25 * (load.weight + load.tip)));
    double curvature = 0.0;
    for (int k = 1; k <= stages; ++k) {
        const double share = static_cast<double>(k) / stages;
        const ElasticaLoad part{share * load.weight, share * load.tip, load.extensibility};
        curvature = find_curvature(part, curvature);
    }
    const Vec4 tip = shoot(load, curvature);
    return {tip[2], tip[3], tip[0]};
}

double find_elastica_weight(double tip_ratio, double extensibility)
{
    constexpr double kExact = 1e-12;  // tolerance of the ratio y / x
    constexpr int kMostIterations = 50;
    const auto excess = [&](double weight) {
        const ElasticaTip tip = solve_elastica({weight, 0.0, extensibility});
        return tip.y / tip.x - tip_ratio;
    };
    // Secants start at the weight of linear theory, y / x = G / 8.
    double before = 8.0 * tip_ratio, at = 1.01 * before;
    double excess_before = excess(before), excess_at = excess(at);
    for (int k = 0; k < kMostIterations && std::abs(excess_at) > kExact * tip_ratio && at != before; ++k) {
        const double next = at - excess_at * (at - before) / (excess_at - excess_before);
        before = at;
        excess_before = excess_at;
        at = next;
        excess_at = excess(at);
    }
    return at;
}

}  // namespace arris
