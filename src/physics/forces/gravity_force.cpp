// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/forces/gravity_force.h"

namespace arris {

double GravityForce::energy(const FaceState& face) const
{
    return -face.element.area / 3.0 *
           areal_forces_[face.element.piece].dot(face.x[0] + face.x[1] + face.x[2]);
}

void GravityForce::add(const FaceState& face, FaceSystem& system) const
{
    for (int i = 0; i < 3; ++i)
        system.add_force(i, face.element.area / 3.0 * areal_forces_[face.element.piece]);
}

}  // namespace arris
