// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/cloth_strain.h"

#include <algorithm>

#include "physics/membrane.h"
#include "solver/plane_stars.h"

namespace arris {

ClothStrain measure_cloth_strain(const Material& material, const std::vector<Vec2>& stretches,
                                 const ClothMesh& mesh, const VertexFaces& stars)
{
    // Height of a star over its longest edge up to which cloth has no folds: cloth that has taken up 1 % of
    // compression by folding has slopes of 0.1.
    constexpr double kPlane = 1e-3;
    ClothStrain found;
    PlaneStars plane(mesh.faces, stars, mesh.vertex_count(),
                     [&](int v) { return find_plane_normal(v, mesh.faces, stars, mesh.world, kPlane); });
    for (int f = 0; f < mesh.face_count(); ++f) {
        const double most = stretches[f].maxCoeff() - 1.0, least = stretches[f].minCoeff() - 1.0;
        if (most > found.stretch.strain) found.stretch = {most, f};
        if (least < found.compression.strain) found.compression = {least, f};
        if (!(least < found.in_plane.strain)) continue;
        // Cloth that is pulled contracts across the pull without compressive tension.
        const Vec2 tensions =
            principal_tensions(stretches[f], material.youngs_modulus, material.poisson_ratio);
        if (!(tensions.minCoeff() < 0.0)) continue;
        const Face& face = mesh.faces[f];
        if (std::all_of(face.begin(), face.end(), [&](int v) { return plane.is_plane_around(v); }))
            found.in_plane = {least, f};
    }
    return found;
}

}  // namespace arris
