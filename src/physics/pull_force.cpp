// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/pull_force.h"

namespace arris {

void PullForce::add(const ClothMesh& mesh, const Linearization& at, std::vector<Vec3>& force) const
{
    if (!pull_.acts_between(at.begin, at.time)) return;
    for (const LoadShare& share : spread_over_box(mesh, pull_.material))
        force[share.vertex] += share.weight * pull_.force;
}

}  // namespace arris
