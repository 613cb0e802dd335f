// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "geometry/vectors.h"
#include "solver/model/settings.h"

namespace arris {

/// sum_k coefficient_k u_(coordinate_k) >= lower. Entries of fixed coordinates are ignored. The row gives way
/// a little: it holds exactly where its multiplier is the expected one.
struct ConstraintRow {
    static constexpr int kMostEntries = 18;  ///< two faces of three vertices
    std::array<int, kMostEntries> coordinate{};
    std::array<double, kMostEntries> coefficient{};
    int count = 0;
    double lower = 0.0;       ///< m/s where the coefficients are weights
    double expected = 0.0;    ///< multiplier, N s where the coefficients are weights
    double compliance = 0.0;  ///< 1/kg, speed per multiplier by which it gives way; 0: nearly none
    int group = 0;            ///< one per cloth face: only the worst row of a group joins at a time
};

/// Friction of one contact: an impulse f in the contact's plane, |f| <= budget, which opposes the slip s. The
/// slip's components are sum_k coefficient_k u_(coordinate_k) - lower in two perpendicular unit directions.
/// As a row, friction gives way a little: it is a stiff spring, f = expected - s / compliance, which yields
/// at the budget. So s is 0 where f is the expected impulse, and f = -budget s / |s| where s is not tiny.
struct FrictionPair {
    std::array<ConstraintRow, 2> slip;  ///< `expected`: impulses, N s
    double budget = 0.0;                ///< N s
    double mass = 0.0;                  ///< kg, that slips with the contact, nearly
    std::array<double, 2> last = {};    ///< m/s, the slip to start the search from
};

struct VelocitySolution;

/// min 1/2 u^T A u - b^T u + sum_pairs (the friction springs' energy) subject to u >= lower, u = 0 where
/// fixed, and rows. Strictly convex for given budgets (Tresca's friction), which the solve moves until they
/// agree with `law`. Three unknowns a vertex.
struct VelocityProblem {
    const Eigen::SparseMatrix<double>* matrix = nullptr;  ///< A, SPD: whole 3x3 blocks of the lower triangle
    const Eigen::VectorXd* rhs = nullptr;                 ///< b
    /// Of the vertices in a plane, nearly: unknowns are then ordered by dissecting it, else by METIS.
    const std::vector<Vec2>* places = nullptr;
    Eigen::VectorXd lower;       ///< -infinity where there is no bound
    std::vector<char> is_fixed;  ///< pinned: u = 0, whatever the bound
    std::vector<int> guess;      ///< coordinates expected active, ascending (warm start)
    std::vector<ConstraintRow> rows;
    std::vector<int> row_guess;  ///< rows expected active, ascending
    std::vector<FrictionPair> friction;
    /// Budgets, N s, one a friction pair, that the forces of a solution give: Coulomb's law. Without it the
    /// given budgets hold.
    std::function<std::vector<double>(const VelocitySolution&)> law;
    double most_work = 60.0;  ///< of a call, in factorisations' worth; then it is NotConverged
    bool is_repeat =
        false;  ///< may have the contacts of the problem solved last: then it starts from that answer
};

enum class SolveStatus { Certified, NotConverged, NotFinite, Infeasible };

/// The answer and how it was reached. `kkt_residual` is recomputed from A, b and the bounds alone.
struct VelocitySolution {
    SolveStatus status = SolveStatus::NotConverged;
    Eigen::VectorXd velocity;         ///< u
    Eigen::VectorXd multipliers;      ///< lambda, one a coordinate: >= 0 but for round-off, 0 without a bound
    Eigen::VectorXd row_multipliers;  ///< >= 0, one a row
    std::vector<Eigen::Vector2d> friction;   ///< impulses, N s, one a friction pair
    std::vector<Eigen::Vector2d> slip;       ///< m/s, one a friction pair
    std::vector<Eigen::Vector2d> unlimited;  ///< N s, `friction` if the budgets were infinite
    std::vector<double> budgets;             ///< N s, with which these were found
    double law_residual = 0.0;  ///< greatest |friction - the law's for the forces| / largest budget
    int law_worst = -1;         ///< friction pair with that difference
    int budget_moves = 0;
    double work = 0.0;                 ///< in factorisations' worth
    std::vector<int> infeasible_rows;  ///< not met; all hold as well as possible
    double kkt_residual = 0.0;
    int factorisations = 0;
    int nlopt_evaluations = 0;
    double factorise_seconds = 0.0;  ///< wall, numeric factorisation
    double solve_seconds = 0.0;      ///< wall, all else, symbolic analysis included

    void add_cost(const VelocitySolution& other)
    {
        factorisations += other.factorisations;
        nlopt_evaluations += other.nlopt_evaluations;
        factorise_seconds += other.factorise_seconds;
    }
};

/// No motion and no multipliers.
VelocitySolution make_zero_solution(const VelocityProblem& problem);

/// Solves the constrained velocity step by Newton's method on the energy of contacts as springs
/// (contact_newton.h). A KKT certificate accepts the answer. Keeps the symbolic analysis between solves while
/// the pattern stays.
class VelocitySolver {
  public:
    VelocitySolver();
    ~VelocitySolver();
    VelocitySolver(VelocitySolver&&) noexcept;
    VelocitySolver& operator=(VelocitySolver&&) noexcept;

    VelocitySolution solve(const VelocityProblem& problem, const Settings& settings);

    /// `solve` for a problem to which rows were appended since this solver's last call; otherwise only
    /// most_work may have changed. Goes on from the last factor and answer.
    VelocitySolution resume(const VelocityProblem& problem, const Settings& settings);

  private:
    struct Cache;
    std::unique_ptr<Cache> cache_;
};

}  // namespace arris
