// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/cloth_strain.h"

#include <algorithm>

#include "physics/membrane.h"
#include "solver/plane_stars.h"

namespace arris {

ClothStrain measure_cloth_strain(const Material& material, const ClothElements& elements,
                                 const ClothStars& stars, const std::vector<Vec3>& positions)
{
    // Height of a star over its longest edge up to which cloth has no folds: cloth that has taken up 1 % of
    // compression by folding has slopes of 0.1.
    constexpr double kPlane = 1e-3;
    ClothStrain found;
    std::vector<Vec2> stretches;
    std::vector<Face> faces;
    for (const FaceElement& face : elements.faces) {
        const int f = static_cast<int>(faces.size());
        faces.push_back(face.vertices);
        stretches.push_back(principal_stretches(FaceState(face, positions).F));
        const Vec2 strains = stretches.back().array() - 1.0;
        if (strains.maxCoeff() > found.stretch.strain) found.stretch = {strains.maxCoeff(), f};
        if (strains.minCoeff() < found.compression.strain) found.compression = {strains.minCoeff(), f};
    }
    const std::vector<std::optional<Vec3>> normals = find_plane_stars(faces, stars.faces, positions, kPlane);
    for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
        const double least = stretches[f].minCoeff() - 1.0;
        if (!(least < found.in_plane.strain)) continue;
        // Cloth that is pulled contracts across the pull without compressive tension.
        const Vec2 tensions =
            principal_tensions(stretches[f], material.youngs_modulus, material.poisson_ratio);
        if (!(tensions.minCoeff() < 0.0)) continue;
        if (std::all_of(faces[f].begin(), faces[f].end(),
                        [&](int v) { return is_plane_around(v, faces, stars.faces, normals); }))
            found.in_plane = {least, f};
    }
    return found;
}

}  // namespace arris
