// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/contact/clearance.h"

#include "geometry/check/sweep_check.h"
#include "geometry/cloth/mesh_topology.h"
#include "solver/contact/contacts.h"

namespace arris {

namespace {

/// A step of zero length with the cloth at rest at time 0.
std::vector<ObstacleStep> stand_still(const Scene& scene, const ClothMesh& mesh,
                                      const std::vector<MeshEdge>& edges)
{
    State state;
    state.mesh = mesh;
    state.velocity.assign(mesh.world.size(), Vec3::Zero());
    Prediction prediction;
    prediction.gamma = 1.0;
    prediction.position = mesh.world;
    prediction.velocity = state.velocity;
    std::vector<ObstacleStep> steps = move_obstacles(scene, state, edges, prediction, {}, 0.0);
    for (ObstacleStep& step : steps) {
        step.motion.faces = &mesh.faces;
        step.reference = step.motion.begin;
    }
    return steps;
}

/// Moves the contact's point out to `thickness`, with the least change of its vertices; true where this moved
/// it.
bool push_out(const ObstacleContact& contact, const ObstacleStep& step, double thickness,
              std::vector<Vec3>& world)
{
    constexpr double kRoundOff = 1e-9;  // of the thickness
    const Vec3 normal = step.end.rotation * contact.normal;
    const double gap = normal.dot(contact.at(world) - step.end(contact.point));
    if (gap >= (1.0 - kRoundOff) * thickness) return false;
    contact.shift((thickness - gap) * normal, world);
    return true;
}

/// One sweep over all contacts.
bool push_out_all(const Scene& scene, const std::vector<MeshEdge>& edges, ClothMesh& mesh)
{
    bool is_changed = false;
    const double thickness = scene.material.thickness;
    const std::vector<ObstacleStep> steps = stand_still(scene, mesh, edges);
    for (std::size_t o = 0; o < steps.size(); ++o) {
        const Obstacle& obstacle = scene.obstacles[o];
        for (const auto& find : {find_vertex_contacts, find_edge_contacts, find_face_contacts})
            for (const ObstacleContact& c : find(obstacle, steps[o].motion, steps[o].reference, thickness))
                is_changed = push_out(c, steps[o], thickness, mesh.world) || is_changed;
    }
    return is_changed;
}

bool is_free_way(const Scene& scene, const std::vector<MeshEdge>& edges, const ClothMesh& from,
                 const ClothMesh& to)
{
    std::vector<ObstacleStep> steps = stand_still(scene, from, edges);
    for (std::size_t o = 0; o < steps.size(); ++o) {
        steps[o].motion.end = to_frame(steps[o].end, to.world);
        if (!check_sweep(scene.obstacles[o], steps[o].motion, scene.material.thickness).is_clean())
            return false;
    }
    return true;
}

}  // namespace

int clear_stand_off(const Scene& scene, ClothMesh& mesh)
{
    constexpr int kMostSweeps = 30;
    if (scene.obstacles.empty()) return 0;
    const std::vector<MeshEdge> edges = make_topology(mesh.vertex_count(), mesh.faces).edges;
    const std::vector<Vec3> placed = mesh.world;
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
        ClothMesh moved = mesh;
        if (!push_out_all(scene, edges, moved) || !is_free_way(scene, edges, mesh, moved)) break;
        mesh = std::move(moved);
    }
    int count = 0;
    for (std::size_t v = 0; v < placed.size(); ++v)
        if (mesh.world[v] != placed[v]) ++count;
    return count;
}

}  // namespace arris
