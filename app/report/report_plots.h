// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/report/svg_plot.h"

namespace arris {

/// The plots of steps.csv that have something to say: energies, seconds by phase, contacts, residuals, step
/// length, and mesh size, angles and penetration where they change. `tolerance` is drawn beside the
/// residuals.
std::vector<Plot> plot_steps(const std::string& steps_csv, std::optional<double> tolerance);

/// Position over time, a plot for each probe in probes.csv, at most `max_probes`.
struct ProbePlots {
    std::vector<Plot> plots;
    std::size_t left_out = 0;  ///< probes beyond `max_probes`
};
ProbePlots plot_probes(const std::string& probes_csv, std::size_t max_probes);

}  // namespace arris
