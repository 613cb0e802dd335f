// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/eol_release.h"

#include "physics/cloth_elements.h"
#include "physics/term.h"

namespace arris {

namespace {

/// Of the faces around a vertex, J, for a density of 1: what they have, and what is lost where all of them
/// have one velocity at the vertex, the mean of theirs by area.
struct StarEnergy {
    double kinetic = 0.0, loss = 0.0;
};

StarEnergy measure_star(const Scene& scene, const State& state, const std::vector<int>& faces, int vertex,
                        int obstacle)
{
    const Obstacle& beneath = scene.obstacles[obstacle];
    StarEnergy energy;
    Vec3 mean = Vec3::Zero();
    double area = 0.0, squares = 0.0;
    for (const int f : faces) {
        const FaceElement face = make_face_element(state.mesh.material, state.mesh.faces[f]);
        const Mat32 F = FaceState(face, state.mesh.world).F;
        Vec3 sum = Vec3::Zero();
        for (const int v : face.vertices) {
            const Vec3 w = state.velocity[v] - F * state.material_velocity[v] -
                           beneath.velocity_after(state.time, state.mesh.world[v]);
            sum += w;
            energy.kinetic += face.area / 24.0 * w.squaredNorm();
            if (v != vertex) continue;
            mean += face.area * w;
            squares += face.area * w.squaredNorm();
        }
        energy.kinetic += face.area / 24.0 * sum.squaredNorm();
        area += face.area;
    }
    energy.loss = (squares - mean.squaredNorm() / area) / 12.0;
    return energy;
}

}  // namespace

bool can_let_go(const Scene& scene, const State& state, const ClothStars& stars, int entry,
                const EolCoordinates& at, const Vec3& place)
{
    constexpr double kShare = 1e-3;
    const EolVertex& eol = state.eol[entry];
    if (eol.idle < kIdleSteps) return false;
    const double gap = (place - at.frame.point).norm();
    if (gap > scene.eol->length(state.mesh.material[at.vertex])) return true;
    const StarEnergy energy = measure_star(scene, state, stars.faces[at.vertex], at.vertex, eol.obstacle);
    return energy.loss <= kShare * energy.kinetic;
}

}  // namespace arris
