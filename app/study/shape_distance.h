// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "app/files/frame.h"

namespace arris {

/// Distances between two cloths at equal material points.
struct ShapeDistance {
    double mean = 0.0;      ///< m, over the points
    double greatest = 0.0;  ///< m
    int points = 0;         ///< that both cloths have
};

/// Compares at the cell centres of a grid of 64 x 64 over the second cloth's material rectangle, which both
/// cloths need not fill. A point's place is interpolated linearly in the face that holds it. Throws
/// InputError if fewer than half of the points that one cloth has are in the other: then the two are
/// different cloths.
ShapeDistance measure_shape_distance(const Frame& cloth, const Frame& reference);

/// Diagonal of the box around the cloth's vertices in the world, m.
double world_diagonal(const Frame& cloth);

}  // namespace arris
