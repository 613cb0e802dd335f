// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/budget_moves.h"

#include <Eigen/QR>
#include <algorithm>

namespace arris {

using Eigen::VectorXd;

VectorXd BudgetMoves::next(const VectorXd& now, const VectorXd& wanted)
{
    constexpr int kAccelerated = 10;  // moves
    constexpr double kFall = 0.5, kRise = 1.5;
    const VectorXd change = wanted - now;
    VectorXd next;
    if (++count_ <= kAccelerated) {
        next = accelerate(now, wanted, change);
    } else {
        if (share_.size() == 0) share_ = VectorXd::Ones(now.size());
        for (Eigen::Index p = 0; p < now.size(); ++p)
            share_[p] =
                change[p] * last_change_[p] < 0.0 ? kFall * share_[p] : std::min(kRise * share_[p], 1.0);
        next = now + share_.cwiseProduct(change);
    }
    last_ = now;
    last_change_ = change;
    return next;
}

VectorXd BudgetMoves::accelerate(const VectorXd& now, const VectorXd& wanted, const VectorXd& change)
{
    constexpr std::size_t kDepth = 5;  // moves that are remembered
    constexpr double kFarthest = 3.0;  // ratio of a move
    if (last_.size() != now.size()) return wanted;
    if (change.norm() > 2.0 * last_change_.norm()) {
        moves_.clear();
        differences_.clear();
        return wanted;
    }
    moves_.push_back(now - last_);
    differences_.push_back(change - last_change_);
    if (moves_.size() > kDepth) {
        moves_.erase(moves_.begin());
        differences_.erase(differences_.begin());
    }
    const auto depth = static_cast<Eigen::Index>(moves_.size());
    Eigen::MatrixXd columns(now.size(), depth);
    for (Eigen::Index k = 0; k < depth; ++k) columns.col(k) = differences_[k];
    const VectorXd weights = columns.colPivHouseholderQr().solve(change);
    VectorXd next = wanted;
    if (weights.allFinite())
        for (Eigen::Index k = 0; k < depth; ++k) next -= weights[k] * (moves_[k] + differences_[k]);
    for (Eigen::Index p = 0; p < next.size(); ++p) {
        const double least = now[p] > 0.0 ? std::min(now[p], wanted[p]) : wanted[p];
        next[p] = wanted[p] > 0.0
                      ? std::clamp(next[p], least / kFarthest, kFarthest * std::max(now[p], wanted[p]))
                      : 0.0;
    }
    return next;
}

}  // namespace arris
