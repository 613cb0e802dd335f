// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/dense_solve.h"

#include <Eigen/Cholesky>
#include <cassert>
#include <limits>
#include <vector>

extern "C" void dgesv_(const int* size, const int* columns, double* A, const int* stride_A, int* pivots,
                       double* B, const int* stride_B, int* info);

namespace arris {

std::optional<RefinedSolution> solve_refined(const Eigen::MatrixXd& A, const Eigen::MatrixXd& shifted,
                                             const Eigen::VectorXd& b)
{
    const Eigen::LLT<Eigen::MatrixXd> cholesky(shifted);
    if (cholesky.info() != Eigen::Success) return std::nullopt;
    RefinedSolution solution = {cholesky.solve(b), 0.0};
    for (int refinement = 0; refinement < 2; ++refinement) {
        const Eigen::VectorXd change = cholesky.solve(b - A * solution.x);
        solution.last_change = change.lpNorm<Eigen::Infinity>();
        solution.x += change;
    }
    return solution;
}

Eigen::MatrixXd solve_dense(Eigen::MatrixXd A, Eigen::MatrixXd B)
{
    assert(A.rows() == A.cols() && A.rows() == B.rows());
    const int size = static_cast<int>(A.rows()), columns = static_cast<int>(B.cols());
    if (size == 0 || columns == 0) return B;
    std::vector<int> pivots(static_cast<std::size_t>(size));
    int info = 0;
    dgesv_(&size, &columns, A.data(), &size, pivots.data(), B.data(), &size, &info);
    if (info != 0) B.setConstant(std::numeric_limits<double>::quiet_NaN());
    return B;
}

}  // namespace arris
