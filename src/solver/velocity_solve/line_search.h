// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

namespace arris {

/// Share of a step, at most 1, at which a convex energy along it is least: a zero of its `slope`, to a
/// twentieth of the slope at 0. False position, with bisections between.
template <class Slope>
double search_share(const Slope& slope)
{
    constexpr double kAccuracy = 0.05, kAside = 0.02;
    constexpr int kMostSteps = 30;
    const double at_start = slope(0.0), at_end = slope(1.0);
    if (!(at_start < 0.0) || !(at_end > -2.0 * kAccuracy * at_start)) return 1.0;
    double low = 0.0, high = 1.0, below = at_start, above = at_end;
    for (int k = 0; k < kMostSteps; ++k) {
        const double false_position = std::clamp(-below / (above - below), kAside, 1.0 - kAside);
        const double middle = low + (high - low) * (k % 3 == 2 ? 0.5 : false_position);
        const double here = slope(middle);
        if (std::abs(here) <= -kAccuracy * at_start) return middle;
        (here > 0.0 ? high : low) = middle;
        (here > 0.0 ? above : below) = here;
    }
    return low > 0.0 ? low : high;
}

}  // namespace arris
