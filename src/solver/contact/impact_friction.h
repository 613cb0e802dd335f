// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/contact/contacts.h"
#include "solver/contact/self_contacts.h"

namespace arris {

// An impact that changes the normal velocity by dv changes the velocity along the plane by dv times friction
// over normal force, at once. BDF2's extrapolation v~ of both velocities would add a third of that change
// again, and a third of it in the next step: friction would act 1 + 1/3 + 1/9 + ... = 3/2 times. So what an
// impact of the last step did goes out of v~: the normal part in `flatten_history`, friction here. The
// friction of cloth that slides on without impacts stays.

/// Takes the friction of impacts at the contacts from `first` on, where they pressed in the last step, out of
/// `prediction.velocity`. On features friction acts on the material's flow, which stays as it is.
void flatten_friction(const Scene& scene, const State& state, const std::vector<ObstacleStep>& steps,
                      std::size_t first, const std::vector<Contact>& contacts, Prediction& prediction);

/// The same at contacts of the cloth with itself. `mobility`: see find_mobility.
void flatten_self_friction(const Scene& scene, const State& state, const std::vector<double>& mobility,
                           std::size_t first, const std::vector<SelfRow>& rows, Prediction& prediction);

}  // namespace arris
