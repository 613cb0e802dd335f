// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/solver/cloth_system.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace arris::testing {
namespace {

using Eigen::Vector3d;
using Entries = std::vector<Eigen::Triplet<double>>;

void add_block(Entries& entries, int i, int j, const Eigen::Matrix3d& block)
{
    if (i < j) return;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) entries.emplace_back(3 * i + r, 3 * j + c, block(r, c));
}

/// Constant-strain triangle in its own plane, unstressed at the given shape.
void add_stretch(Entries& entries, const std::array<int, 3>& face, const std::vector<Vector3d>& x,
                 double factor)
{
    const Vector3d a = x[face[1]] - x[face[0]], b = x[face[2]] - x[face[0]];
    const Vector3d e1 = a.normalized(), normal = a.cross(b).normalized(), e2 = normal.cross(e1);
    const double area = 0.5 * a.cross(b).norm(), poisson = 0.3;
    Eigen::Matrix2d edges;
    edges << a.dot(e1), b.dot(e1), a.dot(e2), b.dot(e2);
    const Eigen::Matrix2d inverse = edges.inverse();
    Eigen::Matrix<double, 3, 9> strain;
    for (int v = 0; v < 3; ++v) {
        const Eigen::Vector2d g =
            v == 0 ? Eigen::Vector2d(-inverse.row(0) - inverse.row(1)) : Eigen::Vector2d(inverse.row(v - 1));
        strain.block<1, 3>(0, 3 * v) = g[0] * e1.transpose();
        strain.block<1, 3>(1, 3 * v) = g[1] * e2.transpose();
        strain.block<1, 3>(2, 3 * v) = g[1] * e1.transpose() + g[0] * e2.transpose();
    }
    Eigen::Matrix3d law;
    law << 1, poisson, 0, poisson, 1, 0, 0, 0, 0.5 * (1 - poisson);
    const Eigen::Matrix<double, 9, 9> stiffness =
        factor * area / (1 - poisson * poisson) * strain.transpose() * law * strain;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) add_block(entries, face[i], face[j], stiffness.block<3, 3>(3 * i, 3 * j));
}

double cotangent(const Vector3d& a, const Vector3d& b)
{
    return a.dot(b) / a.cross(b).norm();
}

/// Isometric bending: 3 / (area) (k^T x)^2 with cotangent weights k over the hinge's edge (0, 1) and wings
/// (2, 3).
void add_bending(Entries& entries, const std::array<int, 4>& hinge, const std::vector<Vector3d>& x,
                 double factor)
{
    const auto edge = [&](int i, int j) -> Vector3d { return x[hinge[j]] - x[hinge[i]]; };
    const double c02 = cotangent(edge(0, 1), edge(0, 2)), c03 = cotangent(edge(0, 1), edge(0, 3)),
                 c12 = cotangent(edge(1, 0), edge(1, 2)), c13 = cotangent(edge(1, 0), edge(1, 3));
    const Eigen::Vector4d k(c12 + c13, c02 + c03, -(c02 + c12), -(c03 + c13));
    const double area = 0.5 * (edge(0, 1).cross(edge(0, 2)).norm() + edge(0, 1).cross(edge(0, 3)).norm());
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            add_block(entries, hinge[i], hinge[j],
                      factor * 3.0 / area * k[i] * k[j] * Eigen::Matrix3d::Identity());
}

}  // namespace

ClothSystem make_cloth_system(const ClothShape& shape)
{
    const int n = shape.side;
    const double h2 = shape.step * shape.step, dx = 1.0 / std::max(n - 1, 1), dy = dx / shape.aspect;
    std::mt19937 random(shape.seed);
    std::uniform_real_distribution<double> jitter(-0.1, 0.1);
    ClothSystem cloth;
    for (int row = 0; row < n; ++row)
        for (int column = 0; column < n; ++column) {
            const double x = dx * (column + jitter(random)), y = dy * (row + jitter(random));
            const double z = shape.wrinkle * (std::sin(23 * x) * std::cos(17 * y) + 0.3 * jitter(random));
            cloth.position.emplace_back(x, y, z);
        }
    const auto vertex = [n](int row, int column) { return n * row + column; };
    Entries entries;
    for (int row = 0; row + 1 < n; ++row)
        for (int column = 0; column + 1 < n; ++column) {
            const int a = vertex(row, column), b = vertex(row, column + 1), c = vertex(row + 1, column),
                      d = vertex(row + 1, column + 1);
            add_stretch(entries, {a, b, d}, cloth.position, h2 * shape.stretch);
            add_stretch(entries, {a, d, c}, cloth.position, h2 * shape.stretch);
            add_bending(entries, {a, d, b, c}, cloth.position, h2 * shape.bending);
            if (column > 0)
                add_bending(entries, {a, c, d, vertex(row, column - 1)}, cloth.position, h2 * shape.bending);
            if (row > 0)
                add_bending(entries, {a, b, d, vertex(row - 1, column)}, cloth.position, h2 * shape.bending);
        }
    const double mass = shape.density * dx * dy;
    for (int v = 0; v < n * n; ++v) add_block(entries, v, v, mass * Eigen::Matrix3d::Identity());
    cloth.mass = Eigen::VectorXd::Constant(3 * n * n, mass);
    cloth.matrix.resize(3 * n * n, 3 * n * n);
    cloth.matrix.setFromTriplets(entries.begin(), entries.end());
    return cloth;
}

OwnedProblem::OwnedProblem(Eigen::SparseMatrix<double> a, Eigen::VectorXd b)
    : matrix(std::move(a)), rhs(std::move(b))
{
    matrix.makeCompressed();
    problem.matrix = &matrix;
    problem.rhs = &rhs;
    problem.lower = Eigen::VectorXd::Constant(rhs.size(), -std::numeric_limits<double>::infinity());
    problem.is_fixed.assign(static_cast<std::size_t>(rhs.size()), 0);
}

OwnedProblem::OwnedProblem(const OwnedProblem& other)
    : matrix(other.matrix), rhs(other.rhs), problem(other.problem)
{
    problem.matrix = &matrix;
    problem.rhs = &rhs;
}

void OwnedProblem::set_matrix(Eigen::SparseMatrix<double> a)
{
    matrix = std::move(a);
    matrix.makeCompressed();
}

OwnedProblem make_resting_cloth(const ClothShape& shape, double share)
{
    ClothSystem cloth = make_cloth_system(shape);
    std::mt19937 random(shape.seed + 1);
    std::normal_distribution<double> normal;
    const auto size = cloth.mass.size();
    Eigen::VectorXd speed(size);  // unconstrained velocity: the cloth falls and ripples
    for (int i = 0; i < size; ++i) {
        const Vector3d& x = cloth.position[i / 3];
        speed[i] = i % 3 == 2 ? -9.81 * shape.step + 0.02 * std::sin(31 * x[0] + 7 * x[1])
                              : 0.05 * std::cos(9 * x[1]);
        speed[i] += 0.002 * normal(random);
    }
    std::vector<double> clearance;  // from the cloth down to the wavy floor
    for (const Vector3d& x : cloth.position)
        clearance.push_back(x[2] - 1.2 * shape.wrinkle * std::sin(19 * x[0] + 3) * std::sin(21 * x[1] + 1));
    std::vector<double> sorted = clearance;
    std::sort(sorted.begin(), sorted.end());
    const double touching = sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
    OwnedProblem owned(cloth.matrix, cloth.mass.cwiseProduct(speed));
    for (std::size_t v = 0; v < clearance.size(); ++v)
        if (clearance[v] < touching + 0.1 * shape.wrinkle)
            owned.problem.lower[static_cast<int>(3 * v + 2)] =
                -std::max(clearance[v] - touching, 0.0) / shape.step;
    return owned;
}

Eigen::SparseMatrix<double> lower_blocks(const Eigen::MatrixXd& matrix)
{
    const int size = static_cast<int>(matrix.rows());
    Entries entries;
    for (int j = 0; j < size; ++j)
        for (int i = 3 * (j / 3); i < size; ++i) {
            const int row = 3 * (i / 3), column = 3 * (j / 3);
            if (row == column || !matrix.block<3, 3>(row, column).isZero(0.0))
                entries.emplace_back(i, j, i < j ? 1e30 : matrix(i, j));
        }
    Eigen::SparseMatrix<double> sparse(size, size);
    sparse.setFromTriplets(entries.begin(), entries.end());
    return sparse;
}

Eigen::MatrixXd dense_symmetric(const Eigen::SparseMatrix<double>& matrix)
{
    return Eigen::MatrixXd(Eigen::MatrixXd(matrix).selfadjointView<Eigen::Lower>());
}

std::vector<int> active_coordinates(const VelocitySolution& solution)
{
    std::vector<int> active;
    for (int i = 0; i < solution.multipliers.size(); ++i)
        if (solution.multipliers[i] > 0.0) active.push_back(i);
    return active;
}

std::vector<int> spoil_guess(const VelocityProblem& problem, const std::vector<int>& guess, double share,
                             std::mt19937& random)
{
    std::vector<char> is_active(problem.is_fixed.size(), 0);
    for (const int i : guess) is_active[i] = 1;
    std::vector<int> inactive, spoilt;
    for (int i = 0; i < problem.lower.size(); ++i)
        if (!is_active[i] && std::isfinite(problem.lower[i])) inactive.push_back(i);
    std::vector<int> kept = guess;
    std::shuffle(kept.begin(), kept.end(), random);
    std::shuffle(inactive.begin(), inactive.end(), random);
    const auto wrong = static_cast<std::size_t>(share * static_cast<double>(guess.size()));
    spoilt.assign(kept.begin() + static_cast<std::ptrdiff_t>(wrong), kept.end());
    spoilt.insert(spoilt.end(), inactive.begin(),
                  inactive.begin() + static_cast<std::ptrdiff_t>(std::min(wrong, inactive.size())));
    std::sort(spoilt.begin(), spoilt.end());
    return spoilt;
}

}  // namespace arris::testing
