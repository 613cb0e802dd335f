// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "physics/term.h"

namespace arris {

/// Energies of the cloth at one moment, J. Where a kind has no term it is 0.
struct Energies {
    double gravity = 0.0, stretch = 0.0, bending = 0.0;

    double elastic() const { return stretch + bending; }
    double sum() const { return gravity + stretch + bending; }
};

Energies compute_energies(const ClothElements& elements, const Terms& terms,
                          const std::vector<Vec3>& position);

/// Work, J, of what has no energy (pulls, wind) on cloth that goes by `displacement` (m) and has `velocity`
/// (m/s) at the end: one entry a vertex. Forces are those linearised at `at`.
double compute_load_work(const ClothMesh& mesh, const ClothElements& elements, const Terms& terms,
                         const Linearization& at, const std::vector<Vec3>& velocity,
                         const std::vector<Vec3>& displacement);

/// What a frame stores of each face: greatest principal strain, energies in J (a hinge's bending is halved
/// between its faces).
struct FaceReadings {
    std::vector<double> strain, stretch_energy, bending_energy;
};

FaceReadings compute_face_readings(const ClothElements& elements, const Terms& terms,
                                   const std::vector<Vec3>& position);

}  // namespace arris
