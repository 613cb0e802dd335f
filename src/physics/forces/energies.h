// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "physics/elements/term.h"

namespace arris {

/// Energies of the cloth at one moment, J; 0 for a kind without a term.
struct Energies {
    double gravity = 0.0, stretch = 0.0, bending = 0.0, seam = 0.0;

    double elastic() const { return stretch + bending + seam; }
    double sum() const { return gravity + stretch + bending + seam; }
    Energies& operator+=(const Energies& other);
};

Energies compute_energies(const ClothElements& elements, const Terms& terms,
                          const std::vector<Vec3>& position);

/// Energy of the springs alone, J.
double compute_spring_energy(const ClothElements& elements, const Terms& terms,
                             const std::vector<Vec3>& position);

/// Work, J, of forces without an energy (pulls, wind) on cloth that moves by `displacement` (m) and has
/// `velocity` (m/s) at the end; one entry per vertex. The forces are linearised at `at`.
double compute_load_work(const ClothMesh& mesh, const ClothElements& elements, const Terms& terms,
                         const Linearization& at, const std::vector<Vec3>& velocity,
                         const std::vector<Vec3>& displacement);

/// Values of each face stored in a frame: greatest principal strain, and energies in J. Half of a hinge's
/// bending energy goes to each of its faces.
struct FaceReadings {
    std::vector<double> strain, stretch_energy, bending_energy;
};

FaceReadings compute_face_readings(const ClothElements& elements, const Terms& terms,
                                   const std::vector<Vec3>& position);

}  // namespace arris
