// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/condensed_descent.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace arris {
namespace {

/// The sign of w is trusted down to this share of the largest known w, and down to the round-off of the
/// changes added to w.
constexpr double kSignTolerance = 1e-13;
constexpr double kRoundOff = 1e-15;

/// Shifts of the diagonal with which Cholesky factorises the matrix of dependent constraints: the smallest
/// that works is taken. Along the directions that a shift shortens, the move is repeated.
constexpr double kLeastShift = 1e-11;
constexpr double kLargestShift = 1e-5;
constexpr double kShiftGrowth = 100.0;

/// Moves within one set of free unknowns; the later ones remove the error left by the shift.
constexpr int kMostMoves = 4;

class Descent {
  public:
    Descent(const CondensedQp& qp, const KnownGap& known, CondensedAnswer& answer)
        : qp_(qp), known_(known), answer_(answer)
    {
        for (Eigen::Index i = 0; i < answer.z.size(); ++i) {
            answer.z[i] = std::clamp(answer.z[i], 0.0, qp.cap[i]);
            if (answer.z[i] <= 0.0)
                answer.stand[i] = Stand::AtZero;
            else if (answer.z[i] >= qp.cap[i])
                answer.stand[i] = Stand::AtCap;
            else
                answer.stand[i] = Stand::Between;
        }
        is_stuck_.assign(answer.stand.size(), 0);
    }

    bool run();

  private:
    void evaluate();
    double energy() const;
    int find_wrong() const;
    bool minimise();
    bool move(const std::vector<int>& free, bool& is_blocked);
    bool is_settled(const std::vector<int>& free) const;

    const CondensedQp& qp_;
    const KnownGap& known_;
    CondensedAnswer& answer_;
    Eigen::VectorXd tolerance_;   ///< least trusted w
    std::vector<char> is_stuck_;  ///< freed without any move since z last changed
};

void Descent::evaluate()
{
    answer_.w = known_.w;
    tolerance_.setConstant(known_.w.size(), kSignTolerance * known_.w.lpNorm<Eigen::Infinity>());
    for (Eigen::Index i = 0; i < answer_.z.size(); ++i) {
        const double change = answer_.z[i] - known_.z[i];
        if (!(std::abs(change) > 0.0)) continue;
        answer_.w += change * qp_.hessian.col(i);
        tolerance_ += kRoundOff * std::abs(change) * qp_.hessian.col(i).cwiseAbs();
    }
}

/// Energy above that of the known z: d^T (w + w_known) / 2, d = z - z_known.
double Descent::energy() const
{
    return 0.5 * (answer_.z - known_.z).dot(answer_.w + known_.w);
}

/// The unknown at a bound whose w has the wrong sign by most; -1 where no sign is wrong.
int Descent::find_wrong() const
{
    int worst = -1;
    double largest = 0.0;
    for (int i = 0; i < static_cast<int>(answer_.stand.size()); ++i) {
        if (answer_.stand[i] == Stand::Between || is_stuck_[i]) continue;
        const double pull = answer_.stand[i] == Stand::AtZero ? -answer_.w[i] : answer_.w[i];
        if (pull <= tolerance_[i] || pull <= largest) continue;
        worst = i;
        largest = pull;
    }
    return worst;
}

bool Descent::is_settled(const std::vector<int>& free) const
{
    return std::all_of(free.begin(), free.end(),
                       [&](int i) { return std::abs(answer_.w[i]) <= tolerance_[i]; });
}

/// Moves the free unknowns once towards their minimum; `is_blocked` where a bound was met.
bool Descent::move(const std::vector<int>& free, bool& is_blocked)
{
    const Eigen::MatrixXd part = qp_.hessian(free, free);
    const Eigen::VectorXd gradient = answer_.w(free);
    Eigen::LLT<Eigen::MatrixXd> cholesky;
    double shift = kLeastShift;
    do {
        Eigen::MatrixXd shifted = part;
        shifted.diagonal().array() += shift;
        cholesky.compute(shifted);
        shift *= kShiftGrowth;
    } while (cholesky.info() != Eigen::Success && shift <= kLargestShift);
    if (cholesky.info() != Eigen::Success) return false;
    const Eigen::VectorXd direction = -cholesky.solve(gradient);
    if (!direction.allFinite()) return false;

    double length = 1.0;
    int first = -1;
    for (std::size_t k = 0; k < free.size(); ++k) {
        const double d = direction[static_cast<Eigen::Index>(k)], z = answer_.z[free[k]];
        const double room = d < 0.0 ? z : qp_.cap[free[k]] - z;
        if (!(std::abs(d) * length > room)) continue;
        length = room / std::abs(d);
        first = static_cast<int>(k);
    }
    for (std::size_t k = 0; k < free.size(); ++k) {
        double& z = answer_.z[free[k]];
        z = std::clamp(z + length * direction[static_cast<Eigen::Index>(k)], 0.0, qp_.cap[free[k]]);
    }
    is_blocked = first >= 0;
    if (!is_blocked) return true;
    const bool is_falling = direction[first] < 0.0;
    answer_.stand[free[first]] = is_falling ? Stand::AtZero : Stand::AtCap;
    answer_.z[free[first]] = is_falling ? 0.0 : qp_.cap[free[first]];
    return true;
}

/// Moves until no bound is met. Finite, as each bound met holds one more unknown.
bool Descent::minimise()
{
    for (int moves = 0; moves < kMostMoves; ++moves) {
        bool is_blocked = true;
        while (is_blocked) {
            std::vector<int> free;
            for (int i = 0; i < static_cast<int>(answer_.stand.size()); ++i)
                if (answer_.stand[i] == Stand::Between) free.push_back(i);
            if (free.empty() || is_settled(free)) return true;
            if (!move(free, is_blocked)) return false;
            evaluate();
            if (!answer_.w.allFinite()) return false;
        }
    }
    return true;
}

bool Descent::run()
{
    const int size = static_cast<int>(answer_.stand.size());
    evaluate();
    if (!minimise()) return false;
    for (int round = 0; round < size + 100; ++round) {
        const int wrong = find_wrong();
        if (wrong < 0) return true;
        const Stand stand = answer_.stand[wrong];
        const double before = energy();
        answer_.stand[wrong] = Stand::Between;
        if (!minimise()) return false;
        const double after = energy();
        if (after < before)
            std::fill(is_stuck_.begin(), is_stuck_.end(), 0);
        else if (answer_.stand[wrong] == stand)
            is_stuck_[wrong] = 1;
    }
    return false;
}

}  // namespace

bool descend(const CondensedQp& qp, const KnownGap& known, CondensedAnswer& answer)
{
    return Descent(qp, known, answer).run();
}

}  // namespace arris
