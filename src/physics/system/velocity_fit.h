// SPDX-License-Identifier: GPL-3.0-or-later
// Fits a velocity to a patch of cloth whose mesh was changed. The fit has the old field's linear momentum. Of
// all such fields on the new mesh, it is nearest to the old field in the norm of kinetic energy.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "geometry/vectors.h"
#include "physics/elements/materials.h"

namespace arris {

/// Velocity of the material on the triangles of a patch before its mesh was changed, linear on each triangle.
/// It may jump between triangles, as where material flows over a fold.
struct VelocityField {
    std::vector<std::array<Vec2, 3>> triangles;  ///< X of the corners, m, counter-clockwise
    std::vector<std::array<Vec3, 3>> velocity;   ///< m/s, of the corners
};
/// Kinetic energy, J, of cloth of these materials.
double compute_kinetic_energy(const Materials& materials, const VelocityField& field);

/// The patch after the change. It covers the same part of the material as VelocityField's triangles.
struct FitPatch {
    std::vector<Face> faces;                     ///< indices of the vertices below
    std::vector<std::array<Vec2, 3>> triangles;  ///< as VelocityField's; one a face
    std::vector<Face> points = {};               ///< as ClothMesh::face_points
    std::vector<int> seam_vertices = {};         ///< likewise
    std::vector<Vec3> world;

    // Velocity xdot = drift + basis u, Xdot = material_basis u. Where `is_free` is 0, xdot = drift and Xdot =
    // material_drift. What is of the material has one entry a point, the rest one a vertex.
    std::vector<char> is_free;
    std::vector<Vec3> drift;
    std::vector<Vec2> material_drift;
    std::vector<Mat3> basis;
    std::vector<Mat23> material_basis;
};

struct VelocityFit {
    std::vector<Vec3> velocity;           ///< xdot, m/s, of each vertex
    std::vector<Vec2> material_velocity;  ///< Xdot, m/s, of each point
};

/// Minimises the integral of density / 2 |new - old|^2 over the patch, subject to equal linear momentum.
/// Returns nothing where no vertex is free or the system is singular (a patch
/// folded so that a vertex's coordinates move no material). Integrals over the overlay of both meshes are
/// exact. The cost is near linear in face count, plus a sparse factorisation.
std::optional<VelocityFit> fit_velocity(const Materials& materials, const VelocityField& old,
                                        const FitPatch& patch);

}  // namespace arris
