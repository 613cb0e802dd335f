// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/contact/constraints.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "geometry/tolerances.h"

namespace arris {

namespace {

/// Rows of a vertex's coordinates: pinned axes, then contact normals.
struct VertexBasis {
    Mat3 rows = Mat3::Zero();
    Mat3 span = Mat3::Zero();  ///< orthonormal basis of the span of `rows`
    int count = 0;

    /// Adds a unit direction if its part perpendicular to the chosen ones is large enough to divide by.
    bool add(const Vec3& direction)
    {
        constexpr double kLeastPart = 0.2;  // a smaller part would amplify round-off
        Vec3 across = direction;
        for (int k = 0; k < count; ++k) across -= span.row(k).dot(direction) * span.row(k).transpose();
        if (count == 3 || across.norm() < kLeastPart) return false;
        rows.row(count) = direction;
        span.row(count++) = across.normalized();
        return true;
    }

    /// Columns: v - drift = basis u.
    Mat3 basis() const
    {
        Mat3 all = rows;
        if (count == 1) {
            all.row(1) = span.row(0).unitOrthogonal();
            all.row(2) = span.row(0).cross(all.row(1));
        } else if (count == 2) {
            all.row(2) = span.row(0).cross(span.row(1));
        }
        return count == 1 ? Mat3(all.transpose()) : Mat3(all.inverse());
    }
};

/// Fixes the pinned directions: their axes come first, and their u is 0.
void hold(const std::vector<PinTarget>& held, const Prediction& prediction, std::vector<VertexBasis>& bases,
          Linearization& at, VelocityProblem& problem)
{
    for (const PinTarget& vertex : held) {
        const int v = vertex.vertex;
        const Vec3 drift = (vertex.target - prediction.position[v]) / prediction.gamma;
        for (int d = 0; d < 3; ++d) {
            if (!vertex.held[d]) continue;
            at.drift[v][d] = drift[d];
            problem.is_fixed[3 * v + bases[v].count] = 1;
            bases[v].add(Vec3::Unit(d));
        }
    }
}

/// Sets the coordinates of EOL vertices, whose drift is the motion of the obstacle under them.
void let_flow(const std::vector<EolCoordinates>& eol, const Prediction& prediction, Linearization& at)
{
    at.flow.reset();
    if (eol.empty()) return;
    const std::size_t n = at.drift.size();
    MaterialFlow& flow = at.flow.emplace();
    flow.is_eulerian.assign(n, 0);
    flow.basis.assign(prediction.material.size(), Mat23::Zero());
    for (const EolCoordinates& vertex : eol) {
        const int v = vertex.vertex;
        at.drift[v] = (vertex.carried - prediction.position[v]) / prediction.gamma;
        at.basis[v] = vertex.basis;
        at.has_basis[v] = 1;
        flow.is_eulerian[v] = 1;
        flow.basis[v] = vertex.material_basis;
        for (const SeamPoint& beyond : vertex.beyond)
            flow.basis[beyond.point] = beyond.turn * vertex.material_basis;
    }
}

/// Contacts in the order in which they may become bounds: contacts that pressed come first.
std::vector<std::size_t> order_of(const std::vector<Contact>& contacts)
{
    std::vector<std::size_t> order(contacts.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_partition(order.begin(), order.end(),
                          [&](std::size_t c) { return contacts[c].was_active(); });
    return order;
}

/// Expected active: contacts that pressed in the last step, or would be violated at the last velocity.
bool is_expected(const Contact& contact, const Prediction& prediction, const State& state)
{
    const double closing = contact.normal.dot(contact.at(state.velocity));
    // Most layers that close repeat each other: the solve finds those that press.
    const bool closes = !contact.is_with_itself() && contact.gap + prediction.gamma * closing < 0.0;
    return contact.was_active() || contact.is_pressing || closes;
}

/// Whether no coordinate moves the contact, as where its normal is across the only direction in which an EOL
/// vertex moves, and the contact keeps its gap but for round-off. Coefficients that are round-off would ask
/// for any speed.
bool is_kept_at_rest(const ConstraintRow& row, const Prediction& prediction, const Contact& contact)
{
    const auto last = row.coefficient.begin() + row.count;
    const bool can_move = std::any_of(row.coefficient.begin(), last, [](double g) { return g != 0.0; });
    return !can_move && row.lower * prediction.gamma <= kAccumulated * contact.least_gap;
}

/// Appends a contact's constraint; to the guess, too, where it is `expected` to press.
void add_row(const Prediction& prediction, const Linearization& at, bool is_expected, Contact& contact,
             VelocityProblem& problem)
{
    ConstraintRow row;
    row.lower = -contact.gap / prediction.gamma;
    row.expected = contact.last_multiplier;
    if (contact.is_squeezed())
        row.compliance = 1.0 / (prediction.gamma * prediction.gamma * contact.stiffness);
    for (int i = 0; i < 4 && contact.vertices[i] >= 0; ++i) {
        if (contact.weights[i] == 0.0) continue;
        const int v = contact.vertices[i];
        const Vec3 gradient = contact.weights[i] * (at.basis[v].transpose() * contact.normal);
        row.lower -= contact.weights[i] * contact.normal.dot(at.drift[v]);
        for (int d = 0; d < 3; ++d) {
            row.coordinate[row.count] = 3 * v + d;
            row.coefficient[row.count++] = std::abs(gradient[d]) < kLastPlaces ? 0.0 : gradient[d];
        }
    }
    if (is_kept_at_rest(row, prediction, contact)) row.lower = -std::numeric_limits<double>::infinity();
    row.group = contact.vertices[0];
    if (contact.is_with_itself()) row.group += static_cast<int>(at.basis.size());
    contact.row = static_cast<int>(problem.rows.size());
    if (is_expected) problem.row_guess.push_back(contact.row);
    problem.rows.push_back(row);
}

}  // namespace

void append_rows(const Prediction& prediction, const Linearization& at, std::size_t first,
                 std::vector<Contact>& contacts, VelocityProblem& problem)
{
    for (std::size_t c = first; c < contacts.size(); ++c)
        add_row(prediction, at, contacts[c].was_active(), contacts[c], problem);
}

void build_constraints(const std::vector<PinTarget>& held, const std::vector<EolCoordinates>& eol,
                       const Prediction& prediction, const State& state, std::vector<Contact>& contacts,
                       Linearization& at, VelocityProblem& problem)
{
    const std::size_t n = state.mesh.world.size();
    at.drift.assign(n, Vec3::Zero());
    at.basis.assign(n, Mat3::Identity());
    at.has_basis.assign(n, 0);
    problem.lower = Eigen::VectorXd::Constant(3 * n, -std::numeric_limits<double>::infinity());
    problem.is_fixed.assign(3 * n, 0);
    problem.guess.clear();
    problem.rows.clear();
    problem.row_guess.clear();

    // Bounds: all contacts of a vertex with independent normals.
    std::vector<VertexBasis> bases(n);
    hold(held, prediction, bases, at, problem);
    let_flow(eol, prediction, at);
    for (const std::size_t c : order_of(contacts)) {
        Contact& contact = contacts[c];
        const int v = contact.vertices[0];
        contact.bound = contact.row = -1;
        if (contact.is_squeezed()) continue;
        if (contact.eol >= 0) {
            contact.bound = 3 * v;
        } else {
            const bool is_flowing = at.flow && at.flow->is_eulerian[v];
            if (!contact.is_vertex() || is_flowing || !bases[v].add(contact.normal)) continue;
            contact.bound = 3 * v + bases[v].count - 1;
        }
        problem.lower[contact.bound] = -contact.gap / prediction.gamma - contact.normal.dot(at.drift[v]);
        if (is_expected(contact, prediction, state)) problem.guess.push_back(contact.bound);
    }
    std::sort(problem.guess.begin(), problem.guess.end());
    for (std::size_t v = 0; v < n; ++v) {
        if (bases[v].count == 0) continue;
        at.basis[v] = bases[v].basis();
        at.has_basis[v] = at.basis[v] != Mat3::Identity();
    }

    // Constraints: all other contacts.
    for (Contact& contact : contacts) {
        if (contact.bound >= 0) continue;
        add_row(prediction, at, is_expected(contact, prediction, state), contact, problem);
    }
}

std::vector<double> contact_multipliers(const std::vector<Contact>& contacts,
                                        const VelocitySolution& solution)
{
    std::vector<double> multiplier;
    for (const Contact& contact : contacts)
        multiplier.push_back(contact.bound >= 0 ? solution.multipliers[contact.bound]
                                                : solution.row_multipliers[contact.row]);
    return multiplier;
}

}  // namespace arris
