// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/cloth/cloth_mesh.h"
#include "physics/elements/material.h"

namespace arris {

/// Where the tip of a cantilever is, from the clamp; y downward, `sideways` the mean distance from its plane.
struct Tip {
    double x, y, sideways;  ///< m
};

/// Settles a flat strip, u = 0..2 m, that is held along u = 1, where the mesh must have vertices: two
/// cantilevers of 1 m, clamped by symmetry. `weight` in N/m^2, `tip_load` in N/m.
Tip settle_cantilever(const ClothMesh& strip, const Material& material, double weight, double tip_load);

}  // namespace arris
