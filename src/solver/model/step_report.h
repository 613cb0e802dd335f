// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>

#include "solver/model/constraint_cause.h"

namespace arris {

enum class StepStatus { Done, NotConverged, Infeasible, NotFinite, Penetration, EnergyRise, Overrun };

/// Wall seconds of one step by phase.
struct PhaseSeconds {
    double move = 0, contacts = 0, conform = 0, transfer = 0, assemble = 0, factorise = 0, solve = 0,
           check = 0, advance = 0, output = 0;

    PhaseSeconds& operator+=(const PhaseSeconds& other)
    {
        for (const auto phase :
             {&PhaseSeconds::move, &PhaseSeconds::contacts, &PhaseSeconds::conform, &PhaseSeconds::transfer,
              &PhaseSeconds::assemble, &PhaseSeconds::factorise, &PhaseSeconds::solve, &PhaseSeconds::check,
              &PhaseSeconds::advance, &PhaseSeconds::output})
            this->*phase += other.*phase;
        return *this;
    }
};

/// A step without history is made in two parts, Opening and Rest, which are reported as one row. Ordinary:
/// any other step or part of one, reported individually.
enum class StepPart { Ordinary, Opening, Rest };

/// A vertex whose pin and contacts no velocity can meet together; -1 where there is none.
struct Infeasible {
    std::int64_t vertex = -1;                 ///< id
    int pin = -1;                             ///< index in the scene of the pin that holds the vertex
    std::array<int, 2> obstacles = {-1, -1};  ///< indices in the scene; the second where no pin holds it and
                                              ///< the cloth is not kept out of cloth
    bool is_with_itself = false;              ///< cloth cannot be kept out of cloth
    int layer_pin = -1;                       ///< index of the pin that holds the other layer
};

/// A number that is not finite, of a step with that status; -1 where a part is not known.
struct NotFinite {
    const char* what = nullptr;  ///< in words, such as "force"; null where all numbers are finite
    std::int64_t vertex = -1;    ///< id
    int obstacle = -1;           ///< index in the scene
    int pin = -1;                ///< index in the scene
};

/// Where an attempt at a step failed, and what the cloth meets there; -1 where there is none.
struct FailurePlace {
    std::int64_t vertex = -1;                 ///< id
    Vec3 world = Vec3::Zero();                ///< m, of the vertex at the step's start
    Vec2 material = Vec2::Zero();             ///< m, likewise
    std::array<int, 2> obstacles = {-1, -1};  ///< indices in the scene
    bool is_with_itself = false;              ///< cloth meets cloth
    std::array<int, 2> crease = {-1, -1};     ///< obstacles (indices) whose faces close on a vertex there
    double crease_angle = 0.0;                ///< radians, between those faces
};

struct StepReport {
    StepStatus status = StepStatus::Done;
    double dt = 0.0;  ///< s
    StepPart part = StepPart::Ordinary;
    FailurePlace place;     ///< of a failed step, but for a number that is not finite
    Infeasible infeasible;  ///< of an infeasible step
    NotFinite not_finite;   ///< of a step that met such a number
    int contacts = 0;       ///< pressing, with obstacles
    int self_contacts = 0;  ///< of the cloth with itself, pressing
    int feature_rows = 0;   ///< pressing, at a sharp edge, corner, wire or point, without EOL vertices
    ConstraintCounts rows_by_cause{};  ///< `feature_rows` by cause, in a scene with EOL vertices
    int eol_pressing = 0;              ///< EOL vertices with a positive multiplier
    int crossings = 0;                 ///< in this step
    int solves = 0;            ///< velocity solves: more than one if constraints were added or forces changed
    int relinearisations = 0;  ///< solves with relinearised forces (relinearization.h)
    double energy_rise = 0.0;  ///< J, energy added by a step that no further attempt could mend
    int yielded = 0;           ///< contacts at which the cloth is squeezed below its stand-off
    int rewound = 0;           ///< vertices put back on their path so that they pass nothing
    double kkt_residual = 0.0;
    int factorisations = 0;
    double solve_work = 0.0;  ///< of the velocity solves, in factorisations' worth
    int nlopt_evaluations = 0;
    int friction_sweeps = 0;             ///< moves of friction's budgets until they agree with the forces
    double friction_residual = 0.0;      ///< by how much they do not, relative to the largest budget
    Vec3 friction_place = Vec3::Zero();  ///< m, a vertex of the contact that differs most
    double friction_work = 0.0;          ///< J, lost to friction
    int sticking = 0, sliding = 0;       ///< contacts with friction
    int eol_vertices = 0;
    int inserted = 0, released = 0;  ///< EOL vertices
    int remeshed = 0;                ///< operations on edges that missed their cells' length
    double remesh_energy = 0.0;      ///< J, added by all changes of the mesh, with remeshing
    PhaseSeconds seconds;

    void add_cost(const StepReport& other)
    {
        solves += other.solves;
        factorisations += other.factorisations;
        solve_work += other.solve_work;
        friction_sweeps += other.friction_sweeps;
        nlopt_evaluations += other.nlopt_evaluations;
        seconds += other.seconds;
    }
};

}  // namespace arris
