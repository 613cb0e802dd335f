// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "physics/elements/cloth_elements.h"
#include "solver/eol/cloth_stars.h"
#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// The hinges of a mesh that are creases (physics/forces/bending.h).
struct Creases {
    std::vector<double> widths;             ///< m, of each piece; 0 without creases
    std::vector<std::array<int, 2>> edges;  ///< edges of the cloth along features; ends and list ascend
};

/// Whether the mesh resolves the bend of every piece at a feature under the tension of its own weight: cells
/// are shorter than sqrt(K / T), the length over which the cloth bends. Constraints then let the cloth slide
/// as well as EOL vertices do. False without gravity, and without a target for the mesh.
bool resolves_bends(const Scene& scene, const ClothMesh& cloth);

/// Width, m, of the creases of each piece. Zero without a target for the mesh, and where the cloth's bend
/// over both sides of a feature is as wide as a crease: the crease would be too soft, and releasing its
/// vertices would make energy jump.
std::vector<double> find_crease_widths(const Scene& scene, const ClothMesh& cloth);

/// Creases between EOL vertices. `stars` belong to the state's mesh.
Creases find_creases(const Scene& scene, const State& state, const ClothStars& stars);

/// Makes the hinges of `elements` at these edges creases, and all others ordinary. `elements` belong to
/// `mesh`. True where anything changed: energies computed before with these elements are out of date.
bool mark_creases(const Creases& creases, const ClothMesh& mesh, ClothElements& elements);

}  // namespace arris
