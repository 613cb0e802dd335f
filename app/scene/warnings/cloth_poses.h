// SPDX-License-Identifier: GPL-3.0-or-later
// How a scene's cloth lies at time 0, and how its pins move it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "app/scene/parts/run_config.h"

namespace arris {

/// Connected pieces of the cloth.
int count_pieces(const ClothMesh& cloth);

/// The greatest angle, rad, between the normals of two faces, whose material sides they are. Within about 0.1
/// rad where the cloth has many normals.
double greatest_turn(const ClothMesh& cloth);

/// Mean angle, rad, from 0 to pi/2, of the faces to the plane across `up` (unit), weighted by area.
double mean_slope(const ClothMesh& cloth, const Vec3& up);

/// The moment at which two pins come nearest to each other.
struct PinMeeting {
    std::array<std::size_t, 2> pins;  ///< indices in the scene
    double time;                      ///< s
    double share;                     ///< their distance over that of their material
};

/// The nearest meeting of any two pins that hold from time 0, between the means of their vertices, while both
/// hold. Nothing with less than two such pins. Samples the run at 65 moments.
std::optional<PinMeeting> find_nearest_pins(const RunConfig& config);

/// Diagonal of the material that pins hold to the end of the run, relative to that of the cloth.
double spread_of_pins(const RunConfig& config);

}  // namespace arris
