// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/advance.h"

#include <algorithm>
#include <utility>

#include "solver/material_flow.h"
#include "solver/model/time_integration.h"
#include "solver/step.h"

namespace arris {

std::optional<StepReport> advance(const Scene& scene, const Settings& settings, double end, State& state,
                                  Workspace& work, const AcceptPart& accept)
{
    constexpr int kMostParts = 64, kStartParts = 3;
    const double planned = end - state.time;
    int shrink = 1;                                      // how much shorter parts have become
    int parts = find_flow_parts(scene, state, planned);  // how many are left
    StepPart part = StepPart::Ordinary;
    if (settings.integrator == Integrator::Bdf2 && !has_past(state, planned) && parts == 1) {
        part = StepPart::Opening;
        parts = kStartParts;
    }
    StepReport failed;  // attempts since the last part that was made: what they cost
    work.retry.forget();
    while (state.time < end) {
        const double part_end = parts == 1 ? end : state.time + (end - state.time) / parts;
        const Attempt attempt = shrink == kMostParts ? Attempt::Last : Attempt::Ordinary;
        StepReport report = step(scene, settings, part_end, state, work, attempt);
        if (report.status == StepStatus::Done) {
            report.add_cost(std::exchange(failed, {}));
            report.part = part;
            parts = part == StepPart::Opening ? 1 : std::max(parts - 1, 1);
            part = part == StepPart::Opening ? StepPart::Rest : StepPart::Ordinary;
            if (!accept(report, report.part == StepPart::Ordinary && report.dt < planned))
                return std::nullopt;
            continue;
        }
        failed.add_cost(report);
        if (attempt == Attempt::Last && work.retry.may_mesh_help() && work.retry.has_given_up_all()) {
            // What was no step for the one mesh may be one for the other.
            parts = std::max(parts / shrink, 1);
            shrink = 1;
        } else if (work.retry.may_staying_help()) {
            continue;
        } else if (report.status == StepStatus::EnergyRise && work.prediction.has_history) {
            restart(state);
        } else if (work.retry.may_mesh_help()) {
            continue;
        } else if (shrink == kMostParts) {
            return report;
        } else {
            shrink *= 2;
            parts *= 2;
            part = StepPart::Ordinary;
        }
    }
    return std::nullopt;
}

}  // namespace arris
