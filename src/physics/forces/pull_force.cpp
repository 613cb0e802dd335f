// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/forces/pull_force.h"

namespace arris {

void PullForce::add(const ClothMesh& mesh, const Linearization& at, std::vector<Vec3>& force) const
{
    if (!pull_.acts_between(at.begin, at.time)) return;
    for (const LoadShare& share : spread_over_box(mesh, pull_.material))
        force[share.vertex] += share.weight * pull_.force;
}

std::vector<CornerLoad> PullForce::corner_loads(const ClothMesh& mesh, const Linearization& at) const
{
    std::vector<CornerLoad> loads;
    if (!pull_.acts_between(at.begin, at.time)) return loads;
    for (const FaceShare& share : spread_over_faces(mesh, pull_.material))
        for (int k = 0; k < 3; ++k)
            if (share.weights[k] > 0.0) loads.push_back({share.face, k, share.weights[k] * pull_.force});
    return loads;
}

}  // namespace arris
