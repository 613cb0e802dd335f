// SPDX-License-Identifier: GPL-3.0-or-later
// BDF2 extrapolates q~ and v~ from the last two steps. An impact would be extrapolated, too: the velocity of
// before would lead through the contact. So what an impact of the last step did is taken out of q~ and v~.
#pragma once

#include <vector>

#include "solver/contact/contacts.h"

namespace arris {

/// Flattens the history in `prediction` along the normals of the contacts from `first` on, relative to their
/// carrier. Applies to contacts that were active. Applies also where the extrapolated position would violate
/// the kept gap and the cloth's velocity does not restore the gap. Otherwise the velocity of a vertex before
/// an impact would be extrapolated through the contact, and the vertex would rebound. True where anything was
/// flattened; then call `update_gaps`. `mobility`: see find_mobility.
bool flatten_history(const State& state, const Carriers& carriers, const std::vector<EolCoordinates>& eol,
                     const std::vector<double>& mobility, std::size_t first,
                     const std::vector<Contact>& contacts, Prediction& prediction);

/// Takes the friction of impacts at the contacts from `first` on, where they pressed in the last step, out of
/// `prediction.velocity`. An impact that changes the normal velocity by dv changes the velocity along the
/// plane by dv times friction over normal force, at once. v~ would add a third of that change again, and a
/// third of it in the next step: friction would act 1 + 1/3 + 1/9 + ... = 3/2 times. The friction of cloth
/// that slides on without impacts stays. On features friction acts on the material's flow, which stays as it
/// is.
void flatten_friction(const Scene& scene, const State& state, const Carriers& carriers,
                      const std::vector<double>& mobility, std::size_t first,
                      const std::vector<Contact>& contacts, Prediction& prediction);

}  // namespace arris
