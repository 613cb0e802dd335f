// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

#include "geometry/cloth/cloth_mesh.h"

namespace arris {

/// Sum of the faces' material areas, m^2.
double material_area(const ClothMesh& mesh);

/// Smallest box, m, around the material; empty for an empty mesh.
Eigen::AlignedBox2d material_bounds(const ClothMesh& mesh);

/// Extents, m, of the material; of sewn cloth the greatest of any panel, as panels may lie anywhere.
Vec2 material_extents(const ClothMesh& mesh);

/// Least angle of a face in material space, degrees.
double least_material_angle(const ClothMesh& mesh, int face);

/// Least angle of any face in material space, degrees; 0 for an empty mesh.
double least_material_angle(const ClothMesh& mesh);

}  // namespace arris
