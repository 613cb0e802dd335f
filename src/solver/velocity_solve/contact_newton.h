// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's method on the energy of one velocity solve, in which contacts, rows and friction are springs that
// push, or yield. One factor is kept, for the springs of one state (SpringBase). What differs from that state
// is a member: its law enters exactly, by a dense problem of the members alone (Members, solve_members), as
// do the bounds that change sides. Where so many differ that the dense work would exceed that of a
// factorisation, there is a new factor.
//
//   evaluate     forces of all laws at u, and the residual r
//   move_budgets friction's budgets follow the forces, once u hardly changes
//   choose_base  members join, or a new factor
//   direction    du from r: one forward and one backward solve, and the members between
//   take         u + du, or as far from the last good u as the energy falls
//
// until the certificate holds and friction agrees with its law.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "solver/velocity_solve/budget_moves.h"
#include "solver/velocity_solve/member_solve.h"
#include "solver/velocity_solve/members.h"

namespace arris {

/// The answer of a solve, from which another solve of the same contacts may start.
struct ContactAnswer {
    Eigen::VectorXd velocity;
    ContactState state;
    std::vector<double> budgets;            ///< N s, by friction pair, of the problem
    std::vector<Eigen::Vector2d> impulses;  ///< N s, likewise
};

class ContactNewton {
  public:
    /// `constraints`: of the problem; their budgets change. All outlive this object.
    ContactNewton(const VelocityProblem& problem, ConstraintRows& constraints, Factorization& factorization,
                  const Settings& settings);

    /// Solves from the problem's guess.
    VelocitySolution run();

    /// Solves from the answer of another problem with the same bounds, rows and pairs.
    VelocitySolution run_from(const ContactAnswer& last);

    /// Goes on after rows were appended to problem and constraints.
    VelocitySolution resume();

    ContactAnswer answer() const;

  private:
    /// A velocity u, with A u and C u.
    struct Point {
        Eigen::VectorXd velocity, product, row_values;
        void add(double share, const Point& step)
        {
            velocity += share * step.velocity;
            product += share * step.product;
            row_values += share * step.row_values;
        }
    };
    /// Constraints that differ from the base, and how many columns they would add.
    struct Differences {
        std::vector<int> bounds, rows;  ///< that are no members yet; slip rows by pairs
        int count = 0;                  ///< members included
    };

    Point make_point(Eigen::VectorXd velocity) const;
    void start_from_guess();
    VelocitySolution iterate();
    void evaluate();
    void set_model_at(const Point& point, ContactState& state) const;
    bool agree_budgets();
    bool has_law() const { return constraints_.pair_count() > 0 && problem_.law; }
    Eigen::VectorXd law_budgets(double& error);
    bool certify();
    Differences find_differences(const ContactState& wanted) const;
    double unit_of_work() const;
    bool is_slow();
    void want_missed_pairs();
    bool choose_base();
    bool factorise();
    std::optional<Point> direction();
    double bound_force(int coordinate) const  ///< multiplier of a bound at the present point
    {
        return wanted_.is_active[coordinate] ? std::max(-residual_[coordinate], 0.0) : 0.0;
    }
    MemberProblem make_member_problem(const Eigen::VectorXd& forward);
    void take(Point step);
    bool fits(const Point& step) const;
    double search(const Point& step) const;
    void want_first_changes(const Point& step);
    VelocitySolution make_solution() const;
    VelocitySolution finish();

    const VelocityProblem& problem_;
    ConstraintRows& constraints_;
    Factorization& factorization_;
    const Settings& settings_;
    Eigen::VectorXd diagonal_;  ///< of A

    SpringBase base_;
    std::optional<Members> members_;
    ContactState wanted_;          ///< at `point_`
    Point point_, reference_;      ///< where the energy is known to be lower than before
    Eigen::VectorXd multipliers_;  ///< of scaled rows, N s
    Eigen::VectorXd residual_;     ///< b - A u + C^T multipliers: minus the multiplier of a bound
    Eigen::VectorXd
        missed_;  ///< by friction pair: difference of the linear model's force from the law's, N s
    Eigen::VectorXd impulses_;                      ///< of slip rows, by the last linear model
    double relative_step_ = 1.0, last_step_ = 1.0;  ///< largest |du| / |u|
    double last_work_ = 0.0;
    bool is_steady_ = false;  ///< neither base nor budgets have changed since the last step
    bool is_finite_ = true, is_whole_step_ = true, is_agreed_ = false, has_fresh_members_ = false;
    int excursions_ = 0;    ///< steps since `reference_`
    int most_members_ = 0;  ///< that differ from the base; twice as many in all
    int without_room_ = 0;  ///< members that no new factor would spare
    int stalled_ = 0;
    Differences first_changes_;  ///< on the way of a step that went nearly nowhere: members of the next one
    BudgetMoves moves_;
    DenseBudget work_ = {0.0};

    VelocitySolution best_;
    double best_residual_;
    int without_better_ = 0;
    ContactAnswer answer_;
};

}  // namespace arris
