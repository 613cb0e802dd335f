// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/yielding.h"

#include "solver/contact/contacts.h"
#include "solver/infeasible.h"
#include "solver/overconstrained.h"

namespace arris {

bool yield_infeasible(const Scene& scene, const State& state, Workspace& work)
{
    bool is_changed = false;
    for (Contact& contact : work.contacts) {
        if (!is_unmet(work, contact.row)) continue;
        if (!yield_stand_off(work.obstacles, work.prediction, scene.material.thickness, contact)) continue;
        ++work.yielded;
        is_changed = true;
    }
    for (SelfRow& self : work.self_rows) {
        if (!is_unmet(work, self.row)) continue;
        if (!yield_self_row(state, scene.self_contact->thickness, self)) continue;
        ++work.yielded;
        is_changed = true;
    }
    work.has_system = work.has_system && !is_changed;
    return is_changed;
}

bool yield_folds(const Scene& scene, Workspace& work)
{
    bool is_changed = false;
    for (const int fold : find_overconstraining_folds(work))
        is_changed |=
            yield_stand_off(work.obstacles, work.prediction, scene.material.thickness, work.contacts[fold]);
    work.has_system = work.has_system && !is_changed;
    return is_changed;
}

}  // namespace arris
