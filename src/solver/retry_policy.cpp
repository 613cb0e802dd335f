// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/retry_policy.h"

#include <algorithm>

namespace arris {

namespace {

/// Number of the overrun after which the step is made shorter, and of the first one that demotes EOL
/// vertices.
constexpr int kShortens = 2, kDemotes = 3;

/// One kind of next attempt, and its condition.
struct Rung {
    NextAttempt next;
    bool (*applies)(const RetryPolicy& policy, const FailedStep& failed);
    AttemptRule in_words;
};

/// The first rung that applies is chosen. Each is bounded: all EOL vertices are given up once, going round
/// wires and tips stops once, history is dropped once a part, and remeshing is left out once. New meshes are
/// bounded by kMostOverruns + 1 overruns and kMostOverconstrained demotions, parts by kMostParts.
constexpr Rung kRungs[] = {
    // Without EOL vertices the whole step may succeed, even where the shortest failed with them.
    {NextAttempt::WholeWithoutEol,
     [](const RetryPolicy& policy, const FailedStep& failed) {
         return failed.attempt == Attempt::Last && policy.has_new_mesh() && policy.has_given_up_all();
     },
     {"a last attempt failed with EOL vertices: at the shortest part, or after 400 factorisations' worth of "
      "work",
      "the rest of the step without any, in as few parts as planned", "once"}},
    {NextAttempt::WithoutRemeshing,
     [](const RetryPolicy& policy, const FailedStep&) { return policy.has_stopped_remeshing(); },
     {"the mesh was remeshed for the attempt", "on a mesh whose cells keep their size", "once"}},
    // Going round a wire is not part of the equations of motion, so it may have raised the energy.
    {NextAttempt::WithoutTurning,
     [](const RetryPolicy& policy, const FailedStep&) { return policy.has_stopped_turning(); },
     {"energy rose, and a vertex went round a wire or tip", "without going round", "once"}},
    // Implicit Euler's objective bounds the energy; BDF2's history may raise it.
    {NextAttempt::WithoutHistory,
     [](const RetryPolicy&, const FailedStep& failed) {
         return failed.status == StepStatus::EnergyRise && failed.has_history;
     },
     {"energy rose with BDF2", "by implicit Euler", "once"}},
    // The new mesh has room ahead of vertices that overran, and no overconstrained EOL vertices.
    {NextAttempt::OnNewMesh,
     [](const RetryPolicy& policy, const FailedStep&) { return policy.has_new_mesh(); },
     {"material overran, or EOL vertices were overconstrained", "on a mesh with room, and without those",
      "6 overruns and 3 demotions; then without any EOL vertices"}},
    {NextAttempt::Shorter,
     [](const RetryPolicy&, const FailedStep& failed) { return !failed.is_shortest; },
     {"anything else", "the rest of the step in twice as many parts", "64 parts; then the run ends"}},
};

}  // namespace

NextAttempt RetryPolicy::choose_next(const FailedStep& failed) const
{
    for (const Rung& rung : kRungs)
        if (rung.applies(*this, failed)) return rung.next;
    return NextAttempt::None;
}

std::vector<AttemptRule> list_attempt_rules()
{
    std::vector<AttemptRule> rules;
    for (const Rung& rung : kRungs) rules.push_back(rung.in_words);
    return rules;
}

void RetryPolicy::note(const StepReport& report, Attempt attempt, const State& state, const State& start,
                       const Failure& failure)
{
    const bool was_staying = is_staying_;
    const double work = work_ += report.solve_work;
    if (report.status == StepStatus::Done) {
        if (!has_given_up_all_) forget();
        is_staying_ = was_staying;
        work_ = work;
        return;
    }
    has_stopped_remeshing_ = report.remeshed > 0;
    if (has_stopped_remeshing_) {
        flow_.remeshes = false;
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
    // The next attempt cannot clear a way for vertices that it inserts itself: it would fail like this one.
    // Their contacts were constraints until now and stay so for this step, as a shorter step would cost more.
    if (is_all_new) overruns_ = std::max(overruns_, kDemotes);
    for (const auto& [v, flow] : failure.overrun) {
        // The next attempt inserts such a vertex under another id, so its place identifies it.
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
    // A shorter step would find these vertices at the same places, so they are demoted first.
    const bool is_demoted = !failure.overconstrained.empty() && overconstrained_++ < kMostOverconstrained;
    if (is_demoted)
        for (const int v : failure.overconstrained) flow_.given_up.insert(start.ids[v]);
    has_new_mesh_ = is_demoted || (is_last && !start.eol.empty());
}

}  // namespace arris
