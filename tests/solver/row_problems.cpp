// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/solver/row_problems.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "solver/velocity_solve/constraint_rows.h"

namespace arris::testing {
namespace {

using Real = long double;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

/// The constraint matrix C over the coordinates that are not fixed, with one row for each row of the problem.
Matrix dense_rows(const VelocityProblem& problem)
{
    Matrix c = Matrix::Zero(static_cast<Eigen::Index>(problem.rows.size()), problem.rhs->size());
    for (std::size_t k = 0; k < problem.rows.size(); ++k)
        for (int e = 0; e < problem.rows[k].count; ++e) {
            const int i = problem.rows[k].coordinate[e];
            if (!problem.is_fixed[i]) c(static_cast<Eigen::Index>(k), i) += problem.rows[k].coefficient[e];
        }
    return c;
}

std::array<double, 3> random_point(std::mt19937& random)
{
    std::uniform_real_distribution<double> chance;
    const double a = chance(random), b = chance(random), low = std::min(a, b), high = std::max(a, b);
    return {low, high - low, 1.0 - high};
}

/// Faces in the order in which a pattern uses them.
std::vector<int> faces_of(RowPattern pattern, int side, int count, std::mt19937& random)
{
    std::vector<int> order(static_cast<std::size_t>(2 * (side - 1) * (side - 1)));
    for (std::size_t f = 0; f < order.size(); ++f) order[f] = static_cast<int>(f);
    std::shuffle(order.begin(), order.end(), random);
    if (pattern == RowPattern::Patch) {
        const auto distance = [side](int face) {
            const double row = face / 2 / (side - 1), column = face / 2 % (side - 1), middle = 0.5 * side;
            return std::hypot(row - middle, column - middle);
        };
        std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return distance(a) < distance(b); });
    }
    const std::size_t distinct =
        pattern == RowPattern::Spread || pattern == RowPattern::Patch ? order.size() : 40;
    std::vector<int> faces;
    for (int k = 0; k < count; ++k) faces.push_back(order[k % std::min(distinct, order.size())]);
    return faces;
}

/// Multipliers that meet w = `w0` + s z >= 0, z >= 0, w z = 0 to round-off if those that are positive in `z`
/// press and no others; nothing where they do not. Sweeps converge slowly where rows depend on others, long
/// after they have found which ones press. `is_row`: 0 for rows of fixed
/// coordinates alone.
std::optional<Vector> finish_sweeps(const Matrix& s, const std::vector<char>& is_row, const Vector& w0,
                                    const Vector& z)
{
    constexpr Real kRoundOff = 1e-16L;
    std::vector<int> pressing;
    for (Eigen::Index k = 0; k < z.size(); ++k)
        if (z[k] > 0) pressing.push_back(static_cast<int>(k));
    Vector found = Vector::Zero(z.size());
    if (!pressing.empty()) {
        const Eigen::LDLT<Matrix> factors(Matrix(s(pressing, pressing)));
        for (int refined = 0; refined < 3; ++refined)
            found(pressing) += factors.solve(Vector(-(w0 + s * found)(pressing)));
    }
    if (found.size() == 0 || !(found.minCoeff() >= 0)) return std::nullopt;
    const Vector w = w0 + s * found, allowed = kRoundOff * (w0.cwiseAbs() + s.cwiseAbs() * found);
    for (Eigen::Index k = 0; k < z.size(); ++k) {
        const bool is_met = z[k] > 0 ? std::abs(w[k]) <= allowed[k] : w[k] >= -allowed[k];
        if (is_row[k] && !is_met) return std::nullopt;
    }
    return found;
}

}  // namespace

std::vector<std::array<int, 3>> grid_faces(int side)
{
    std::vector<std::array<int, 3>> faces;
    for (int row = 0; row + 1 < side; ++row)
        for (int column = 0; column + 1 < side; ++column) {
            const int a = row * side + column, b = a + 1, c = a + side, d = c + 1;
            faces.push_back({a, b, d});
            faces.push_back({a, d, c});
        }
    return faces;
}

ConstraintRow make_point_row(const std::array<int, 3>& face, const std::array<double, 3>& weights,
                             const Eigen::Vector3d& direction, double lower, int group)
{
    ConstraintRow row;
    for (int v = 0; v < 3; ++v)
        for (int d = 0; d < 3; ++d) {
            row.coordinate[row.count] = 3 * face[v] + d;
            row.coefficient[row.count++] = weights[v] * direction[d];
        }
    row.lower = lower;
    row.group = group;
    return row;
}

std::vector<ConstraintRow> make_rows(const ClothShape& shape, const Eigen::VectorXd& velocity,
                                     RowPattern pattern, int count, double speed, unsigned seed)
{
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const std::vector<std::array<int, 3>> faces = grid_faces(shape.side);
    std::vector<std::array<double, 3>> centre(faces.size());
    for (auto& weights : centre) weights = random_point(random);
    std::vector<ConstraintRow> rows;
    for (const int face : faces_of(pattern, shape.side, count, random)) {
        std::array<double, 3> weights = random_point(random);
        if (pattern == RowPattern::NearlyEqual)
            for (int v = 0; v < 3; ++v) weights[v] = centre[face][v] + 1e-6 * (weights[v] - centre[face][v]);
        const Eigen::Vector3d direction =
            Eigen::Vector3d(0.1 * normal(random), 0.1 * normal(random), 1.0).normalized();
        ConstraintRow row = make_point_row(faces[face], weights, direction, 0.0, face);
        for (int e = 0; e < row.count; ++e) row.lower += row.coefficient[e] * velocity[row.coordinate[e]];
        const double x = faces[face][0] % shape.side / (shape.side - 1.0),
                     y = faces[face][0] / shape.side / (shape.side - 1.0);
        row.lower += speed * (std::sin(29 * x + 2) * std::cos(23 * y) + 0.1 * normal(random));
        rows.push_back(row);
    }
    return rows;
}

Eigen::VectorXd find_compliances(const VelocityProblem& problem)
{
    const ConstraintRows constraints = scale_rows(problem, estimate_free_speed(problem));
    Eigen::VectorXd compliances(static_cast<Eigen::Index>(problem.rows.size()));
    for (Eigen::Index k = 0; k < compliances.size(); ++k)
        compliances[k] =
            constraints.rows[k].compliance * constraints.rows[k].scale * constraints.rows[k].scale;
    return compliances;
}

HildrethAnswer solve_by_hildreth(const VelocityProblem& problem)
{
    const Vector compliances = find_compliances(problem).cast<Real>();
    std::vector<int> free, bounded;
    for (int i = 0; i < problem.lower.size(); ++i)
        if (!problem.is_fixed[i]) free.push_back(i);
    for (const int i : free)
        if (std::isfinite(problem.lower[i])) bounded.push_back(i);
    const Matrix a = dense_symmetric(*problem.matrix).cast<Real>()(free, free);
    const Eigen::Index bounds = static_cast<Eigen::Index>(bounded.size()), rows = compliances.size();
    Matrix c = Matrix::Zero(bounds + rows, problem.rhs->size());
    Vector lower(bounds + rows);
    for (Eigen::Index k = 0; k < bounds; ++k) {
        c(k, bounded[k]) = 1;
        lower[k] = problem.lower[bounded[k]];
    }
    c.bottomRows(rows) = dense_rows(problem);
    for (Eigen::Index k = 0; k < rows; ++k) lower[bounds + k] = problem.rows[k].lower;
    const Matrix g = c(Eigen::all, free);
    const Eigen::LLT<Matrix> cholesky(a);
    const Matrix moved = cholesky.solve(Matrix(g.transpose()));
    const Vector start = cholesky.solve(Vector(problem.rhs->cast<Real>()(free)));
    Matrix s = g * moved;
    s.diagonal().tail(rows) += compliances;
    const Vector w0 = g * start - lower;
    Vector z = Vector::Zero(bounds + rows), w = w0;
    std::vector<char> is_row;
    for (Eigen::Index k = 0; k < z.size(); ++k) is_row.push_back(g.row(k).any());
    constexpr int kSweepsToFinish = 20;
    for (int sweep = 1; sweep <= 4000000; ++sweep) {
        Real change = 0;
        for (Eigen::Index k = 0; k < z.size(); ++k) {
            if (!is_row[k]) continue;
            const Real next = std::max(z[k] - w[k] / s(k, k), Real(0)), step = next - z[k];
            z[k] = next;
            w += step * s.col(k);
            change = std::max(change, std::abs(step) * std::sqrt(s(k, k)));
        }
        if (change < 1e-17L * std::max(z.cwiseAbs().maxCoeff(), Real(1e-30L))) break;
        if (sweep % kSweepsToFinish != 0) continue;
        if (const std::optional<Vector> found = finish_sweeps(s, is_row, w0, z)) {
            z = *found;
            break;
        }
    }
    HildrethAnswer answer = {Eigen::VectorXd::Zero(problem.rhs->size()),
                             Eigen::VectorXd::Zero(problem.rhs->size()), z.tail(rows).cast<double>()};
    const Vector u = start + moved * z;
    for (std::size_t k = 0; k < free.size(); ++k)
        answer.velocity[free[k]] = static_cast<double>(u[static_cast<Eigen::Index>(k)]);
    for (Eigen::Index k = 0; k < bounds; ++k) answer.multipliers[bounded[k]] = static_cast<double>(z[k]);
    return answer;
}

double dense_kkt_residual_of_rows(const VelocityProblem& problem, const VelocitySolution& solution)
{
    const Vector compliances = find_compliances(problem).cast<Real>();
    const Matrix a = dense_symmetric(*problem.matrix).cast<Real>(), c = dense_rows(problem);
    const Vector u = solution.velocity.cast<Real>(), b = problem.rhs->cast<Real>(),
                 force = solution.multipliers.cast<Real>(), z = solution.row_multipliers.cast<Real>();
    const Vector error = (a * u - b - force - c.transpose() * z).cwiseAbs();
    const Vector scale = a.cwiseAbs() * u.cwiseAbs() + b.cwiseAbs() + force.cwiseAbs() +
                         c.cwiseAbs().transpose() * z.cwiseAbs();
    const Vector size = c.rows() ? Vector(c.cwiseAbs().rowwise().maxCoeff()) : Vector();
    const Real speed = u.cwiseAbs().maxCoeff();
    Real impulse = force.cwiseAbs().maxCoeff(), worst = 0;
    for (Eigen::Index k = 0; k < z.size(); ++k) impulse = std::max(impulse, std::abs(z[k]) * size[k]);
    const auto count = [&](Real value, Real by) {
        if (value > 0) worst = std::max(worst, value / by);
        if (std::isnan(value)) worst = std::numeric_limits<Real>::infinity();
    };
    const auto count_pair = [&](Real gap, Real multiplier) {
        count(-gap, speed);
        count(-multiplier, impulse);
        if (std::abs(multiplier) > 0) count(std::abs(multiplier * gap), impulse * speed);
    };
    for (int i = 0; i < u.size(); ++i) {
        if (problem.is_fixed[i]) {
            count(std::abs(u[i]), speed);
            continue;
        }
        count(error[i], scale[i]);
        count_pair(u[i] - problem.lower[i], force[i]);
    }
    for (Eigen::Index k = 0; k < z.size(); ++k)
        if (size[k] > 0)
            count_pair((c.row(k).dot(u) - problem.rows[k].lower + compliances[k] * z[k]) / size[k],
                       z[k] * size[k]);
    return static_cast<double>(worst);
}

}  // namespace arris::testing
