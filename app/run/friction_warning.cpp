// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/friction_warning.h"

#include <fmt/format.h>

#include "app/text/counted.h"
#include "solver/step_friction.h"

namespace arris {

void note_friction(const StepReport& report, double time, FrictionPeak& peak)
{
    if (report.friction_residual > kOffLaw) ++peak.rows;
    if (report.friction_residual > peak.residual)
        peak = {report.friction_residual, time, report.friction_place, peak.rows};
}

std::vector<std::string> warn_of_friction(const FrictionPeak& peak)
{
    if (peak.rows == 0) return {};
    return {fmt::format(
        "friction differed from its law by more than {:.2g} % of the largest friction in {}, most by "
        "{:.3g} % "
        "in the step to t = {:.6g} s, near [{:.4g}, {:.4g}, {:.4g}] m: contacts took turns to press or to "
        "slide; lower 'time.step', or set 'cloth.material.damping' to 0.001 s or more",
        100.0 * kOffLaw, counted(peak.rows, "step", "steps"), 100.0 * peak.residual, peak.time,
        peak.world.x(), peak.world.y(), peak.world.z())};
}

}  // namespace arris
