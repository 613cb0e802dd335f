// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "physics/energies.h"
#include "solver/attempts.h"
#include "solver/contact/contacts.h"
#include "solver/contact/proposal.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/mesh_change/mesh_cache.h"
#include "solver/velocity_solve/velocity_solve.h"

namespace arris {

/// What the cloth has at one moment, J.
struct ClothEnergy {
    double kinetic = 0.0;
    Energies potential;

    double sum() const { return kinetic + potential.sum(); }
};

/// Caches and scratch of the step, grouped by the phase that writes them. Clearing it changes no result.
struct Workspace {
    MeshCache mesh;

    // retries of the step
    std::vector<Overrun> overrun;
    RetryPolicy retry;  ///< at this step

    // move
    Prediction prediction;
    std::vector<PinTarget> pin_targets;
    std::vector<ObstacleStep> obstacles;

    // find_contacts, build_constraints, add_violations
    std::vector<Contact> contacts;
    std::vector<EolCoordinates> eol;
    Linearization linearization;
    ClothVelocity expansion;  ///< v^
    VelocityProblem problem;
    int yielded = 0;
    bool has_system = false;  ///< of this step's prediction; rows may have been added since

    // solve_velocity, propose
    VelocitySolver solver;
    VelocitySolution solution;
    Proposal proposal;

    // find_contacts, measure_proposal_energy, enforce_energy_balance
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
