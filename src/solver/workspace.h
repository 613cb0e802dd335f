// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "physics/cloth_elements.h"
#include "physics/energies.h"
#include "physics/linear_system.h"
#include "physics/term.h"
#include "solver/attempts.h"
#include "solver/contacts.h"
#include "solver/eol_coordinates.h"
#include "solver/proposal.h"
#include "solver/row_cause.h"
#include "solver/velocity_solve.h"

namespace arris {

/// What the cloth has at one moment, J.
struct ClothEnergy {
    double kinetic = 0.0;
    Energies potential;

    double sum() const { return kinetic + potential.sum(); }
};

/// Caches and scratch of the step, grouped by the phase that writes them. Clearing it changes no result.
struct Workspace {
    // The mesh: made where it changed.
    ClothStars stars;
    std::vector<Face> faces_of_stars;  ///< of the mesh `stars` was made for
    Terms terms;
    ClothElements elements;
    LinearSystem system;
    std::vector<Face> faces_of_elements;  ///< of the mesh `elements` was made for
    std::vector<Vec2> material_of_elements;

    // conform
    std::vector<Overrun> overrun;
    FailedAttempts failed;                ///< at this step
    std::vector<RefusedContact> refused;  ///< that pressed on a feature and are rows
    State conformed;                      ///< on the mesh that the step wants, where it is not the state's

    // move
    Prediction prediction;
    std::vector<HeldVertex> held;
    std::vector<ObstacleStep> obstacles;

    // find_contacts, build_constraints, add_violations
    std::vector<Contact> contacts;
    std::vector<EolCoordinates> eol;
    Linearization at;
    ClothVelocity expansion;  ///< v^
    VelocityProblem problem;
    int yielded = 0;
    bool has_system = false;  ///< of this step's prediction; rows may have been added since

    // solve_velocity, propose
    VelocitySolver solver;
    VelocitySolution solution;
    Proposal proposal;

    // find_contacts, weigh_proposal, keep_energy
    ClothEnergy energy;           ///< at the step's start
    ClothEnergy solved_energy;    ///< of the proposal before anything was moved out to its stand-off
    ClothEnergy proposed_energy;  ///< and after
    double least_rise = 0.0;      ///< J, of this step's linearisations so far
    ClothVelocity least_at;       ///< v^ of that one
    bool is_least_taken = false;  ///< whatever it is
    ClothEnergy known_energy;     ///< of `known`, which the last commit left
    MovingCloth known;
};

}  // namespace arris
