// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/step_contacts.h"

#include <optional>

#include "geometry/sort_unique.h"
#include "solver/contact/constraints.h"
#include "solver/contact/contact_history.h"
#include "solver/contact/eol_contacts.h"
#include "solver/contact/squeezed.h"
#include "solver/infeasible.h"
#include "solver/not_finite.h"
#include "solver/overconstrained.h"

namespace arris {

namespace {

/// Flattens the history of cloth at the contacts from `first` on. True where anything was flattened.
bool flatten_contacts(const Scene& scene, const State& state, std::size_t first, Workspace& work)
{
    flatten_friction(scene, state, work.carriers, work.mobility, first, work.contacts, work.prediction);
    if (!flatten_history(state, work.carriers, work.eol, work.mobility, first, work.contacts,
                         work.prediction))
        return false;
    update_gaps(work.carriers, work.prediction, work.contacts);
    return true;
}

void append(const std::vector<Contact>& added, std::vector<Contact>& contacts)
{
    contacts.insert(contacts.end(), added.begin(), added.end());
}

/// Lets a fold plane keep nothing in this step: it is only a help, as the check finds cloth that passes
/// without it. True where it kept anything.
bool drop_fold_plane(Workspace& work, Contact& plane)
{
    constexpr double kFree = 1e3;  // m: farther than any step moves
    if (plane.least_gap <= -kFree) return false;
    plane.least_gap = -kFree;
    plane.may_grow = false;
    update_gap(work.carriers[plane.obstacle], work.prediction, plane);
    return true;
}

}  // namespace

bool find_contacts(const Scene& scene, const State& state, Workspace& work, StepReport& report)
{
    if (note_not_finite(CheckedStage::Move, state, work, report)) return false;
    work.contacts = find_contacts_with_obstacles(scene, state, work.prediction, work.carriers);
    // An EOL vertex has one bound of its own instead of contacts with its feature.
    work.eol.clear();
    if (!state.eol.empty()) {
        const double turning = work.retry.may_turn() ? work.prediction.gamma : 0.0;
        work.eol = add_eol_contacts(scene, state, work.mesh.stars, work.prediction, turning, work.carriers,
                                    work.contacts);
    }
    if (!scene.obstacles.empty() || scene.self_contact) {
        work.cushion = make_cushion(scene.materials, state.mesh, work.mesh.elements);
        work.mobility = find_mobility(scene.materials, work.mesh.elements, work.pin_targets);
    }
    const std::optional<int> overconstrained =
        squeeze_contacts(work.cushion, work.carriers, work.prediction, work.contacts).overconstrained;
    append(expect_floors(work.carriers, work.prediction, work.contacts), work.contacts);
    flatten_contacts(scene, state, 0, work);
    // Layers are searched along their way as the obstacles have left it.
    const std::size_t with_obstacles = work.contacts.size();
    std::vector<Contact> layers = find_contacts_with_itself(scene, state, work.prediction, work.pin_targets,
                                                            work.mesh.self_surface, work.carriers);
    squeeze_contacts(work.cushion, work.carriers, work.prediction, layers);
    append(expect_floors(work.carriers, work.prediction, layers), layers);
    append(layers, work.contacts);
    flatten_contacts(scene, state, with_obstacles, work);
    if (note_not_finite(CheckedStage::Contacts, state, work, report)) return false;
    if (!overconstrained) return true;
    report.status = StepStatus::Infeasible;
    report.infeasible = name_infeasible(
        state, {work.contacts, work.pin_targets, work.solution.infeasible_rows}, overconstrained);
    return false;
}

void make_room_for_layers(Workspace& work)
{
    constexpr std::size_t kSpare = 60;  // pairs of vertices that are kept whether they are needed or not
    LinearSystem& system = work.mesh.system;
    std::vector<std::array<int, 2>> pairs;
    bool is_any_missing = false;
    for (const Contact& contact : work.contacts) {
        if (!contact.is_with_itself()) continue;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < i; ++j) {
                if (contact.weights[i] == 0.0 || contact.weights[j] == 0.0) continue;
                const int v = contact.vertices[i], w = contact.vertices[j];
                pairs.push_back({std::min(v, w), std::max(v, w)});
                is_any_missing = is_any_missing || !system.has_pair(v, w);
            }
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

bool squeeze_unmet(Workspace& work)
{
    const UnmetStep step = {work.contacts, work.pin_targets, work.solution.infeasible_rows};
    bool is_changed = false;
    for (Contact& contact : work.contacts) {
        if (!step.is_unmet(contact.row)) continue;
        is_changed |= contact.is_fold_plane()
                          ? drop_fold_plane(work, contact)
                          : squeeze(work.cushion, work.carriers, work.prediction, contact);
    }
    return is_changed;
}

bool drop_overconstraining_fold_planes(Workspace& work)
{
    bool is_changed = false;
    for (const int plane : find_overconstraining_fold_planes(work))
        is_changed |= drop_fold_plane(work, work.contacts[plane]);
    return is_changed;
}

std::optional<Next> add_violations(const Scene& scene, const State& state, const Violations& violations,
                                   Workspace& work)
{
    if (violations.contacts.empty()) return std::nullopt;
    const std::size_t first = work.contacts.size();
    append(violations.contacts, work.contacts);
    for (std::size_t c = first; c < work.contacts.size(); ++c) recall(state, work.carriers, work.contacts[c]);
    const bool is_squeezed =
        squeeze_contacts(work.cushion, work.carriers, work.prediction, work.contacts).is_changed;
    if (flatten_contacts(scene, state, first, work) || is_squeezed) return Next::Assemble;
    append_rows(work.prediction, work.linearization, first, work.contacts, work.problem);
    return Next::Resume;
}

}  // namespace arris
