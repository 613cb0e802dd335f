// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/retry_policy.h"

#include <algorithm>

namespace arris {

namespace {

/// The number of the overrun from which on a shorter step is tried, and from which on EOL vertices are
/// demoted.
constexpr int kShortens = 2, kDemotes = 3;

/// One way to go on after a failed attempt, and when it is taken.
struct Rung {
    NextAttempt next;
    bool (*applies)(const RetryPolicy& policy, const FailedStep& failed);
};

/// The first rung that applies is taken. Bounds: a policy gives up all EOL vertices once; turning stops once;
/// an attempt without history has none to drop; new meshes are bounded by kMostOverruns + 1 overruns and
/// kMostOverconstrained demotions; parts by kMostParts.
constexpr Rung kRungs[] = {
    // What was no step of the shortest length with EOL vertices may be one of the planned length without.
    {NextAttempt::WholeWithoutEol,
     [](const RetryPolicy& policy, const FailedStep& failed) {
         return failed.is_shortest && policy.has_new_mesh() && policy.has_given_up_all();
     }},
    // Going round a wire is no part of the equations: where energy has risen by it, it is left out.
    {NextAttempt::WithoutTurning,
     [](const RetryPolicy& policy, const FailedStep&) { return policy.has_stopped_turning(); }},
    // Implicit Euler's objective bounds the energy; BDF2's history is what may raise it.
    {NextAttempt::WithoutHistory,
     [](const RetryPolicy&, const FailedStep& failed) {
         return failed.status == StepStatus::EnergyRise && failed.has_history;
     }},
    // The way of what overran is cleared; overconstrained vertices become ordinary ones.
    {NextAttempt::OnNewMesh,
     [](const RetryPolicy& policy, const FailedStep&) { return policy.has_new_mesh(); }},
    {NextAttempt::Shorter, [](const RetryPolicy&, const FailedStep& failed) { return !failed.is_shortest; }},
};

}  // namespace

NextAttempt RetryPolicy::choose_next(const FailedStep& failed) const
{
    for (const Rung& rung : kRungs)
        if (rung.applies(*this, failed)) return rung.next;
    return NextAttempt::None;
}

void RetryPolicy::note(const StepReport& report, Attempt attempt, const State& state, const State& start,
                       const Failure& failure)
{
    const bool was_staying = is_staying_;
    if (report.status == StepStatus::Done) {
        if (!has_given_up_all_) forget();
        is_staying_ = was_staying;
        return;
    }
    is_staying_ = was_staying || (report.status == StepStatus::EnergyRise && failure.has_turned);
    has_stopped_turning_ = is_staying_ && !was_staying;
    const bool is_last = attempt == Attempt::Last;
    const bool is_overrun = report.status == StepStatus::Overrun;
    if (is_overrun)
        note_overrun(is_last, state, start, failure);
    else
        note_overconstrained(is_last, start, failure);
    if (report.status == StepStatus::NotConverged || report.status == StepStatus::NotFinite) ++unsolved_;
    const bool is_hopeless = is_overrun ? overruns_ > kMostOverruns : is_last;
    if (!is_hopeless && unsolved_ < 2) return;
    has_given_up_all_ = true;
    for (const State* tried : {&state, &start})
        for (const EolVertex& eol : tried->eol) flow_.given_up.insert(eol.vertex_id);
}

void RetryPolicy::note_overrun(bool is_last, const State& state, const State& start, const Failure& failure)
{
    ++overruns_;
    const bool is_all_new =
        std::none_of(failure.overrun.begin(), failure.overrun.end(),
                     [&](const Overrun& at) { return state.eol_entry(start.ids[at.vertex]) >= 0; });
    // The next attempt cannot clear a way for vertices that it inserts itself: it would be this one again.
    if (is_all_new) overruns_ = std::max(overruns_, is_last ? kDemotes : kShortens);
    for (const auto& [v, flow] : failure.overrun) {
        // The next attempt inserts a new vertex anew, under another id: the place identifies it.
        if (state.eol_entry(start.ids[v]) < 0) {
            if (overruns_ >= kDemotes) flow_.made_at.push_back(start.mesh.material[v]);
            continue;
        }
        flow_.flow[start.ids[v]] = flow;
        if (overruns_ >= kDemotes) flow_.given_up.insert(start.ids[v]);
    }
    has_new_mesh_ = overruns_ <= kMostOverruns + 1 && (overruns_ != kShortens || is_last);
}

void RetryPolicy::note_overconstrained(bool is_last, const State& start, const Failure& failure)
{
    // A shorter step would find these vertices in the same place: they become ordinary ones first.
    const bool is_demoted = !failure.overconstrained.empty() && overconstrained_++ < kMostOverconstrained;
    if (is_demoted)
        for (const int v : failure.overconstrained) flow_.given_up.insert(start.ids[v]);
    has_new_mesh_ = is_demoted || (is_last && !start.eol.empty());
}

}  // namespace arris
