// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/pinned_base.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/velocity_solve/symmetric_product.h"

namespace arris {

namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// The stored value at (row, column); null where the pattern has none.
double* find_entry(Matrix& matrix, int row, int column)
{
    const int *begin = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column],
              *end = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column + 1];
    const int* at = std::lower_bound(begin, end, row);
    return at == end || *at != row ? nullptr : matrix.valuePtr() + (at - matrix.innerIndexPtr());
}

bool is_one_vertex(int a, int b)
{
    return a / 3 == b / 3;
}

/// Adds g g^T / give to the lower triangle and the whole diagonal blocks.
void add_spring(const ScaledRow& row, Matrix& matrix)
{
    for (const auto& [i, a] : row.entries)
        for (const auto& [j, b] : row.entries)
            if (i >= j || is_one_vertex(i, j)) *find_entry(matrix, i, j) += a * b / row.give;
}

/// Adds g^T K g of a pair's spring likewise.
void add_slip_spring(const ScaledRow* rows, const Eigen::Matrix2d& stiffness, Matrix& matrix)
{
    for (int d = 0; d < 2; ++d)
        for (int e = 0; e < 2; ++e)
            for (const auto& [i, a] : rows[d].entries)
                for (const auto& [j, b] : rows[e].entries)
                    if (i >= j || is_one_vertex(i, j)) *find_entry(matrix, i, j) += stiffness(d, e) * a * b;
}

/// Whether the matrix has an entry for each pair of the coordinates of both rows.
bool has_room_for_pair(const Matrix& matrix, const ScaledRow* rows)
{
    ScaledRow both = rows[0];
    both.entries.insert(both.entries.end(), rows[1].entries.begin(), rows[1].entries.end());
    return has_room_for(matrix, both);
}

void add_springs(PinnedBase& base)
{
    const std::vector<ScaledRow>& rows = base.constraints->rows;
    const auto matrix = [&]() -> Matrix& {
        if (base.with_rows.size() == 0) base.with_rows = *base.problem->matrix;
        return base.with_rows;
    };
    for (std::size_t k = 0; k < base.is_pressing.size(); ++k)
        if (base.is_pressing[k]) add_spring(rows[k], matrix());
    for (std::size_t p = 0; p < base.slips.size(); ++p) {
        SlipSpring& spring = base.slips[p];
        if (!spring.is_in_matrix()) continue;
        if (has_room_for_pair(*base.problem->matrix, &rows[2 * p]))
            add_slip_spring(&rows[2 * p], spring.stiffness, matrix());
        else
            spring = {};  // the working set finds its impulse
    }
}

/// Sets gradient and magnitude from velocity and row multipliers.
void sum_gradient(const PinnedBase& base, Iterate& iterate)
{
    const VelocityProblem& problem = *base.problem;
    const std::vector<ScaledRow>& rows = base.constraints->rows;
    SymmetricProduct product = symmetric_product_with_magnitude(*problem.matrix, iterate.velocity);
    iterate.gradient = std::move(product.value) - *problem.rhs;
    iterate.magnitude = std::move(product.magnitude) + problem.rhs->cwiseAbs();
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const double multiplier = iterate.row_multipliers[static_cast<Eigen::Index>(k)];
        if (!(std::abs(multiplier) > 0.0)) continue;
        for (const auto& [coordinate, coefficient] : rows[k].entries) {
            iterate.gradient[coordinate] -= coefficient * multiplier;
            iterate.magnitude[coordinate] += std::abs(coefficient * multiplier);
        }
    }
}

}  // namespace

bool has_room_for(const Matrix& matrix, const ScaledRow& row)
{
    for (const auto& [i, a] : row.entries)
        for (const auto& [j, b] : row.entries)
            if (i > j && find_entry(const_cast<Matrix&>(matrix), i, j) == nullptr) return false;
    return true;
}

void evaluate_gradient(const PinnedBase& base, Iterate& iterate)
{
    const std::vector<ScaledRow>& rows = base.constraints->rows;
    for (std::size_t k = 0; k < base.is_pressing.size(); ++k)
        if (base.is_pressing[k])
            iterate.row_multipliers[static_cast<Eigen::Index>(k)] =
                iterate.has_let_go[k] ? 0.0 : -gap(rows[k], iterate.velocity, 0.0) / rows[k].give;
    for (int p = 0; p < base.constraints->pair_count(); ++p)
        if (!iterate.is_exact[p])
            iterate.row_multipliers.segment<2>(2 * p) =
                base.slips[p].at(slip_of(*base.constraints, p, iterate.velocity));
    sum_gradient(base, iterate);
}

void correct(const PinnedBase& base, const Eigen::VectorXd& change, Iterate& iterate)
{
    iterate.velocity += change;
    for (std::size_t k = 0; k < base.is_pressing.size(); ++k) {
        if (!base.is_pressing[k] || iterate.has_let_go[k]) continue;
        const ScaledRow& row = base.constraints->rows[k];
        for (const auto& [coordinate, coefficient] : row.entries)
            iterate.row_multipliers[static_cast<Eigen::Index>(k)] -=
                coefficient * change[coordinate] / row.give;
    }
    for (int p = 0; p < base.constraints->pair_count(); ++p)
        if (!iterate.is_exact[p])
            iterate.row_multipliers.segment<2>(2 * p) -=
                base.slips[p].stiffness * slip_of(*base.constraints, p, change);
    sum_gradient(base, iterate);
}

std::vector<char> find_pinned(const VelocityProblem& problem, const std::vector<char>& is_active)
{
    std::vector<char> is_pinned = is_active;
    for (std::size_t i = 0; i < is_pinned.size(); ++i) is_pinned[i] = is_active[i] || problem.is_fixed[i];
    return is_pinned;
}

std::optional<PinnedBase> solve_pinned(const VelocityProblem& problem, const ConstraintRows& constraints,
                                       const std::vector<char>& is_active, std::vector<char> is_pressing,
                                       std::vector<SlipSpring> slips, Factorization& factorization)
{
    PinnedBase base = {&problem,
                       &constraints,
                       &factorization,
                       std::move(is_pressing),
                       std::move(slips),
                       {},
                       find_pinned(problem, is_active),
                       {},
                       {}};
    base.iterate.is_active = is_active;
    add_springs(base);
    if (!factorization.factorise(base.matrix(), base.is_pinned)) return std::nullopt;
    solve_with_forces(base);
    return base;
}

void solve_with_forces(PinnedBase& base)
{
    const VelocityProblem& problem = *base.problem;
    const ConstraintRows& constraints = *base.constraints;
    const std::vector<char> is_active = base.iterate.is_active;
    Eigen::VectorXd rhs = *problem.rhs;
    for (std::size_t k = 0; k < base.is_pressing.size(); ++k) {
        if (!base.is_pressing[k]) continue;
        const ScaledRow& row = constraints.rows[k];
        for (const auto& [coordinate, value] : row.entries) rhs[coordinate] += value * row.lower / row.give;
    }
    for (std::size_t p = 0; p < base.slips.size(); ++p)
        for (int d = 0; d < 2; ++d)
            for (const auto& [coordinate, value] : constraints.rows[2 * p + d].entries)
                rhs[coordinate] += value * base.slips[p].force[d];
    Eigen::VectorXd held = Eigen::VectorXd::Zero(problem.rhs->size());
    for (int i = 0; i < held.size(); ++i)
        if (is_active[i]) held[i] = problem.lower[i];
    rhs -= symmetric_product(base.matrix(), held);
    for (int i = 0; i < held.size(); ++i)
        if (base.is_pinned[i]) rhs[i] = 0.0;
    base.forward = base.factorization->solve_forward(rhs);
    base.iterate = {base.factorization->solve_backward(base.forward) + held,
                    is_active,
                    Eigen::VectorXd::Zero(static_cast<Eigen::Index>(constraints.rows.size())),
                    {},
                    {},
                    std::vector<char>(base.slips.size(), 0),
                    std::vector<char>(constraints.rows.size(), 0)};
    evaluate_gradient(base, base.iterate);
}

}  // namespace arris
