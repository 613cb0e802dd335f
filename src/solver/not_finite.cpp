// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/not_finite.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/velocity_solve/constraint_rows.h"

namespace arris {
namespace {

/// Index of the first vector that is not finite; -1 without one.
template <class Vector>
int find_in(const std::vector<Vector>& vectors)
{
    const auto found = std::find_if(vectors.begin(), vectors.end(),
                                    [](const Vector& vector) { return !vector.allFinite(); });
    return found == vectors.end() ? -1 : static_cast<int>(found - vectors.begin());
}

/// Id of a vertex, or of the vertex that a material point belongs to; -1 for none.
std::int64_t id_of(const State& state, int vertex)
{
    return vertex < 0 ? -1 : std::int64_t{state.ids[static_cast<std::size_t>(state.mesh.vertex_of(vertex))]};
}

/// A vector a vertex, with its name in messages.
template <class Vector>
struct Named {
    const char* what;
    const std::vector<Vector>& vectors;
};

/// The first vertex with a vector that is not finite, in the order of the arguments.
template <class... Vector>
NotFinite find_vertex(const State& state, const Named<Vector>&... fields)
{
    NotFinite found;
    const auto look = [&](const auto& field) {
        if (found.what != nullptr) return;
        if (const int v = find_in(field.vectors); v >= 0) found = {field.what, id_of(state, v)};
    };
    (look(fields), ...);
    return found;
}

NotFinite find_in_move(const State& state, const Workspace& work)
{
    const Prediction& p = work.prediction;
    const NotFinite found = find_vertex(state, Named<Vec3>{"predicted position", p.position},
                                        Named<Vec3>{"predicted velocity", p.velocity},
                                        Named<Vec2>{"predicted material position", p.material},
                                        Named<Vec2>{"predicted flow of material", p.material_velocity});
    if (found.what != nullptr) return found;
    for (const PinTarget& held : work.pin_targets)
        for (int d = 0; d < 3; ++d)
            if (held.held[d] && !std::isfinite(held.target[d]))
                return {"pin's target", id_of(state, held.vertex), -1, held.pin};
    for (std::size_t k = 0; k < work.carriers.obstacles.size(); ++k) {
        const Placement& end = work.carriers.obstacles[k].end;
        if (!end.rotation.allFinite() || !end.translation.allFinite())
            return {"placement", -1, static_cast<int>(k), -1};
    }
    return {};
}

NotFinite find_in_contacts(const State& state, const Workspace& work)
{
    for (const Contact& contact : work.contacts)
        if (!contact.normal.allFinite() || !std::isfinite(contact.gap))
            return {"contact", id_of(state, contact.vertices[0]), contact.obstacle, -1};
    return {};
}

NotFinite find_in_solve(const State& state, const Workspace& work)
{
    const auto at_row = [&](const char* what, Eigen::Index row) {
        return NotFinite{what, id_of(state, static_cast<int>(row / 3)), -1, -1};
    };
    const Eigen::VectorXd& b = *work.problem.rhs;
    for (Eigen::Index row = 0; row < b.size(); ++row)
        if (!std::isfinite(b[row])) return at_row("force", row);
    const Eigen::SparseMatrix<double>& A = *work.problem.matrix;
    for (Eigen::Index column = 0; column < A.outerSize(); ++column)
        for (Eigen::SparseMatrix<double>::InnerIterator entry(A, column); entry; ++entry)
            if (!std::isfinite(entry.value())) return at_row("stiffness", column);
    for (Eigen::Index row = 0; row < work.problem.lower.size(); ++row)
        if (!(work.problem.lower[row] < std::numeric_limits<double>::infinity()))
            return at_row("bound of the velocity", row);
    const auto at_contact = [&](const char* what, const Contact& contact) {
        return NotFinite{what, id_of(state, contact.vertices[0]), contact.obstacle, -1};
    };
    for (const Contact& contact : work.contacts)
        if (contact.row >= 0 && !is_well_formed(work.problem.rows[contact.row]))
            return at_contact("contact's constraint", contact);
    for (std::size_t r = 0; r < work.slip_contacts.size(); ++r)
        if (!is_well_formed(work.problem.friction[r]))
            return at_contact("friction", work.contacts[work.slip_contacts[r].contact]);
    return {"velocity", -1, -1, -1};
}

}  // namespace

NotFinite find_not_finite(CheckedStage stage, const State& state, const Workspace& work)
{
    switch (stage) {
        case CheckedStage::Start:
            return find_vertex(state, Named<Vec3>{"position", state.mesh.world},
                               Named<Vec2>{"material position", state.mesh.material});
        case CheckedStage::Move:
            return find_in_move(state, work);
        case CheckedStage::Contacts:
            return find_in_contacts(state, work);
        case CheckedStage::Solve:
            return find_in_solve(state, work);
        case CheckedStage::Proposal:
            return find_vertex(state, Named<Vec3>{"new position", work.proposal.world},
                               Named<Vec3>{"new velocity", work.proposal.velocity},
                               Named<Vec2>{"new material position", work.proposal.material},
                               Named<Vec2>{"new flow of material", work.proposal.material_velocity});
    }
    return {};
}

bool note_not_finite(CheckedStage stage, const State& state, const Workspace& work, StepReport& report)
{
    report.not_finite = find_not_finite(stage, state, work);
    if (report.not_finite.what == nullptr) return false;
    report.status = StepStatus::NotFinite;
    return true;
}

}  // namespace arris
