// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/attempts.h"

#include <algorithm>

namespace arris {

namespace {

/// Which overrun of a step asks for a shorter one, and from which on vertices are given up.
constexpr int kShortens = 2, kGivesUp = 3;

}  // namespace

void RetryPolicy::note(const StepReport& report, Attempt attempt, const State& state, const State& start,
                       const Failure& failure)
{
    const bool is_staying = is_staying_;
    if (report.status == StepStatus::Done) {
        if (!has_given_up_all_) forget();
        is_staying_ = is_staying;
        return;
    }
    is_staying_ = is_staying || (report.status == StepStatus::EnergyRise && failure.has_turned);
    may_staying_help_ = is_staying_ && !is_staying;
    const bool is_last = attempt == Attempt::Last;
    if (report.status == StepStatus::Overrun) {
        ++overruns_;
        const bool is_all_new =
            std::none_of(failure.overrun.begin(), failure.overrun.end(),
                         [&](const Overrun& at) { return state.eol_entry(start.ids[at.vertex]) >= 0; });
        // The next attempt can clear no way for what it makes itself: it would be this one again.
        if (is_all_new) overruns_ = std::max(overruns_, is_last ? kGivesUp : kShortens);
        for (const auto& [v, flow] : failure.overrun) {
            // The next attempt makes what is new anew: it is known by its place.
            if (state.eol_entry(start.ids[v]) < 0) {
                if (overruns_ >= kGivesUp) flow_.made_at.push_back(start.mesh.material[v]);
                continue;
            }
            flow_.flow[start.ids[v]] = flow;
            if (overruns_ >= kGivesUp) flow_.given_up.insert(start.ids[v]);
        }
        may_mesh_help_ = overruns_ <= kMostOverruns + 1 && (overruns_ != kShortens || is_last);
    } else {
        // A shorter step would find them in the same place: they are ordinary vertices first.
        const bool is_overconstrained =
            !failure.overconstrained.empty() && overconstrained_++ < kMostOverconstrained;
        if (is_overconstrained)
            for (const int v : failure.overconstrained) flow_.given_up.insert(start.ids[v]);
        may_mesh_help_ = is_overconstrained || (is_last && !start.eol.empty());
    }
    if (report.status == StepStatus::NotConverged || report.status == StepStatus::NotFinite) ++unsolved_;
    const bool is_hopeless = report.status == StepStatus::Overrun ? overruns_ > kMostOverruns : is_last;
    if (!is_hopeless && unsolved_ < 2) return;
    has_given_up_all_ = true;
    for (const State* tried : {&state, &start})
        for (const EolVertex& eol : tried->eol) flow_.given_up.insert(eol.vertex_id);
}

}  // namespace arris
