// SPDX-License-Identifier: GPL-3.0-or-later
// Cloth of two panels that are sewn together, made of a sheet.
#pragma once

#include "geometry/cloth/cloth_mesh.h"

namespace arris {

/// A line of the material, u = at or v = at, along which a sheet is parted.
struct Cut {
    int axis = 0;          ///< 0: u, 1: v
    double at = 0.5;       ///< m
    double apart = 0.75;   ///< m, by which the part beyond lies farther out in the material
    double degrees = 0.0;  ///< by which it is turned there
    double ease = 1.0;     ///< factor of its size
};

/// Parts the material of a mesh along a cut, where it must have edges, and sews both parts together there.
/// Vertices stay as they are.
ClothMesh part_and_sew(ClothMesh mesh, const Cut& cut);

}  // namespace arris
