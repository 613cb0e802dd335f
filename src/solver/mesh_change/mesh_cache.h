// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/self_contact/self_surface.h"
#include "physics/elements/cloth_elements.h"
#include "physics/elements/term.h"
#include "physics/system/linear_system.h"
#include "solver/eol/cloth_stars.h"
#include "solver/model/constraint_cause.h"
#include "solver/model/state.h"

namespace arris {

/// Data derived from the step's mesh, kept from step to step and rebuilt only where the mesh has changed.
struct MeshCache {
    ClothStars stars;
    std::vector<Face> faces_of_stars;  ///< of the mesh `stars` was made for
    SelfSurface self_surface;          ///< of the same mesh; empty without self-contact
    Terms terms;
    ClothElements elements;
    LinearSystem system;
    std::vector<Face> faces_of_elements;  ///< of the mesh `elements` was made for
    std::vector<Vec2> material_of_elements;
    std::vector<Vec2> elimination_places;  ///< m, of the vertices: the solver's order of unknowns
    std::vector<Vec2> stretches;           ///< principal stretches of the faces at `world_of_stretches`
    std::vector<Vec3> world_of_stretches;  ///< empty where `stretches` are not those of `elements`

    // choose_step_mesh
    std::vector<RefusedContact>
        refused;  ///< contacts that pressed on a feature and are constraints in this step
    std::vector<std::array<std::uint32_t, 2>> misfits;  ///< edges that were to be split or merged
    State conformed;  ///< the state at the step's begin, where its mesh or the flow through it has changed
};

}  // namespace arris
