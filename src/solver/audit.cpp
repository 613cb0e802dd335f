// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/audit.h"

namespace arris {

Audit audit(const Scene& scene, const State& state)
{
    Audit deepest;
    std::vector<Vec3> positions(state.mesh.world.size());
    for (std::size_t o = 0; o < scene.obstacles.size(); ++o) {
        const Placement frame = scene.obstacles[o].at(state.time);
        for (std::size_t v = 0; v < positions.size(); ++v) positions[v] = frame.inverse(state.mesh.world[v]);
        Penetration found = find_penetration(scene.obstacles[o], positions, state.mesh.faces);
        if (!found.is_any() || (deepest.obstacle >= 0 && found.depth <= deepest.found.depth)) continue;
        found.place = frame(found.place);
        deepest = {static_cast<int>(o), found};
    }
    return deepest;
}

}  // namespace arris
