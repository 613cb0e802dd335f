// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "solver/velocity_solve/base_in_use.h"
#include "solver/velocity_solve/factorization.h"
#include "solver/velocity_solve/violators.h"

namespace arris {

/// No motion and no multipliers.
VelocitySolution make_zero_solution(const VelocityProblem& problem);

/// One solve: its rounds and the best answer so far.
class ActiveSetSearch {
  public:
    ActiveSetSearch(const VelocityProblem& problem, Factorization& factorization,
                    const ConstraintRows& constraints, std::optional<BaseInUse>& in_use,
                    const Settings& settings);

    /// `has_row_guess`: whether to start with the rows expected to press.
    VelocitySolution run(bool has_row_guess, int most_factorisations);

    /// Goes on from the base in use, which belongs to this problem with fewer rows or other budgets of
    /// friction.
    VelocitySolution resume(int most_factorisations);

  private:
    VelocitySolution run_bases(int most_factorisations);
    void run_base(int cap);
    void run_rounds(int cap);
    bool start_rows();
    void choose_rows(const std::vector<int>& expected);
    bool has_many_changes(const Violators& violators) const;
    void start_from_iterate();
    void rebase_by_prediction();
    void flip_bounds(const std::vector<int>& coordinates);
    void rebase_with_changed(const Violators& violators);
    void rebase_with_violated_rows(const Violators& violators);
    bool finish();
    void refine();
    bool certify();
    std::vector<int> rows_of_guess() const;

    const VelocityProblem& problem_;
    Factorization& factorization_;
    const ConstraintRows& constraints_;
    std::optional<BaseInUse>& in_use_;
    const Settings& settings_;
    VelocitySolution best_;          ///< row multipliers belong to the scaled rows until the end
    std::vector<char> best_exact_;   ///< by friction pair: Iterate::is_exact of `best_`
    std::vector<char> is_active_;    ///< pins of the next base
    std::vector<int> rows_;          ///< rows with which the next base's working set starts
    std::vector<char> is_pressing_;  ///< by row: part of the next base
    std::vector<char> has_pulled_;   ///< by row: not to be part of a base any more
    std::vector<SlipSpring> slips_;  ///< of the next base, by friction pair
    Eigen::VectorXd newton_point_;   ///< velocity reached by Newton's method; empty before
    DenseBudget budget_ = {0.0};
    bool has_rebased_for_accuracy_ = false;
    bool is_over_ = false;
};

}  // namespace arris
