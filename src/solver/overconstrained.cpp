// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/overconstrained.h"

#include <algorithm>
#include <array>

#include "solver/contact/constraints.h"
#include "solver/energy_balance.h"
#include "solver/eol/eol_coordinates.h"

namespace arris {

namespace {

/// Sums over all contacts of one EOL vertex.
struct Press {
    double impulse = 0.0;  ///< N s, sum of magnitudes
    Vec3 net = Vec3::Zero();
    double work = 0.0;  ///< J, done by the obstacles' motion
};

Press sum_contacts(int vertex, const std::vector<double>& multiplier, const Workspace& work)
{
    Press sum;
    for (std::size_t c = 0; c < work.contacts.size(); ++c) {
        const Contact& contact = work.contacts[c];
        if (contact.is_with_itself()) continue;
        for (int i = 0; i < 4 && contact.vertices[i] >= 0; ++i) {
            if (contact.vertices[i] != vertex) continue;
            const double impulse = contact.weights[i] * multiplier[c];
            sum.impulse += impulse;
            sum.net += impulse * contact.normal;
            sum.work += impulse * way_along(work.carriers, contact) / work.prediction.gamma;
        }
    }
    return sum;
}

/// EOL vertices in contacts that no velocity meets.
std::vector<int> find_unmet_vertices(const State& state, const Workspace& work)
{
    std::vector<int> unmet;
    for (const int row : work.solution.infeasible_rows)
        for (const Contact& contact : work.contacts) {
            if (contact.row != row || contact.is_with_itself()) continue;
            for (const int v : contact.vertices)
                if (v >= 0 && state.eol_entry(state.ids[v]) >= 0) unmet.push_back(v);
        }
    return unmet;
}

}  // namespace

std::vector<int> find_overconstrained_by_work(const Workspace& work)
{
    // Sum of impulses over the part that moves the vertex: 2 in a groove of 60 degrees.
    constexpr double kInVain = 2.0;
    constexpr double kWork = 0.1;  // share of the energy scale
    std::vector<int> overconstrained;
    const double least = kWork * energy_scale(work);
    if (!(work.energies.solved.sum() - work.energies.start.sum() > least)) return overconstrained;
    const std::vector<double> multiplier = contact_multipliers(work.contacts, work.solution);
    for (const EolCoordinates& eol : work.eol) {
        const Press press = sum_contacts(eol.vertex, multiplier, work);
        if (press.work > least && press.impulse > kInVain * (eol.basis.transpose() * press.net).norm())
            overconstrained.push_back(eol.vertex);
    }
    return overconstrained;
}

std::vector<int> find_overconstraining_fold_planes(const Workspace& work)
{
    constexpr double kAgainst = -0.5;  // cosine of the normals
    std::vector<int> overconstraining;
    const std::vector<double> multiplier = contact_multipliers(work.contacts, work.solution);
    const auto is_pressing = [&](std::size_t c) { return multiplier[c] > 0.0; };
    for (std::size_t f = 0; f < work.contacts.size(); ++f) {
        const Contact& fold = work.contacts[f];
        if (!fold.is_fold_plane() || !is_pressing(f)) continue;
        const int vertex = fold.vertices[0];
        for (std::size_t c = 0; c < work.contacts.size(); ++c) {
            const Contact& other = work.contacts[c];
            const std::array<int, 4>& vertices = other.vertices;
            if (other.is_fold_plane() || other.is_with_itself() || other.obstacle == fold.obstacle ||
                !is_pressing(c) || !(other.normal.dot(fold.normal) < kAgainst) ||
                std::find(vertices.begin(), vertices.end(), vertex) == vertices.end())
                continue;
            overconstraining.push_back(static_cast<int>(f));
            break;
        }
    }
    return overconstraining;
}

std::vector<int> find_overconstrained_vertices(const State& state, const Workspace& work,
                                               const StepReport& report)
{
    if (report.status != StepStatus::Infeasible) return {};
    return work.solution.infeasible_rows.empty() ? find_overconstrained_by_work(work)
                                                 : find_unmet_vertices(state, work);
}

}  // namespace arris
