// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/report/svg_plot.h"

namespace arris {

/// Plots of steps.csv: energies, seconds by phase, residuals, step length and factorisations; contacts and
/// penetration if any are positive; mesh size and angles if they change. `tolerance` is drawn with the
/// residuals.
std::vector<Plot> plot_steps(const std::string& steps_csv, std::optional<double> tolerance);

/// Plots of position over time, one per probe in probes.csv, at most `max_probes`.
struct ProbePlots {
    std::vector<Plot> plots;
    std::size_t left_out = 0;  ///< probes beyond `max_probes`
};
ProbePlots plot_probes(const std::string& probes_csv, std::size_t max_probes);

}  // namespace arris
