// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/contact/self_contacts.h"

#include <algorithm>
#include <tuple>

#include "geometry/self_contact/self_contact_search.h"

namespace arris {

namespace {

using VertexIds = std::array<std::uint32_t, 4>;

VertexIds ids_of(const State& state, const std::array<int, 4>& vertices)
{
    VertexIds ids;
    for (int i = 0; i < 4; ++i) ids[i] = state.ids[vertices[i]];
    return ids;
}

auto key_of(const ActiveSelfContact& contact)
{
    return std::tie(contact.kind, contact.vertex_ids);
}

/// Entry of the contact in the last step; null where it did not press. A vertex slides from face to face, so
/// its normal tells which plane was the same.
const ActiveSelfContact* find_last(const State& state, const SelfContact& contact)
{
    constexpr double kSameNormal = 0.7;
    const bool is_vertex = contact.kind == SelfContactKind::VertexFace;
    VertexIds ids = ids_of(state, contact.vertices);
    const VertexIds exact = ids;
    if (is_vertex) ids[1] = ids[2] = ids[3] = 0;  // the least face
    auto at =
        std::lower_bound(state.self.begin(), state.self.end(), std::tie(contact.kind, ids),
                         [](const ActiveSelfContact& a, const auto& wanted) { return key_of(a) < wanted; });
    const ActiveSelfContact* best = nullptr;
    double best_cosine = kSameNormal;
    for (; at != state.self.end() && at->kind == contact.kind && at->vertex_ids[0] == ids[0]; ++at) {
        if (!is_vertex && at->vertex_ids != exact) break;
        const double cosine = is_vertex ? at->normal.dot(contact.normal) : 1.0;
        if (!(cosine > best_cosine)) continue;
        best = &*at;
        best_cosine = cosine;
    }
    return best;
}

double gap_of(const SelfContact& contact, const std::vector<Vec3>& world)
{
    return contact.normal.dot(contact.difference(world));
}

}  // namespace

std::vector<Vec3> find_free_end(const State& state, const Prediction& prediction,
                                const std::vector<PinTarget>& held)
{
    std::vector<Vec3> end(prediction.position.size());
    for (std::size_t v = 0; v < end.size(); ++v)
        end[v] = prediction.position[v] + prediction.gamma * state.velocity[v];
    hold_in_place(held, end);
    return end;
}

SelfRow make_self_row(const State& state, const SelfContact& contact)
{
    SelfRow row{contact};
    if (const ActiveSelfContact* last = find_last(state, contact)) {
        row.last_multiplier = last->multiplier;
        row.last_friction = row.friction = last->friction;
    }
    return row;
}

std::vector<SelfRow> find_self_rows(const Scene& scene, const State& state, const Prediction& prediction,
                                    const std::vector<PinTarget>& held, const SelfSurface& surface)
{
    std::vector<SelfRow> rows;
    if (!scene.self_contact) return rows;
    const std::vector<Vec3> end = find_free_end(state, prediction, held);
    for (const SelfContact& contact :
         find_self_contacts(surface, {state.mesh.world, end}, scene.self_contact->thickness))
        rows.push_back(make_self_row(state, contact));
    return rows;
}

std::vector<double> find_mobility(double density, const ClothElements& elements,
                                  const std::vector<EolCoordinates>& eol, const std::vector<PinTarget>& held)
{
    std::vector<double> mobility = lump_masses(density, elements);
    for (double& value : mobility) value = 1.0 / value;
    for (const EolCoordinates& vertex : eol) mobility[vertex.vertex] = 0.0;
    for (const PinTarget& vertex : held) mobility[vertex.vertex] = 0.0;
    return mobility;
}

bool flatten_self_history(const State& state, const std::vector<Vec3>& free_end,
                          const std::vector<double>& mobility, std::size_t first,
                          const std::vector<SelfRow>& rows, Prediction& prediction)
{
    constexpr int kPasses = 3;  // rows of neighbours affect each other
    bool is_changed = false;
    for (int pass = 0; prediction.has_history && pass < kPasses; ++pass)
        for (std::size_t k = first; k < rows.size(); ++k) {
            const SelfContact& contact = rows[k].contact;
            const double now = gap_of(contact, state.mesh.world), end = gap_of(contact, free_end);
            const double shift = now - gap_of(contact, prediction.position);
            const bool runs_into = now - shift < contact.least_gap && end < contact.least_gap;
            if (!rows[k].was_active() && !runs_into) continue;
            const double gained = contact.normal.dot(contact.difference(state.velocity) -
                                                     contact.difference(prediction.velocity));
            contact.shift(shift * contact.normal, mobility, prediction.position);
            contact.shift(gained * contact.normal, mobility, prediction.velocity);
            is_changed = true;
        }
    return is_changed;
}

void append_self_rows(const State& state, const Prediction& prediction, const Linearization& at,
                      std::size_t first, std::vector<SelfRow>& rows, VelocityProblem& problem)
{
    const int vertex_count = state.mesh.vertex_count();
    for (std::size_t k = first; k < rows.size(); ++k) {
        SelfRow& self = rows[k];
        const SelfContact& contact = self.contact;
        ConstraintRow row;
        const double gap = gap_of(contact, prediction.position);
        row.lower = (contact.least_gap - gap) / prediction.gamma;
        row.expected = self.last_multiplier;
        row.group = vertex_count + contact.vertices[0];
        for (int i = 0; i < 4; ++i) {
            const int v = contact.vertices[i];
            if (contact.weights[i] == 0.0) continue;
            row.lower -= contact.weights[i] * contact.normal.dot(at.drift[v]);
            const Vec3 gradient = contact.weights[i] * (at.basis[v].transpose() * contact.normal);
            for (int d = 0; d < 3; ++d) {
                row.coordinate[row.count] = 3 * v + d;
                row.coefficient[row.count++] = gradient[d];
            }
        }
        self.row = static_cast<int>(problem.rows.size());
        const double closing = contact.normal.dot(contact.difference(state.velocity));
        self.is_closing = gap + prediction.gamma * closing < contact.least_gap;
        // Most rows that close repeat each other: the search finds those that press.
        if (self.was_active() || self.is_pressing) problem.row_guess.push_back(self.row);
        problem.rows.push_back(row);
    }
}

void restore_self_stand_off(const std::vector<SelfRow>& rows, const std::vector<double>& mobility,
                            double thickness, double growth, std::vector<Vec3>& world)
{
    for (const SelfRow& row : rows) {
        const double wanted = row.contact.least_gap + (row.may_grow ? growth : 0.0);
        const double missing = std::min(thickness, wanted) - gap_of(row.contact, world);
        if (missing > 0.0) row.contact.shift(missing * row.contact.normal, mobility, world);
    }
}

bool yield_self_row(const State& state, double thickness, SelfRow& row)
{
    constexpr double kNothingLeft = 1e-3;  // of the thickness
    if (!(row.contact.least_gap > kNothingLeft * thickness)) return false;
    const double now = gap_of(row.contact, state.mesh.world);
    row.contact.least_gap = now < row.contact.least_gap ? now : 0.5 * row.contact.least_gap;
    row.may_grow = false;
    return true;
}

std::vector<ActiveSelfContact> active_self_contacts(const State& state, const std::vector<SelfRow>& rows,
                                                    const VelocitySolution& solution)
{
    std::vector<ActiveSelfContact> active;
    for (const SelfRow& row : rows) {
        const double multiplier = solution.row_multipliers[row.row];
        if (!(multiplier > 0.0)) continue;
        active.push_back({row.contact.kind, ids_of(state, row.contact.vertices), row.contact.normal,
                          multiplier, row.friction});
    }
    std::sort(active.begin(), active.end(), [](const ActiveSelfContact& a, const ActiveSelfContact& b) {
        return key_of(a) < key_of(b) || (key_of(a) == key_of(b) && a.multiplier > b.multiplier);
    });
    const auto last = std::unique(
        active.begin(), active.end(),
        [](const ActiveSelfContact& a, const ActiveSelfContact& b) { return key_of(a) == key_of(b); });
    active.erase(last, active.end());
    return active;
}

}  // namespace arris
