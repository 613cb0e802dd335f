// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/contact/audit.h"

#include "geometry/self_contact/self_intersection.h"
#include "solver/contact/contacts.h"

namespace arris {

namespace {

Audit deepest_of(const std::vector<Audit>& penetrations)
{
    Audit deepest;
    for (const Audit& one : penetrations)
        if (deepest.obstacle < 0 || one.found.depth > deepest.found.depth) deepest = one;
    return deepest;
}

}  // namespace

SelfCrossings find_self_crossings(const Scene& scene, const ClothMesh& mesh)
{
    SelfCrossings crossings;
    if (!scene.self_contact) return crossings;
    const auto pairs = find_self_intersections(mesh.world, mesh.faces);
    crossings.count = static_cast<int>(pairs.size());
    if (pairs.empty()) return crossings;
    const Face& face = mesh.faces[pairs.front()[0]];
    crossings.place = (mesh.world[face[0]] + mesh.world[face[1]] + mesh.world[face[2]]) / 3.0;
    for (int k = 0; k < 2; ++k)
        crossings.pieces[k] = scene.materials.piece_at(mesh.corners(pairs.front()[k])[0]);
    return crossings;
}

std::vector<Audit> find_penetrations(const Scene& scene, const State& state)
{
    std::vector<Audit> penetrations;
    for (std::size_t o = 0; o < scene.obstacles.size(); ++o) {
        const ObstaclePose pose = scene.obstacles[o].at(state.time);
        Penetration found =
            find_penetration(pose, to_local(pose.placement, state.mesh.world), state.mesh.faces);
        if (!found.is_any()) continue;
        found.place = pose.placement(found.place);
        penetrations.push_back({static_cast<int>(o), found});
    }
    return penetrations;
}

std::vector<Audit> find_penetrations(const Scene& scene, const ClothMesh& mesh, double time)
{
    State state;
    state.mesh = mesh;
    state.time = time;
    return find_penetrations(scene, state);
}

Audit audit(const Scene& scene, const State& state)
{
    return deepest_of(find_penetrations(scene, state));
}

Audit audit(const Scene& scene, const ClothMesh& mesh, double time)
{
    return deepest_of(find_penetrations(scene, mesh, time));
}

}  // namespace arris
