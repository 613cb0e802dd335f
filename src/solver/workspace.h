// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "physics/cloth_elements.h"
#include "physics/linear_system.h"
#include "physics/term.h"
#include "solver/contacts.h"
#include "solver/proposal.h"
#include "solver/velocity_solve.h"

namespace arris {

/// Caches and scratch of the step, grouped by the phase that writes them. Clearing it changes no result.
struct Workspace {
    // The mesh: made where it changed.
    Terms terms;
    ClothElements elements;
    LinearSystem system;
    std::vector<Face> faces_of_elements;  ///< of the mesh `elements` was made for
    std::vector<Vec2> material_of_elements;
    std::vector<MeshEdge> edges;

    // move
    Prediction prediction;
    std::vector<HeldVertex> held;
    std::vector<ObstacleStep> obstacles;

    // find_contacts, build_constraints, add_violations
    std::vector<Contact> contacts;
    Linearization at;
    VelocityProblem problem;
    int yielded = 0;
    bool has_system = false;  ///< of this step's prediction; rows may have been added since

    // solve_velocity, propose
    VelocitySolver solver;
    VelocitySolution solution;
    Proposal proposal;
};

}  // namespace arris
