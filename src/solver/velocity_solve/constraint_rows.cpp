// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/constraint_rows.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "solver/velocity_solve/symmetric_product.h"

namespace arris {
namespace {

/// Stiffness of a row, in units of 1 / (g^T D^-1 g). With 1e3, cloth on a knife's edge slips between its
/// rows; with 1e5, the matrix of dependent rows is so badly conditioned that more steps are halved.
constexpr double kStiffness = 1e4;

/// Share of the free speed by which a row gives way that cannot be met. Multipliers of rows that can be met
/// stay below 0.1 free speed / (g^T D^-1 g), so these give way by less than 1e-5 of the speed.
constexpr double kUnmet = 1e-2;

/// Largest speed that a row may ask of what can move, over the free speed. A row of which only a tiny part
/// can move may ask for any speed; its spring would throw that part.
constexpr double kMostSpeed = 10.0;

/// Round-off of a sum of 18 terms, relative to its largest term.
constexpr double kRoundOff = 1e-14;

/// Least scale of speeds, relative to the free speed. Where rows bring everything to rest, the remaining
/// velocities, gaps and forces are round-off, about 1e-16 of the forces held back. Ratios between them mean
/// nothing.
constexpr double kLeastSpeed = 1e-6;

/// Conjugate-gradient steps that estimate the free speed: the first finds rigid motion, the others shorter
/// waves.
constexpr int kSpeedSteps = 4;

double largest_coefficient(const ConstraintRow& row)
{
    double largest = 0.0;
    for (int k = 0; k < row.count; ++k) largest = std::max(largest, std::abs(row.coefficient[k]));
    return largest;
}

/// The diagonal of A, with 1 in place of entries that are not positive: such a matrix is not positive
/// definite, or the coordinate is fixed.
Eigen::VectorXd positive_diagonal(const Eigen::SparseMatrix<double>& matrix)
{
    Eigen::VectorXd diagonal = matrix.diagonal();
    for (double& value : diagonal)
        if (!(value > 0.0)) value = 1.0;
    return diagonal;
}

/// One entry per coordinate that can move, ascending, without entries below round-off.
RowEntries movable_entries(const VelocityProblem& problem, const ConstraintRow& row)
{
    RowEntries entries;
    for (int k = 0; k < row.count; ++k) {
        assert(row.coordinate[k] >= 0 && row.coordinate[k] < problem.rhs->size());
        if (!problem.is_fixed[row.coordinate[k]]) entries.emplace_back(row.coordinate[k], row.coefficient[k]);
    }
    std::stable_sort(entries.begin(), entries.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    RowEntries merged;
    for (const auto& [coordinate, value] : entries)
        if (!merged.empty() && merged.back().first == coordinate)
            merged.back().second += value;
        else
            merged.emplace_back(coordinate, value);
    const double negligible = kRoundOff * largest_coefficient(row);
    const auto is_negligible = [&](const auto& entry) { return !(std::abs(entry.second) > negligible); };
    merged.erase(std::remove_if(merged.begin(), merged.end(), is_negligible), merged.end());
    return merged;
}

ScaledRow scale_row(const VelocityProblem& problem, const Eigen::VectorXd& diagonal, const ConstraintRow& row)
{
    ScaledRow scaled;
    scaled.group = row.group;
    if (row.lower == -std::numeric_limits<double>::infinity()) return scaled;  // no bound
    scaled.entries = movable_entries(problem, row);
    if (scaled.entries.empty()) return scaled;
    scaled.scale = 0.0;
    for (const auto& [coordinate, value] : scaled.entries)
        scaled.scale = std::max(scaled.scale, std::abs(value));
    scaled.lower = row.lower / scaled.scale;
    scaled.mobility = 0.0;
    for (auto& [coordinate, value] : scaled.entries) {
        value /= scaled.scale;
        scaled.mobility += value * value / diagonal[coordinate];
    }
    scaled.spring = row.compliance / (scaled.scale * scaled.scale);
    scaled.compliance = std::max(scaled.spring, scaled.mobility / kStiffness);
    return scaled;
}

/// Both rows of a pair get one scale and one compliance, so that the budget's disc stays a disc. A direction
/// in which nothing can move keeps an empty row.
void add_pair(const VelocityProblem& problem, const Eigen::VectorXd& diagonal, const FrictionPair& pair,
              ConstraintRows& result)
{
    std::array<ScaledRow, 2> rows;
    double scale = 0.0, mobility = 0.0;
    for (int d = 0; d < 2; ++d) {
        rows[d].entries = movable_entries(problem, pair.slip[d]);
        for (const auto& [coordinate, value] : rows[d].entries) scale = std::max(scale, std::abs(value));
    }
    const bool can_move = scale > 0.0;
    if (!can_move) scale = 1.0;
    for (ScaledRow& row : rows) {
        double sum = 0.0;
        for (auto& [coordinate, value] : row.entries) {
            value /= scale;
            sum += value * value / diagonal[coordinate];
        }
        mobility = std::max(mobility, sum);
    }
    if (!can_move) mobility = 1.0;
    for (int d = 0; d < 2; ++d) {
        rows[d].scale = scale;
        rows[d].mobility = mobility;
        rows[d].compliance = mobility / kStiffness;
        rows[d].lower = pair.slip[d].lower / scale + rows[d].compliance * pair.slip[d].expected * scale;
        result.rows.push_back(rows[d]);
    }
    result.budgets.push_back(can_move ? pair.budget * scale : 0.0);
    result.masses.push_back(pair.mass * scale * scale);
    result.is_finite = result.is_finite && is_well_formed(pair) && std::isfinite(1.0 / rows[0].compliance);
}

}  // namespace

bool is_well_formed(const ConstraintRow& row)
{
    if (!(row.lower < std::numeric_limits<double>::infinity())) return false;
    for (int k = 0; k < row.count; ++k)
        if (!std::isfinite(row.coefficient[k])) return false;
    return true;
}

bool is_well_formed(const FrictionPair& pair)
{
    const auto is_slip = [](const ConstraintRow& row) {
        return is_well_formed(row) && std::isfinite(row.lower) && std::isfinite(row.expected);
    };
    return is_slip(pair.slip[0]) && is_slip(pair.slip[1]) && std::isfinite(pair.budget);
}

ConstraintRows scale_rows(const VelocityProblem& problem, double free_speed)
{
    ConstraintRows result;
    if (problem.rows.empty() && problem.friction.empty()) return result;
    const Eigen::VectorXd diagonal = positive_diagonal(*problem.matrix);
    for (const FrictionPair& pair : problem.friction) add_pair(problem, diagonal, pair, result);
    if (!result.is_finite) return result;
    const std::size_t first = result.rows.size();
    double speed = free_speed;
    for (int i = 0; i < problem.lower.size(); ++i)
        if (!problem.is_fixed[i]) speed = std::max(speed, problem.lower[i]);
    for (const ConstraintRow& row : problem.rows) {
        result.is_finite = result.is_finite && is_well_formed(row);
        if (!result.is_finite) return result;
        result.rows.push_back(scale_row(problem, diagonal, row));
        const bool can_move = !result.rows.back().entries.empty();
        if (!can_move && row.lower > 0.0 && !(row.compliance > 0.0))
            result.impossible.push_back(static_cast<int>(result.rows.size() - first) - 1);
        // The speed that the row needs over all its coordinates: if only a tiny part can move, that part may
        // need any speed.
        if (can_move) speed = std::max(speed, row.lower / largest_coefficient(row));
    }
    result.least_speed = kLeastSpeed * speed;
    result.unmet_speed = kUnmet * speed;
    for (std::size_t k = 0; k < problem.rows.size(); ++k) {
        ScaledRow& row = result.rows[first + k];
        if (row.entries.empty()) continue;
        if (row.lower > kMostSpeed * speed) {
            row.lower = kMostSpeed * speed;
            result.impossible.push_back(static_cast<int>(k));
        }
        row.lower += std::min((row.compliance - row.spring) * problem.rows[k].expected * row.scale,
                              result.unmet_speed);
        result.is_finite =
            result.is_finite && std::isfinite(1.0 / row.compliance) && std::isfinite(row.lower);
    }
    return result;
}

/// Conjugate gradients on A u = b, preconditioned by the diagonal: their iterates grow towards A^-1 b from
/// below (Steihaug 1983, Theorem 2.1). Computed in units of |D^-1 b|, so that squares neither overflow nor
/// vanish.
double estimate_free_speed(const VelocityProblem& problem)
{
    const Eigen::VectorXd diagonal = positive_diagonal(*problem.matrix);
    const auto hold_fixed = [&](Eigen::VectorXd& vector) {
        for (int i = 0; i < vector.size(); ++i)
            if (problem.is_fixed[i]) vector[i] = 0.0;
    };
    Eigen::VectorXd velocity = problem.rhs->cwiseQuotient(diagonal);
    hold_fixed(velocity);
    const double unit = velocity.lpNorm<Eigen::Infinity>();
    if (!(unit > 0.0) || !std::isfinite(unit)) return unit;

    Eigen::VectorXd residual = *problem.rhs / unit, preconditioned = velocity / unit,
                    direction = preconditioned;
    hold_fixed(residual);
    velocity.setZero();
    double product = residual.dot(preconditioned), largest = 1.0;
    for (int step = 0; step < kSpeedSteps; ++step) {
        Eigen::VectorXd image = symmetric_product(*problem.matrix, direction);
        hold_fixed(image);
        const double length = product / direction.dot(image);
        if (!(length > 0.0) || !std::isfinite(length)) break;
        velocity += length * direction;
        largest = std::max(largest, velocity.lpNorm<Eigen::Infinity>());
        residual -= length * image;
        preconditioned = residual.cwiseQuotient(diagonal);
        const double next = residual.dot(preconditioned);
        direction = preconditioned + next / product * direction;
        product = next;
    }
    return unit * largest;
}

double gap(const ScaledRow& row, const Eigen::VectorXd& velocity, double multiplier)
{
    double value = row.compliance * multiplier;
    for (const auto& [coordinate, coefficient] : row.entries) value += coefficient * velocity[coordinate];
    return value - row.lower;
}

std::vector<int> find_infeasible_rows(const ConstraintRows& constraints, const Eigen::VectorXd& multipliers)
{
    std::vector<int> infeasible = constraints.impossible;
    const int first = constraints.slip_count();
    for (std::size_t k = first; k < constraints.rows.size(); ++k) {
        const ScaledRow& row = constraints.rows[k];
        if (row.entries.empty()) continue;
        if ((row.compliance - row.spring) * multipliers[static_cast<Eigen::Index>(k)] >
            constraints.unmet_speed)
            infeasible.push_back(static_cast<int>(k) - first);
    }
    std::sort(infeasible.begin(), infeasible.end());
    infeasible.erase(std::unique(infeasible.begin(), infeasible.end()), infeasible.end());
    return infeasible;
}

}  // namespace arris
