// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>
#include <vector>

#include "solver/model/failed_flow.h"
#include "solver/model/state.h"
#include "solver/model/step_report.h"

namespace arris {

/// Whether an attempt at a step may take last resorts where its solves and checks do not succeed.
enum class Attempt {
    Ordinary,  ///< it fails instead: another attempt may succeed
    Last       ///< on a mesh without EOL vertices, it may rewind cloth, and accept an energy rise or friction
               ///< off its law
};

/// An EOL vertex through which more material would flow in the step than the faces beside it can give.
struct Overrun {
    int vertex;
    Vec2 flow;  ///< m/s
};

/// Causes of a failed attempt, besides its status.
struct Failure {
    std::vector<Overrun> overrun = {};
    std::vector<int> overconstrained = {};  ///< EOL vertices whose contacts their coordinates cannot meet
    bool has_turned = false;                ///< an EOL vertex has gone round its wire or tip with the cloth
};

/// The attempt that follows a failed one.
enum class NextAttempt {
    WholeWithoutEol,   ///< the whole planned step, on a mesh without EOL vertices
    WithoutRemeshing,  ///< the failed step, on a mesh whose cells keep their size
    WithoutTurning,    ///< the failed step, without going round wires and tips
    WithoutHistory,    ///< the failed step, by implicit Euler
    OnNewMesh,         ///< the failed step, on a mesh that avoids the recorded failures
    Shorter,           ///< the rest of the step in twice as many parts
    None               ///< no attempt is left: the step has failed
};

/// A row of the table of attempts, in words: the first one whose condition holds is taken.
struct AttemptRule {
    std::string_view condition, next, bound;
};
std::vector<AttemptRule> list_attempt_rules();

/// A failed attempt, as input of `RetryPolicy::choose_next`.
struct FailedStep {
    StepStatus status;
    Attempt attempt;
    bool has_history;  ///< the attempt used BDF2
    bool is_shortest;  ///< no shorter step is tried
};

/// Records why attempts at one planned step failed, and decides the next attempt. The decisions are the table
/// of rungs in retry_policy.cpp, in that order. Each rung is bounded, so that every step ends.
class RetryPolicy {
  public:
    static constexpr int kMostOverruns = 5;         ///< overruns before all EOL vertices are given up
    static constexpr int kMostOverconstrained = 3;  ///< attempts that demote overconstrained vertices
    static constexpr int kMostParts = 64;           ///< the shortest part: 1/64 of a part as planned
    /// Work of the velocity solves of one planned step, in factorisations' worth, after which attempts at the
    /// rest of it are last ones.
    static constexpr double kMostWork = 400.0;

    /// Records an attempt that started from `start`: `state` itself, or its cloth on the step's mesh. A
    /// successful attempt clears the record. The work and two decisions hold until `forget`: to give up all
    /// EOL vertices (then the record stays, too), and not to go round wires and tips.
    void note(const StepReport& report, Attempt attempt, const State& state, const State& start,
              const Failure& failure);
    void forget() { *this = RetryPolicy(); }

    /// Whether the next attempt, at the shortest part or not, may take last resorts.
    Attempt choose_attempt(bool is_shortest) const
    {
        return is_shortest || work_ > kMostWork ? Attempt::Last : Attempt::Ordinary;
    }
    /// The attempt that follows the one recorded last.
    NextAttempt choose_next(const FailedStep& failed) const;

    /// Whether the next attempt gets a different mesh.
    bool has_new_mesh() const { return has_new_mesh_; }
    /// Whether the last attempt's mesh was remeshed, and the next one's is not.
    bool has_stopped_remeshing() const { return has_stopped_remeshing_; }
    /// Whether EOL vertices went round wires or tips in the last attempt, and no longer do so from the next
    /// on.
    bool has_stopped_turning() const { return has_stopped_turning_; }
    /// Whether EOL vertices may go round wires and tips with the cloth.
    bool may_turn() const { return !is_staying_; }
    /// Whether all EOL vertices are given up, so that the mesh gets none.
    bool has_given_up_all() const { return has_given_up_all_; }

    const FailedFlow& flow() const { return flow_; }

  private:
    void note_overrun(bool is_last, const State& state, const State& start, const Failure& failure);
    void note_overconstrained(bool is_last, const State& start, const Failure& failure);

    int overruns_ = 0;
    int overconstrained_ = 0;
    int unsolved_ = 0;   ///< attempts whose velocity solve failed
    double work_ = 0.0;  ///< factorisations' worth
    bool has_new_mesh_ = false, has_stopped_turning_ = false, has_stopped_remeshing_ = false;
    bool is_staying_ = false, has_given_up_all_ = false;
    FailedFlow flow_;
};

}  // namespace arris
