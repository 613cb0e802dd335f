// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/model/failed_flow.h"
#include "solver/model/state.h"
#include "solver/model/step_report.h"

namespace arris {

/// What a step may do where solve and check do not come to an end.
enum class Attempt {
    Ordinary,  ///< fail: a shorter step may do
    Last       ///< on a mesh without EOL vertices, last resorts: `rewind`, and energy that was gained
};

/// An EOL vertex over which more material would flow than the mesh has.
struct Overrun {
    int vertex;
    Vec2 flow;  ///< m/s
};

/// On what one attempt has failed.
struct Failure {
    std::vector<Overrun> overrun = {};
    std::vector<int> overconstrained = {};  ///< EOL vertices in contacts that their ways cannot meet
    bool has_turned = false;                ///< EOL vertices have gone round wires or tips with the cloth
};

/// What the attempts at one step have failed on: the next one has to know. Where energy rises as vertices go
/// round wires and tips they stay, for the rest of the step. The same step on another mesh comes before a
/// shorter one: with the way of what overran cleared, but where all of that is new; where a shorter step has
/// not helped, with fewer EOL vertices; in the end, as long as it was at first, with none.
class RetryPolicy {
  public:
    static constexpr int kMostOverruns = 5;
    static constexpr int kMostOverconstrained = 3;

    /// Of an attempt from `start`, `state` or what conform made of it. One that is done forgets all, but that
    /// all were given up, or stay: that holds until `forget`.
    void note(const StepReport& report, Attempt attempt, const State& state, const State& start,
              const Failure& failure);
    void forget() { *this = RetryPolicy(); }

    /// Whether the same step may do on the mesh that it now gets.
    bool may_mesh_help() const { return may_mesh_help_; }
    /// Whether it may as vertices now stay where they turned.
    bool may_staying_help() const { return may_staying_help_; }
    /// Whether vertices may go round wires and tips.
    bool may_turn() const { return !is_staying_; }
    /// Whether that mesh is to have no EOL vertices.
    bool has_given_up_all() const { return has_given_up_all_; }

    const FailedFlow& flow() const { return flow_; }

  private:
    int overruns_ = 0;
    int overconstrained_ = 0;  ///< whose contacts could not be met by the ways that EOL vertices have
    int unsolved_ = 0;         ///< whose velocity could not be solved for
    bool may_mesh_help_ = false, may_staying_help_ = false;
    bool is_staying_ = false, has_given_up_all_ = false;
    FailedFlow flow_;
};

}  // namespace arris
