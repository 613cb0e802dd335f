// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/advance.h"

#include <algorithm>
#include <utility>

#include "solver/material_flow.h"
#include "solver/model/time_integration.h"
#include "solver/motion_parts.h"
#include "solver/step.h"
#include "solver/step_friction.h"

namespace arris {

std::optional<StepReport> advance(const Scene& scene, const Settings& settings, double end, State& state,
                                  Workspace& work, const AcceptPart& accept)
{
    constexpr int kStartParts = 3;
    constexpr double kRounding = 1e-9;
    const PlannedStep planned = {state.time, end};
    int shrink = 1;  // factor by which parts have become shorter
    const int of_motion = find_motion_parts(scene, state, planned.length());
    int parts = std::max(find_flow_parts(scene, state, planned.length()), of_motion);  // left until `end`
    // A part that the obstacles' motion asks for is no halved step.
    const double whole = of_motion == 1 ? planned.length() : (1.0 - kRounding) * planned.length() / of_motion;
    StepPart part = StepPart::Ordinary;
    if (settings.integrator == Integrator::Bdf2 && !has_past(state, planned.length()) && parts == 1) {
        part = StepPart::Opening;
        parts = kStartParts;
    }
    StepReport failed;  // cost of the attempts since the last accepted part
    work.retry.forget();
    while (state.time < end) {
        const double part_end = parts == 1 ? end : state.time + (end - state.time) / parts;
        const bool is_shortest = shrink == RetryPolicy::kMostParts;
        const Attempt attempt = work.retry.choose_attempt(is_shortest);
        StepReport report = make_part(scene, settings, planned, part_end, state, work, attempt);
        if (report.status == StepStatus::Done) {
            report.add_cost(std::exchange(failed, {}));
            report.part = part;
            parts = part == StepPart::Opening ? 1 : std::max(parts - 1, 1);
            part = part == StepPart::Opening ? StepPart::Rest : StepPart::Ordinary;
            // The hard moment may be over, unless last resorts brought the cloth here.
            const bool is_sound = report.friction_residual <= kOffLaw && report.energy_rise == 0.0;
            if (shrink > 1 && parts % 2 == 0 && is_sound) {
                shrink /= 2;
                parts /= 2;
            }
            if (!accept(report, report.part == StepPart::Ordinary && report.dt < whole)) return std::nullopt;
            continue;
        }
        failed.add_cost(report);
        switch (work.retry.choose_next({report.status, attempt, work.prediction.has_history, is_shortest})) {
            case NextAttempt::WholeWithoutEol:
                parts = std::max(parts / shrink, 1);
                shrink = 1;
                break;
            case NextAttempt::WithoutRemeshing:
            case NextAttempt::WithoutTurning:
            case NextAttempt::OnNewMesh:
                break;
            case NextAttempt::WithoutHistory:
                restart(state);
                break;
            case NextAttempt::Shorter:
                shrink *= 2;
                parts *= 2;
                part = StepPart::Ordinary;
                break;
            case NextAttempt::None:
                return report;
        }
    }
    return std::nullopt;
}

}  // namespace arris
