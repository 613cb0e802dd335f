// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/scene.h"

#include <algorithm>
#include <cmath>

namespace arris {

std::vector<double> input_jumps(const Scene& scene)
{
    std::vector<double> times;
    for (const Pin& pin : scene.pins) {
        const std::vector<double> jumps = pin.motion.jumps();
        times.insert(times.end(), jumps.begin(), jumps.end());
        times.push_back(pin.release);
    }
    for (const Pull& pull : scene.pulls) times.insert(times.end(), {pull.start, pull.stop});

    std::erase_if(times, [](double t) { return !(t > 0.0) || !std::isfinite(t); });
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

}  // namespace arris
