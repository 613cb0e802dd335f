// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/run_warnings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace arris {
namespace {

/// Obstacles that act on the cloth through contact alone: no pin follows them.
std::vector<std::string> names_to_touch(const Scene& scene)
{
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scene.obstacles.size(); ++i)
        if (std::none_of(scene.pins.begin(), scene.pins.end(),
                         [&](const Pin& pin) { return pin.follows && *pin.follows == static_cast<int>(i); }))
            names.push_back(scene.obstacles[i].name());
    return names;
}

}  // namespace

std::vector<std::string> warn_at_end(const RunConfig& config, const RunProgress& progress, RunStatus status)
{
    std::vector<std::string> lines = warn_of_strain(progress.strain, config);
    for (std::string& line : warn_of_friction(progress.friction)) lines.push_back(std::move(line));
    const std::vector<std::string> names = names_to_touch(config.scene);
    if (status == RunStatus::Finished && progress.touching_rows == 0 && !names.empty())
        lines.push_back(
            fmt::format("the cloth touched none of: {}; if it should have, check 'translate', 'up' and "
                        "'units' of the cloth "
                        "and of the {}, and the duration",
                        fmt::join(names, ", "), names.size() == 1 ? "obstacle" : "obstacles"));
    return lines;
}

}  // namespace arris
