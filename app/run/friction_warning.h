// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "solver/model/step_report.h"

namespace arris {

/// The step of a run so far whose friction differed most from Coulomb's law, and where. A resumed run
/// continues with that of its checkpoint.
struct FrictionPeak {
    double residual = 0.0;      ///< relative to the largest friction
    double time = 0.0;          ///< s
    Vec3 world = Vec3::Zero();  ///< m
    std::int64_t rows = 0;      ///< with a residual above the one that is worth a warning
};

/// Takes over the residual of the step that ended at `time`.
void note_friction(const StepReport& report, double time, FrictionPeak& peak);

/// A line where the friction of any step was off by more than 10 %; else none.
std::vector<std::string> warn_of_friction(const FrictionPeak& peak);

}  // namespace arris
