// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/surgery/cloth_surgery.h"
#include "physics/forces/energies.h"

namespace arris {

/// Whether the cloth's edge a - b lies along a feature: in the current mesh or, if it has no such edge, after
/// the operation.
bool is_on_trace(const ClothSurgery& surgery, const SurgeryEvent& event, VertexId a, VertexId b);

/// Energies, J, of `event.before` or `event.after` and of the hinges at their edges, including hinges with
/// unchanged faces: the energies that the step will find, with creases of these widths (m, of each piece).
Energies find_energies(const ClothSurgery& surgery, const SurgeryEvent& event,
                       const std::vector<PatchFace>& faces, const Terms& terms,
                       const std::vector<double>& crease_widths);

}  // namespace arris
