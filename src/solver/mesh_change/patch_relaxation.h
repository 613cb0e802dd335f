// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "physics/forces/energies.h"
#include "solver/eol/creases.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// A part of the cloth whose shape may relax.
struct RelaxedPatch {
    std::vector<int> faces;     ///< of the state's mesh
    std::vector<char> is_free;  ///< by vertex of the state
    std::vector<Vec3> normals;  ///< by vertex: it keeps its height along this; zero if unconstrained
    double wanted = 0.0;        ///< J: energy at which relaxing ends
};

/// Normal, world, of the vertex's contact that pressed at the end of the last step; zero without such a
/// contact.
Vec3 find_kept_normal(const Scene& scene, const State& state, std::uint32_t vertex_id);

/// Whether friction held the vertex at the end of the last step, at a contact of its own.
bool is_stuck(const State& state, std::uint32_t vertex_id);

/// Moves free vertices in the world until the patch's stretch, bending and gravity energy has fallen to
/// `wanted`, or as far as a few steps go. Returns the energy, J. As in the
/// pop filter of Narain, Pfaff and O'Brien 2013: otherwise a mesh change that strains the cloth would push it
/// visibly. The vertices take a few implicit steps from rest. These are so short that falling cannot visibly
/// pay for the strain of unsupported cloth. No vertex comes nearer to an obstacle than the stand-off or its
/// current distance. The path is checked: faces that meet an obstacle on it stay where they are, and all of
/// it is halved where it meets the cloth itself; after a few such retreats nothing moves. History moves
/// along, so that no velocity results. `creases` belong to the state.
double relax(const Scene& scene, const Creases& creases, const RelaxedPatch& patch, State& state);

/// A patch as a mesh of its own; one entry a vertex.
struct LoosePatch {
    ClothMesh mesh;
    std::vector<char> is_free;
    std::vector<Vec3> normals;  ///< as in RelaxedPatch
    Creases creases;
};

/// Whether a patch would relax by `drop` (J); obstacles are ignored.
bool can_relax_by(const Scene& scene, const LoosePatch& patch, double drop);

/// Stretch, bending and gravity energy, J, as in the step's equations: of a whole mesh, each kind or their
/// sum, or of some faces of a cloth and the hinges between them. `creases` belong to the mesh given.
Energies find_energies(const Scene& scene, const Creases& creases, const ClothMesh& mesh);
double find_patch_energy(const Scene& scene, const Creases& creases, const ClothMesh& mesh);
double find_patch_energy(const Scene& scene, const Creases& creases, const ClothMesh& cloth,
                         const std::vector<int>& faces);

}  // namespace arris
