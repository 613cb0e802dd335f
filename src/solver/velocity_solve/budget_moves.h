// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace arris {

/// Finds budgets of friction that agree with the forces which they lead to: a fixed point, by Anderson's
/// acceleration. Where that has not led there soon, contacts take turns to press or to slide: then each
/// budget moves by a share of its own, which falls where its changes alternate.
class BudgetMoves {
  public:
    /// Next budgets after `now`, whose forces give `wanted`.
    Eigen::VectorXd next(const Eigen::VectorXd& now, const Eigen::VectorXd& wanted);

    int count() const { return count_; }

  private:
    Eigen::VectorXd accelerate(const Eigen::VectorXd& now, const Eigen::VectorXd& wanted,
                               const Eigen::VectorXd& change);

    int count_ = 0;
    Eigen::VectorXd share_;  ///< by budget
    Eigen::VectorXd last_, last_change_;
    std::vector<Eigen::VectorXd> moves_, differences_;  ///< of the last budgets, and of their changes
};

}  // namespace arris
