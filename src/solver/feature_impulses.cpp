// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/feature_impulses.h"

#include "physics/system/feature_impulse.h"

namespace arris {
namespace {

/// Calls `visit(vertex, weight)` for the vertices of a contact other than an EOL vertex's own.
template <typename Visit>
void visit_vertices(const Contact& contact, const Visit& visit)
{
    if (contact.eol >= 0) return;
    for (int i = 0; i < 4 && contact.vertices[i] >= 0; ++i) visit(contact.vertices[i], contact.weights[i]);
}

}  // namespace

std::vector<Vec3> find_feature_impulses(const State& state, const std::vector<double>& multiplier,
                                        const Workspace& work)
{
    std::vector<Vec3> impulse = compute_feature_impulses(state.mesh, work.mesh.elements, work.mesh.terms,
                                                         work.linearization, work.solution.velocity);
    for (std::size_t c = 0; c < work.contacts.size(); ++c)
        visit_vertices(work.contacts[c], [&](int v, double weight) {
            impulse[v] -= multiplier[c] * weight * work.contacts[c].normal;
        });
    return impulse;
}

void store_feature_forces(const std::vector<double>& multiplier, const Workspace& work, State& state)
{
    if (work.eol.empty()) return;
    const double gamma = work.prediction.gamma;
    std::vector<Vec3> impulse = find_feature_impulses(state, multiplier, work);
    for (const SlipContact& slipping : work.slip_contacts) {
        const Contact& contact = work.contacts[slipping.contact];
        visit_vertices(contact,
                       [&](int v, double weight) { impulse[v] -= gamma * weight * contact.friction.force; });
    }
    for (const EolCoordinates& at : work.eol) state.eol[at.entry].force = impulse[at.vertex] / gamma;
}

}  // namespace arris
