// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/audit.h"

namespace arris {

std::vector<Audit> find_penetrations(const Scene& scene, const ClothMesh& mesh, double time)
{
    std::vector<Audit> penetrations;
    for (std::size_t o = 0; o < scene.obstacles.size(); ++o) {
        const Placement frame = scene.obstacles[o].at(time);
        Penetration found = find_penetration(scene.obstacles[o], to_frame(frame, mesh.world), mesh.faces);
        if (!found.is_any()) continue;
        found.place = frame(found.place);
        penetrations.push_back({static_cast<int>(o), found});
    }
    return penetrations;
}

Audit audit(const Scene& scene, const ClothMesh& mesh, double time)
{
    Audit deepest;
    for (const Audit& one : find_penetrations(scene, mesh, time))
        if (deepest.obstacle < 0 || one.found.depth > deepest.found.depth) deepest = one;
    return deepest;
}

}  // namespace arris
