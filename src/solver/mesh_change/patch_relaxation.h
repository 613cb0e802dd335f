// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "solver/eol/creases.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// A part of the cloth whose shape may give way.
struct RelaxedPatch {
    std::vector<int> faces;     ///< of the state's mesh
    std::vector<char> is_free;  ///< of each vertex of the state
    std::vector<Vec3>
        normals;          ///< of each vertex: it keeps its height along this; zero where it is free to leave
    double wanted = 0.0;  ///< J: energy at which it is relaxed enough
};

/// Of a vertex that pressed at the end of the last step its contact's normal, world; else zero.
Vec3 find_kept_normal(const Scene& scene, const State& state, std::uint32_t vertex_id);

/// Moves free vertices, in the world, until the patch's stretch, bending and gravity energy has fallen to
/// `wanted`, or so far that it is seen not to fall there, as in the pop filter of Narain, Pfaff and O'Brien
/// 2013: a change of mesh that strains the cloth would be seen as a push. The way is that of a few steps from
/// rest, so short that nothing falls by more than nobody sees: cloth that nothing holds up is not paid for
/// its strain by falling. No vertex comes nearer to an obstacle than the stand-off, or than it is; and the
/// way is kept free of obstacles: where it is not it is halved, at most a few times, then not gone. History
/// moves along, so that no velocity comes of it. `creases` are the state's. Returns the energy, J.
double relax(const Scene& scene, const Creases& creases, const RelaxedPatch& patch, State& state);

/// A patch by itself; one entry a vertex.
struct LoosePatch {
    ClothMesh mesh;
    std::vector<char> is_free;
    std::vector<Vec3> normals;  ///< as above
    Creases creases;
};

/// Whether a patch would relax by `drop` (J); obstacles are not looked at.
bool can_relax_by(const Scene& scene, const LoosePatch& patch, double drop);

/// Stretch, bending and gravity energy, J, as the step has them, of cloth in this shape; and of some of a
/// cloth's faces and the hinges between them, whose creases are `creases`.
double find_patch_energy(const Scene& scene, const Creases& creases, const ClothMesh& mesh);
double find_patch_energy(const Scene& scene, const Creases& creases, const ClothMesh& cloth,
                         const std::vector<int>& faces);

}  // namespace arris
