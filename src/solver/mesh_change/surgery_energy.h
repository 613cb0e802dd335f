// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/surgery/cloth_surgery.h"
#include "physics/energies.h"

namespace arris {

/// Whether the cloth's edge a - b lies along a feature: as the mesh is or, if it has no such edge, as the
/// operation makes it.
bool is_on_trace(const ClothSurgery& surgery, const SurgeryEvent& event, VertexId a, VertexId b);

/// Energies, J, of `event.before` or `event.after` and of the hinges at their edges, also those with faces
/// that the operation leaves as they are: what the step will find there, with creases of `crease_width` (m).
Energies find_energies(const ClothSurgery& surgery, const SurgeryEvent& event,
                       const std::vector<PatchFace>& faces, const Terms& terms, double crease_width);

}  // namespace arris
