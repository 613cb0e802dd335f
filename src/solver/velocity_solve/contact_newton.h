// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's method on the energy of one velocity solve, in which contacts, rows and friction are springs that
// push, or yield. One factor is kept, for the springs of one state (SpringBase). What differs from that state
// is a member: its law enters exactly, by a dense problem of the members alone (Members, solve_members), as
// do the bounds that change sides. Where so many differ that the dense work would exceed that of a
// factorisation, there is a new factor.
//
//   evaluate       forces of all laws at u, the residual, and a linear model   ContactLaws
//   agree_budgets  friction's budgets follow the forces, once u hardly changes BudgetMoves
//   choose_base    what differs from the base joins, or there is a new base    find_changes
//   find_step      du: one forward and one backward solve, the members between
//   take           u + du, or as far from the last good u as the energy falls  find_share
//
// until the certificate holds and friction agrees with its law.
#pragma once

#include <optional>

#include "solver/velocity_solve/budget_moves.h"
#include "solver/velocity_solve/condensed_qp.h"
#include "solver/velocity_solve/contact_laws.h"
#include "solver/velocity_solve/members.h"
#include "solver/velocity_solve/model_changes.h"

namespace arris {

class ContactNewton {
  public:
    /// `constraints`: of the problem; their budgets change. All but the settings outlive this object.
    ContactNewton(const VelocityProblem& problem, ConstraintRows& constraints, Factorization& factorization,
                  const Settings& settings);

    /// Solves from the problem's guess.
    VelocitySolution run();

    /// Solves from the answer of another problem with the same bounds, rows and pairs.
    VelocitySolution run_from(const ContactAnswer& last);

    /// Goes on after rows were appended to problem and constraints.
    VelocitySolution resume(const Settings& settings);

    ContactAnswer answer() const { return laws_.make_answer(at_); }

  private:
    /// What the next iteration needs to know of those before.
    struct Progress {
        double relative_step = 1.0, last_step = 1.0;  ///< largest |du| / |u|
        double last_work = 0.0;                       ///< left
        bool is_steady = false;    ///< neither base nor budgets have changed since the last step
        bool is_long_step = true;  ///< not cut short by the line search
        bool is_agreed = false;    ///< budgets with their law
        bool has_fresh_members = false;
        int iterations = 0;      ///< of this run
        int excursions = 0;      ///< steps since `reference_`
        int stalled = 0;         ///< line searches that went nowhere
        int without_better = 0;  ///< certificates since the best one
        ModelChanges joining;    ///< members of the next step whatever the state
    };

    VelocitySolution iterate();
    std::vector<char> acting() const;
    bool may_move() const;
    bool agree_budgets();
    bool certify();
    double unit_of_work() const;
    int most_changes() const { return most_members_ + without_room_; }
    bool is_converging() const;
    bool is_slow();
    void want_missed_pairs();
    bool choose_base();
    bool factorise();
    void take(ContactPoint step);
    bool fits(const ContactPoint& step) const;
    VelocitySolution finish();

    const VelocityProblem& problem_;
    ConstraintRows& constraints_;
    Factorization& factorization_;
    const Settings* settings_;
    ContactLaws laws_;
    double accurate_;  ///< residual down to which it refines
    SpringBase base_;
    std::optional<Members> members_;

    ContactIterate at_;
    ContactPoint reference_;  ///< where the energy is known to be lower than before
    Progress now_;
    int most_members_ = 0;  ///< that differ from the base; twice as many in all
    int without_room_ = 0;  ///< members that no new factor would spare
    BudgetMoves moves_;
    DenseBudget work_ = {0.0};

    VelocitySolution best_;
    double best_residual_;
};

}  // namespace arris
