// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "physics/energies.h"
#include "solver/contact/contacts.h"
#include "solver/contact/proposal.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/mesh_change/mesh_cache.h"
#include "solver/retry_policy.h"
#include "solver/velocity_solve/velocity_solve.h"

namespace arris {

/// What the cloth has at one moment, J.
struct ClothEnergy {
    double kinetic = 0.0;
    Energies potential;

    double sum() const { return kinetic + potential.sum(); }
};

/// The cloth's energy during one step, as `energy_balance` measures it.
struct StepEnergies {
    ClothEnergy start;
    ClothEnergy solved;    ///< of the proposal before anything was moved out to its stand-off
    ClothEnergy proposed;  ///< and after
    ClothEnergy known;     ///< of `known_at`
    MovingCloth known_at;  ///< what the last commit left; empty where the mesh has changed since
};

/// The linearisation of this step that has raised the energy least, so far.
struct LeastRise {
    double rise = 0.0;      ///< J
    ClothVelocity at;       ///< its v^; empty before the first one
    bool is_taken = false;  ///< the step takes it, whatever it is
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

    StepEnergies energies;
    LeastRise least;
};

}  // namespace arris
