// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "physics/cloth_elements.h"
#include "solver/eol/cloth_stars.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// Which hinges of a mesh are creases (physics/bending.h).
struct Creases {
    double width = 0.0;                     ///< m; 0 where there are none
    std::vector<std::array<int, 2>> edges;  ///< of the cloth, that lie along features; ends and list ascend
};

/// Whether the mesh resolves the bend that the tension of this cloth's own weight makes at a feature: its
/// cells are shorter than the length sqrt(K / T) over which cloth bends there. Then rows alone slide as well
/// as EOL vertices do. False without gravity, and without a target for the mesh.
bool resolves_bends(const Scene& scene, const ClothMesh& cloth);

/// Width, m, of the creases of this cloth: none (0) without a target for the mesh, and where the bend that
/// the cloth has at a feature, on both sides of it, is as wide. There a crease would be too soft, and what is
/// released a jump in energy.
double find_crease_width(const Scene& scene, const ClothMesh& cloth);

/// Those between EOL vertices. `stars` are the state's.
Creases find_creases(const Scene& scene, const State& state, const ClothStars& stars);

/// Makes the hinges of `elements` at these edges creases and the others none. `elements` are the mesh's. True
/// where anything changed: energies known of these elements are old.
bool mark_creases(const Creases& creases, const ClothMesh& mesh, ClothElements& elements);

}  // namespace arris
