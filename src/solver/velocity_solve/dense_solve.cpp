// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/dense_solve.h"

#include <cblas.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <limits>
#include <vector>

#include "geometry/batches.h"

extern "C" {
void dgetrf_(const int* rows, const int* columns, double* A, const int* stride, int* pivots, int* info);
void dlaswp_(const int* columns, double* A, const int* stride, const int* first, const int* last,
             const int* pivots, const int* direction);
}

namespace arris {
namespace {

/// Columns that are eliminated at a time, and those of a task.
constexpr int kColumns = 64;

/// Columns first .. last - 1 of a matrix after the elimination of a panel: its swaps of rows, and L^-1.
void eliminate(const Eigen::MatrixXd& A, int panel, int width, const std::vector<int>& pivots,
               Eigen::MatrixXd& target, int first, int last)
{
    const int size = static_cast<int>(A.rows()), columns = last - first, below = size - panel - width;
    const int begin = 1, forward = 1;
    double* top = &target(panel, first);
    const double* factor = &A(panel, panel);
    dlaswp_(&columns, top, &size, &begin, &width, pivots.data(), &forward);
    cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasUnit, width, columns, 1.0, factor,
                size, top, size);
    if (below > 0)
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, below, columns, width, -1.0, factor + width,
                    size, top, size, 1.0, top + width, size);
}

}  // namespace

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
    if (B.size() == 0) return B;
    std::vector<int> pivots(kColumns);
    for (int panel = 0; panel < size; panel += kColumns) {
        const int width = std::min(kColumns, size - panel), rows = size - panel, next = panel + width;
        int info = 0;
        dgetrf_(&rows, &width, &A(panel, panel), &size, pivots.data(), &info);
        if (info != 0) {
            B.setConstant(std::numeric_limits<double>::quiet_NaN());
            return B;
        }
        const int own = (size - next + kColumns - 1) / kColumns, right = (columns + kColumns - 1) / kColumns;
        for_each_batch(own + right, 1, [&](int task, int, int) {
            const bool is_own = task < own;
            Eigen::MatrixXd& target = is_own ? A : B;
            const int first = is_own ? next + task * kColumns : (task - own) * kColumns;
            eliminate(A, panel, width, pivots, target, first,
                      std::min(first + kColumns, static_cast<int>(target.cols())));
        });
    }
    for_each_batch(columns, kColumns, [&](int first, int last, int) {
        cblas_dtrsm(CblasColMajor, CblasLeft, CblasUpper, CblasNoTrans, CblasNonUnit, size, last - first, 1.0,
                    A.data(), size, &B(0, first), size);
    });
    return B;
}

}  // namespace arris
