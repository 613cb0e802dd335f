// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/step_contacts.h"

#include <optional>

#include "geometry/sort_unique.h"
#include "solver/contact/constraints.h"
#include "solver/contact/eol_contacts.h"
#include "solver/contact/impact_friction.h"
#include "solver/infeasible.h"
#include "solver/not_finite.h"

namespace arris {

namespace {

/// Flattens the history of cloth that presses on obstacles. True where anything was flattened.
bool flatten_history(const Scene& scene, const State& state, Workspace& work, std::size_t first)
{
    flatten_friction(scene, state, work.obstacles, first, work.contacts, work.prediction);
    return flatten_history(scene, state, work.obstacles, work.eol, first, work.contacts, work.prediction);
}

/// Flattens the history of parts of the cloth that press on each other. True where anything was flattened.
bool flatten_self_history(const Scene& scene, const State& state, Workspace& work, std::size_t first)
{
    if (first == work.self_rows.size()) return false;
    flatten_self_friction(scene, state, work.mobility, first, work.self_rows, work.prediction);
    const std::vector<Vec3> free_end = find_free_end(state, work.prediction, work.pin_targets);
    if (!flatten_self_history(state, free_end, work.mobility, first, work.self_rows, work.prediction))
        return false;
    update_gaps(work.obstacles, work.prediction, work.contacts);
    return true;
}

}  // namespace

bool collect_contacts(const Scene& scene, const State& state, Workspace& work, StepReport& report)
{
    if (note_not_finite(CheckedStage::Move, state, work, report)) return false;
    work.contacts = find_contacts(scene, state, work.prediction, work.obstacles);
    // An EOL vertex has one bound of its own instead of contacts with its feature.
    work.eol.clear();
    if (!state.eol.empty()) {
        const double turning = work.retry.may_turn() ? work.prediction.gamma : 0.0;
        work.eol = add_eol_contacts(scene, state, work.mesh.stars, work.prediction, turning, work.obstacles,
                                    work.contacts);
    }
    const std::optional<int> overconstrained =
        share_room(work.obstacles, work.prediction, work.contacts).overconstrained;
    flatten_history(scene, state, work, 0);
    work.self_rows = find_self_rows(scene, state, work.prediction, work.pin_targets, work.mesh.self_surface);
    if (scene.self_contact)
        work.mobility = find_mobility(scene.material.density, work.mesh.elements, work.eol, work.pin_targets);
    flatten_self_history(scene, state, work, 0);
    work.has_system = false;
    work.yielded = 0;
    if (note_not_finite(CheckedStage::Contacts, state, work, report)) return false;
    if (!overconstrained) return true;
    report.status = StepStatus::Infeasible;
    report.infeasible = name_infeasible(state, work, overconstrained);
    return false;
}

void make_room_for_self_rows(Workspace& work)
{
    constexpr std::size_t kSpare = 60;  // pairs of vertices that are kept whether they are needed or not
    LinearSystem& system = work.mesh.system;
    std::vector<std::array<int, 2>> pairs;
    bool is_any_missing = false;
    for (const SelfRow& row : work.self_rows)
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < i; ++j) {
                if (row.contact.weights[i] == 0.0 || row.contact.weights[j] == 0.0) continue;
                const int v = row.contact.vertices[i], w = row.contact.vertices[j];
                pairs.push_back({std::min(v, w), std::max(v, w)});
                is_any_missing = is_any_missing || !system.has_pair(v, w);
            }
    sort_unique(pairs);
    const auto is_far_above = [&](std::size_t times) {
        return system.coupled().size() > times * pairs.size() + kSpare;
    };
    if (!is_any_missing && !is_far_above(4)) return;
    if (!is_far_above(2)) {  // contacts that have gone may come back
        pairs.insert(pairs.end(), system.coupled().begin(), system.coupled().end());
        sort_unique(pairs);
    }
    system.make_pattern(work.mesh.elements, std::move(pairs));
}

bool add_violations(const Scene& scene, const State& state, const Violations& violations, Workspace& work)
{
    if (violations.contacts.empty() && violations.self_rows.empty()) return false;
    const std::size_t first = work.contacts.size(), first_self = work.self_rows.size();
    work.self_rows.insert(work.self_rows.end(), violations.self_rows.begin(), violations.self_rows.end());
    work.contacts.insert(work.contacts.end(), violations.contacts.begin(), violations.contacts.end());
    const bool is_shared = share_room(work.obstacles, work.prediction, work.contacts).is_changed;
    const bool is_flattened = flatten_history(scene, state, work, first);
    if (flatten_self_history(scene, state, work, first_self) || is_flattened || is_shared) {
        work.has_system = false;
        return true;
    }
    append_rows(work.prediction, work.linearization, first, work.contacts, work.problem);
    append_self_rows(state, work.prediction, work.linearization, first_self, work.self_rows, work.problem);
    return true;
}

}  // namespace arris
