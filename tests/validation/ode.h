// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>

namespace arris {

/// Classic fourth-order Runge-Kutta for y' = slope(t, y), in `steps` equal steps from `begin` to `end`; calls
/// visit(t, y) after each. Choose `steps` so large that doubling the number changes no digit that a test
/// compares.
template <typename Vector, typename Slope, typename Visit>
Vector integrate_rk4(Vector y, double begin, double end, int steps, const Slope& slope, const Visit& visit)
{
    const double h = (end - begin) / steps;
    for (int k = 0; k < steps; ++k) {
        const double t = begin + h * k;
        const Vector k1 = slope(t, y);
        const Vector k2 = slope(t + 0.5 * h, Vector(y + 0.5 * h * k1));
        const Vector k3 = slope(t + 0.5 * h, Vector(y + 0.5 * h * k2));
        const Vector k4 = slope(t + h, Vector(y + h * k3));
        y += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        visit(t + h, std::as_const(y));
    }
    return y;
}

template <typename Vector, typename Slope>
Vector integrate_rk4(const Vector& y, double begin, double end, int steps, const Slope& slope)
{
    return integrate_rk4(y, begin, end, steps, slope, [](double, const Vector&) {});
}

}  // namespace arris
