// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/contact/clearance.h"

#include <algorithm>

#include "geometry/check/sweep_check.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/obstacle/feature_path.h"
#include "geometry/tolerances.h"
#include "solver/contact/contacts.h"
#include "solver/eol/wire_fold.h"
#include "solver/model/eol_limits.h"

namespace arris {

namespace {

/// A step of zero length with the cloth at rest at time 0.
std::vector<Carrier> stand_still(const Scene& scene, const ClothMesh& mesh,
                                 const std::vector<MeshEdge>& edges)
{
    State state;
    state.mesh = mesh;
    state.velocity.assign(mesh.world.size(), Vec3::Zero());
    Prediction prediction;
    prediction.gamma = 1.0;
    prediction.position = mesh.world;
    prediction.velocity = state.velocity;
    std::vector<Carrier> carriers = move_obstacles(scene, state, edges, prediction, {}, 0.0).obstacles;
    for (Carrier& carrier : carriers) {
        carrier.motion.faces = &mesh.faces;
        carrier.reference = carrier.motion.begin;
    }
    return carriers;
}

/// Moves the contact's point out to `thickness`, with the least change of its vertices; true where this moved
/// it.
bool push_out(const ObstacleContact& contact, const Carrier& carrier, double thickness,
              std::vector<Vec3>& world)
{
    const Vec3 normal = carrier.end.rotation * contact.normal;
    const double gap = normal.dot(contact.at(world) - carrier.end(contact.point));
    if (gap >= (1.0 - kAccumulated) * thickness) return false;
    contact.shift((thickness - gap) * normal, world);
    return true;
}

/// Folds of the cloth around wires and borders. Both sides of a fold pass the wire nearer than the fold does,
/// and no motion of single vertices takes it away from the wire without strain. It keeps the gap it has.
class FoldsAround {
  public:
    FoldsAround(const Scene& scene, const std::vector<MeshEdge>& edges, int vertex_count)
        : reach_(kOnFeature * scene.materials.thickness()), neighbours_(vertex_count)
    {
        for (const MeshEdge& edge : edges) {
            neighbours_[edge.a].push_back(edge.b);
            neighbours_[edge.b].push_back(edge.a);
        }
    }

    /// Whether a contact is with a wire around which the cloth is folded at a vertex of the contact.
    /// `places`: the cloth in the obstacle's frame.
    bool includes(const ObstacleContact& contact, const Obstacle& obstacle,
                  const std::vector<Vec3>& places) const
    {
        const Box3 box(contact.point.array() - reach_, contact.point.array() + reach_);
        std::vector<int> features;
        obstacle.find_feature_edges(box, features);
        return std::any_of(features.begin(), features.end(), [&](int feature) {
            if (obstacle.features().edges[feature].kind == FeatureKind::Convex) return false;
            const std::array<Vec3, 2> segment = feature_segment(obstacle, feature);
            return std::any_of(contact.vertices.begin(), contact.vertices.end(),
                               [&](int v) { return v >= 0 && is_fold_at(v, segment, places); });
        });
    }

  private:
    bool is_fold_at(int v, const std::array<Vec3, 2>& segment, const std::vector<Vec3>& places) const
    {
        std::vector<Vec3> around;
        for (const int w : neighbours_[v]) around.push_back(places[w]);
        return std::any_of(around.begin(), around.end(), [&](const Vec3& other) {
            return is_folded_around(segment, places[v], other, around, reach_);
        });
    }

    double reach_;  ///< m
    std::vector<std::vector<int>> neighbours_;
};

/// One sweep over all contacts.
bool push_out_all(const Scene& scene, const std::vector<MeshEdge>& edges, const FoldsAround& folds,
                  ClothMesh& mesh)
{
    bool is_changed = false;
    const double thickness = scene.materials.thickness();
    const std::vector<Carrier> carriers = stand_still(scene, mesh, edges);
    for (std::size_t o = 0; o < carriers.size(); ++o) {
        const Obstacle& obstacle = *carriers[o].obstacle;
        for (const auto& find : {find_vertex_contacts, find_edge_contacts, find_face_contacts})
            for (const ObstacleContact& c :
                 find(obstacle, carriers[o].motion, carriers[o].reference, thickness))
                if (!folds.includes(c, obstacle, carriers[o].motion.begin))
                    is_changed = push_out(c, carriers[o], thickness, mesh.world) || is_changed;
    }
    return is_changed;
}

bool is_free_way(const Scene& scene, const std::vector<MeshEdge>& edges, const ClothMesh& from,
                 const ClothMesh& to)
{
    std::vector<Carrier> carriers = stand_still(scene, from, edges);
    for (std::size_t o = 0; o < carriers.size(); ++o) {
        carriers[o].motion.end = to_local(carriers[o].end, to.world);
        if (!check_sweep(*carriers[o].obstacle, carriers[o].motion, scene.materials.thickness()).is_clean())
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
    const FoldsAround folds(scene, edges, mesh.vertex_count());
    const std::vector<Vec3> placed = mesh.world;
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
        ClothMesh moved = mesh;
        if (!push_out_all(scene, edges, folds, moved) || !is_free_way(scene, edges, mesh, moved)) break;
        mesh = std::move(moved);
    }
    int count = 0;
    for (std::size_t v = 0; v < placed.size(); ++v)
        if (mesh.world[v] != placed[v]) ++count;
    return count;
}

}  // namespace arris
