// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "physics/forces/energies.h"
#include "solver/contact/contacts.h"
#include "solver/contact/proposal.h"
#include "solver/contact/squeezed.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/friction/friction_pairs.h"
#include "solver/mesh_change/mesh_cache.h"
#include "solver/retry_policy.h"
#include "solver/velocity_solve/velocity_solve.h"

namespace arris {

/// Energy of the cloth at one moment, J.
struct ClothEnergy {
    double kinetic = 0.0;
    Energies potential;

    double sum() const { return kinetic + potential.sum(); }
};

/// The cloth's energy during one step, as `energy_balance` measures it.
struct StepEnergies {
    double floor = 0.0;  ///< least scale of changes: smaller ones are round-off, or constraints that give way
    ClothEnergy start;
    ClothEnergy solved;    ///< of the proposal before cloth is pushed out to its stand-off
    ClothEnergy proposed;  ///< of the proposal after cloth is pushed out
    ClothEnergy known;     ///< energy of `known_at`
    MovingCloth known_at;  ///< cloth at the last commit; empty if the mesh has changed since
};

/// Among this step's linearizations, the one with the least energy rise so far.
struct LeastRise {
    double rise = 0.0;      ///< J
    ClothVelocity at;       ///< v^ of that linearization; empty before the first solve
    bool is_taken = false;  ///< the step has returned to `at` and relinearises no more
};

/// Caches and scratch of the step, grouped by the phase that writes them. Clearing it changes no result.
struct Workspace {
    MeshCache mesh;

    RetryPolicy retry;  ///< failed attempts at this step

    // move
    Prediction prediction;
    std::vector<PinTarget> pin_targets;
    Carriers carriers;

    // find_contacts, build_constraints, add_violations
    std::vector<Contact> contacts;
    std::vector<double> mobility;  ///< see find_mobility
    std::vector<EolCoordinates> eol;
    Linearization linearization;
    ClothVelocity expansion;  ///< v^: q^ = q~ + gamma v^ is where forces are linearised
    VelocityProblem problem;
    std::vector<SlipContact> slip_contacts;  ///< contacts with friction, one per friction pair of `problem`
    Cushion cushion;

    // solve_velocity, propose
    VelocitySolver solver;
    VelocitySolution solution;
    Proposal proposal;

    StepEnergies energies;
    LeastRise least;
};

}  // namespace arris
