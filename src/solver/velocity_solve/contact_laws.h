// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "solver/velocity_solve/constraint_rows.h"
#include "solver/velocity_solve/dense_solve.h"
#include "solver/velocity_solve/spring_base.h"
#include "solver/velocity_solve/velocity_solve.h"

namespace arris {

/// A velocity u, or a change of it, with A u and C u.
struct ContactPoint {
    Eigen::VectorXd velocity, product, row_values;
    void add(double share, const ContactPoint& step)
    {
        velocity += share * step.velocity;
        product += share * step.product;
        row_values += share * step.row_values;
    }
};

/// A velocity, and what the laws of bounds, rows and friction say there.
struct ContactIterate {
    ContactPoint point;
    ContactState wanted;          ///< the linear model of the laws
    Eigen::VectorXd multipliers;  ///< of scaled rows, N s
    Eigen::VectorXd residual;     ///< b - A u + C^T multipliers: minus the multiplier of a bound
    Eigen::VectorXd impulses;     ///< of slip rows, by the last linear model
    Eigen::VectorXd missed;       ///< by friction pair, N s: the last linear model's force against the law's

    double bound_force(int coordinate) const  ///< multiplier of a bound
    {
        return wanted.is_active[coordinate] ? std::max(-residual[coordinate], 0.0) : 0.0;
    }
};

/// The answer of a solve, from which another solve of the same contacts may start.
struct ContactAnswer {
    Eigen::VectorXd velocity;
    ContactState state;
    std::vector<double> budgets;            ///< N s, by friction pair, of the problem
    std::vector<Eigen::Vector2d> impulses;  ///< N s, likewise
};

/// Budgets by the problem's law for the forces found.
struct LawfulBudgets {
    Eigen::VectorXd budgets;  ///< N s, of the scaled pairs
    double error = 0.0;  ///< greatest difference of a force from what it would be with these, relative to the
                         ///< largest budget; NaN where the law is not finite
    int worst = -1;      ///< friction pair with that difference
};

/// The laws of a problem's contacts: multipliers that follow from a velocity, and their linear models.
class ContactLaws {
  public:
    /// `constraints`: of the problem; their budgets change. Both outlive this object.
    ContactLaws(const VelocityProblem& problem, ConstraintRows& constraints);

    const VelocityProblem& problem() const { return *problem_; }
    const ConstraintRows& constraints() const { return *constraints_; }
    Eigen::Map<Eigen::VectorXd> budgets() const;  ///< N s, of the scaled pairs
    bool has_budget_law() const { return constraints_->pair_count() > 0 && problem_->law; }

    ContactPoint make_point(Eigen::VectorXd velocity) const;
    double speed_at(const ContactPoint& point) const;  ///< m/s, the scale of errors of velocities

    /// The linear model of the problem's guess, at u = 0.
    ContactIterate start_from_guess() const;

    /// Sets the budgets to those of the answer.
    ContactIterate start_from(const ContactAnswer& answer) const;

    /// After rows were appended.
    void append_rows(ContactIterate& at) const;

    /// Multipliers, the residual, and the linear model at `at.point`. A multiplier that the last linear model
    /// gave stays, where the law's differs by round-off: that of a speed times the spring's stiffness.
    /// `acts`, by scaled row: whether the last linear model had it. Others have no force yet.
    void evaluate(const std::vector<char>& acts, ContactIterate& at) const;

    /// Rows and pairs of the linear model at a point. Of the rows of a group that do not act yet, the one
    /// that is violated most joins.
    void set_rows_at(const ContactPoint& point, const std::vector<char>& acts,
                     const Eigen::VectorXd& impulses, ContactState& state) const;

    LawfulBudgets find_budgets(const ContactIterate& at) const;

    VelocitySolution make_solution(const ContactIterate& at) const;
    ContactAnswer make_answer(const ContactIterate& at) const;

  private:
    void set_bounds(ContactIterate& at) const;

    const VelocityProblem* problem_;
    ConstraintRows* constraints_;
};

}  // namespace arris
