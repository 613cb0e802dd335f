// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/constraints.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace arris {

namespace {

/// Columns: the held axes, then the part of `normal` across them, then what completes an orthonormal basis.
/// Empty where the pins leave no direction with a part along the normal.
std::optional<Mat3> find_basis(const std::array<bool, 3>& held, const Vec3& normal)
{
    constexpr double kLeastPart = 0.1;  // of the normal: with less a bound would amplify its round-off
    Mat3 basis;
    int columns = 0;
    Vec3 free_normal = normal;
    for (int d = 0; d < 3; ++d)
        if (held[d]) {
            basis.col(columns++) = Vec3::Unit(d);
            free_normal[d] = 0.0;
        }
    if (columns == 3 || free_normal.norm() < kLeastPart) return std::nullopt;
    basis.col(columns++) = free_normal.normalized();
    if (columns == 1) {
        basis.col(1) = basis.col(0).unitOrthogonal();
        ++columns;
    }
    if (columns == 2) basis.col(2) = basis.col(0).cross(basis.col(1));
    return basis;
}

void hold(const HeldVertex& vertex, const Prediction& prediction, Linearization& at, VelocityProblem& problem)
{
    const Vec3 drift = (vertex.target - prediction.position[vertex.vertex]) / prediction.gamma;
    for (int d = 0; d < 3; ++d) {
        if (!vertex.held[d]) continue;
        at.drift[vertex.vertex][d] = drift[d];
        problem.is_fixed[3 * vertex.vertex + d] = 1;
    }
}

}  // namespace

int contact_coordinate(const std::vector<char>& is_fixed, int vertex)
{
    for (int d = 0; d < 3; ++d)
        if (!is_fixed[3 * vertex + d]) return 3 * vertex + d;
    return -1;
}

std::optional<int> find_crushed_vertex(const std::vector<Contact>& contacts, double depth,
                                       const Linearization& at, const VelocityProblem& problem)
{
    for (const Contact& contact : contacts) {
        const int v = contact.vertex;
        const bool is_dropped =
            !(problem.lower.segment<3>(3 * v).maxCoeff() > -std::numeric_limits<double>::max());
        if (is_dropped && contact.gap + at.gamma * contact.normal.dot(at.drift[v]) < -depth) return v;
    }
    return std::nullopt;
}

void build_constraints(const std::vector<HeldVertex>& held, const std::vector<Contact>& contacts,
                       const Prediction& prediction, const State& state, Linearization& at,
                       VelocityProblem& problem)
{
    const std::size_t n = state.mesh.world.size();
    at.drift.assign(n, Vec3::Zero());
    at.basis.assign(n, Mat3::Identity());
    at.has_basis.assign(n, 0);
    problem.lower = Eigen::VectorXd::Constant(3 * n, -std::numeric_limits<double>::infinity());
    problem.is_fixed.assign(3 * n, 0);
    problem.guess.clear();
    for (const HeldVertex& vertex : held) hold(vertex, prediction, at, problem);

    auto active = state.active.begin();
    for (const Contact& contact : contacts) {
        const int v = contact.vertex;
        std::array<bool, 3> is_held;
        for (int d = 0; d < 3; ++d) is_held[d] = problem.is_fixed[3 * v + d];
        const std::optional<Mat3> basis = find_basis(is_held, contact.normal);
        if (!basis) continue;

        // The pinned axes are coordinates 0.. in the new basis, so what is fixed moves to the front.
        at.basis[v] = *basis;
        at.has_basis[v] = 1;
        const int fixed = static_cast<int>(std::count(is_held.begin(), is_held.end(), true));
        for (int d = 0; d < 3; ++d) problem.is_fixed[3 * v + d] = d < fixed;
        const int coordinate = 3 * v + fixed;
        const double scale = contact.normal.dot(basis->col(fixed));
        const double closing = -std::max(contact.gap, 0.0) / prediction.gamma;
        problem.lower[coordinate] = (closing - contact.normal.dot(at.drift[v])) / scale;

        // Expected active: what pressed in the last step, and what would pass the stand-off at its last
        // velocity.
        while (active != state.active.end() && active->vertex_id < state.ids[v]) ++active;
        const bool was_active = active != state.active.end() && active->vertex_id == state.ids[v];
        const bool is_arriving = contact.gap + prediction.gamma * contact.normal.dot(state.velocity[v]) < 0.0;
        if (was_active || is_arriving) problem.guess.push_back(coordinate);
    }
}

}  // namespace arris
