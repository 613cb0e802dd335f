// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/self_contact/near_pairs.h"
#include "geometry/self_contact/self_contact.h"

namespace arris {

/// Contacts of the cloth with itself that a step may meet, found before its solve. `motion` ends where the
/// cloth would be without contacts. One plane at each local minimum of the distance between two parts of the
/// cloth that is below twice the thickness (m) at begin, if the cloth may come nearer; farther off, one at
/// each first touch of the motion. Between a vertex and a border that pass over each other, the plane is that
/// of the border's face. A vertex has at most three planes, the nearest first, with normals more than 20
/// degrees apart. Contacts of vertices come first.
std::vector<SelfContact> find_self_contacts(const SelfSurface& surface, const SelfMotion& motion,
                                            double thickness);

/// The contact of a pair along a unit normal. `least_gap` is not positive where the pair began behind its
/// plane.
SelfContact make_self_contact(const ClothPointPair& pair, const Vec3& normal, const std::vector<Vec3>& begin,
                              double thickness);

}  // namespace arris
