// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/advance.h"

#include <algorithm>
#include <utility>

#include "solver/material_flow.h"
#include "solver/step.h"
#include "solver/time_integration.h"

namespace arris {

namespace {

/// What attempts cost, the failed ones included.
struct Cost {
    PhaseSeconds seconds;
    int factorisations = 0, nlopt_evaluations = 0, solves = 0;

    void add(const StepReport& report)
    {
        seconds += report.seconds;
        factorisations += report.factorisations;
        nlopt_evaluations += report.nlopt_evaluations;
        solves += report.solves;
    }
    void put_into(StepReport& report)
    {
        report.seconds = seconds;
        report.factorisations = factorisations;
        report.nlopt_evaluations = nlopt_evaluations;
        report.solves = solves;
        *this = Cost();
    }
};

}  // namespace

std::optional<StepReport> advance(const Scene& scene, const Settings& settings, double end, State& state,
                                  Workspace& work, const AcceptPart& accept)
{
    constexpr int kMostParts = 64, kStartParts = 3;
    const double planned = end - state.time;
    int shrink = 1;                                      // how much shorter parts have become
    int parts = find_flow_parts(scene, state, planned);  // how many are left
    bool is_start = settings.integrator == Integrator::Bdf2 && !has_past(state, planned) && parts == 1;
    bool is_rest = false;  // what follows an opening, as long as it is made in one
    if (is_start) parts = kStartParts;
    Cost cost;
    work.failed.forget();
    while (state.time < end) {
        const double part_end = parts == 1 ? end : state.time + (end - state.time) / parts;
        const Attempt attempt = shrink == kMostParts ? Attempt::Last : Attempt::Ordinary;
        StepReport report = step(scene, settings, part_end, state, work, attempt);
        cost.add(report);
        if (report.status == StepStatus::Done) {
            cost.put_into(report);
            report.is_opening = std::exchange(is_start, false);
            parts = report.is_opening ? 1 : std::max(parts - 1, 1);
            if (!accept(report, report.dt < planned && !report.is_opening && !is_rest)) return std::nullopt;
            is_rest = report.is_opening;
        } else if (attempt == Attempt::Last && work.failed.may_mesh_help() &&
                   work.failed.has_given_up_all()) {
            // What was no step for the one mesh may be one for the other.
            parts = std::max(parts / shrink, 1);
            shrink = 1;
        } else if (work.failed.may_staying_help()) {
            continue;
        } else if (report.status == StepStatus::EnergyRise && work.prediction.has_history) {
            restart(state);
        } else if (work.failed.may_mesh_help()) {
            continue;
        } else if (shrink == kMostParts) {
            return report;
        } else {
            shrink *= 2;
            parts *= 2;
            is_start = is_rest = false;
        }
    }
    return std::nullopt;
}

}  // namespace arris
