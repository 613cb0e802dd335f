// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/study/analysis.h"

namespace arris {

/// study.svg: error against CPU time, and against each varied number; in a study without an error, CPU time a
/// step against each varied number and the shares of the phases.
std::string draw_study(const Study& study, const std::vector<RunOutcome>& outcomes);

/// Exponents of the wall time a step of each phase by the cloth's vertices, for one curve.
struct PhaseExponent {
    std::string phase;
    std::optional<double> exponent;
};
std::vector<PhaseExponent> fit_phases(const std::vector<RunOutcome>& outcomes, const StudyCurve& curve);

}  // namespace arris
