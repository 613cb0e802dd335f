// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/model/failed_flow.h"
#include "solver/model/state.h"
#include "solver/model/step_report.h"

namespace arris {

/// How far an attempt at a step may go when its solves and checks do not come to an end.
enum class Attempt {
    Ordinary,  ///< it fails: another attempt may do
    Last       ///< on a mesh without EOL vertices it takes last resorts: `rewind`, and energy that was gained
};

/// An EOL vertex over which more material would flow than the mesh has.
struct Overrun {
    int vertex;
    Vec2 flow;  ///< m/s
};

/// What one attempt has failed on, besides its status.
struct Failure {
    std::vector<Overrun> overrun = {};
    std::vector<int> overconstrained = {};  ///< EOL vertices whose contacts their coordinates cannot meet
    bool has_turned = false;                ///< EOL vertices have gone round wires or tips with the cloth
};

/// What follows a failed attempt.
enum class NextAttempt {
    WholeWithoutEol,  ///< the step as long as planned, on a mesh without EOL vertices
    WithoutTurning,   ///< the same step; EOL vertices stay where they are on wires and tips
    WithoutHistory,   ///< the same step by implicit Euler
    OnNewMesh,        ///< the same step on a mesh that takes account of what has failed
    Shorter,          ///< the rest of the step in twice as many parts
    None              ///< nothing is left: the step has failed
};

/// What `RetryPolicy::choose_next` has to know of a failed attempt.
struct FailedStep {
    StepStatus status;
    bool has_history;  ///< the attempt was BDF2
    bool is_shortest;  ///< no shorter step is tried
};

/// Remembers what the attempts at one planned step have failed on, and decides what is tried next. The order
/// is the table of rungs in retry_policy.cpp; each rung has a bound, so that every step comes to an end.
class RetryPolicy {
  public:
    static constexpr int kMostOverruns = 5;         ///< attempts that overran, before all EOL vertices go
    static constexpr int kMostOverconstrained = 3;  ///< attempts that demoted overconstrained vertices
    static constexpr int kMostParts = 64;           ///< of a planned step: its last attempt is that short

    /// Notes an attempt from `start`, which is `state` or the same cloth on the step's mesh. An attempt that
    /// is done forgets all failures but two, which hold until `forget`: that all EOL vertices were demoted,
    /// and that vertices do not turn.
    void note(const StepReport& report, Attempt attempt, const State& state, const State& start,
              const Failure& failure);
    void forget() { *this = RetryPolicy(); }

    /// What follows the attempt that was noted last.
    NextAttempt choose_next(const FailedStep& failed) const;

    /// Whether the next attempt gets another mesh than the last one.
    bool has_new_mesh() const { return has_new_mesh_; }
    /// Whether EOL vertices turned round wires or tips in the last attempt, and will not in the next.
    bool has_stopped_turning() const { return has_stopped_turning_; }
    /// Whether EOL vertices may go round wires and tips with the cloth.
    bool may_turn() const { return !is_staying_; }
    /// Whether the mesh is to have no EOL vertices.
    bool has_given_up_all() const { return has_given_up_all_; }

    const FailedFlow& flow() const { return flow_; }

  private:
    void note_overrun(bool is_last, const State& state, const State& start, const Failure& failure);
    void note_overconstrained(bool is_last, const State& start, const Failure& failure);

    int overruns_ = 0;
    int overconstrained_ = 0;
    int unsolved_ = 0;  ///< attempts whose velocity could not be solved for
    bool has_new_mesh_ = false, has_stopped_turning_ = false;
    bool is_staying_ = false, has_given_up_all_ = false;
    FailedFlow flow_;
};

}  // namespace arris
