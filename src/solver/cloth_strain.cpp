// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/cloth_strain.h"

#include <algorithm>

#include "physics/forces/membrane.h"
#include "solver/plane_stars.h"

namespace arris {

namespace {

/// Means of the principal stretches of the faces around a vertex, by area.
Vec2 mean_stretches(const std::vector<Vec2>& stretches, const ClothMesh& mesh, const VertexFaces& stars,
                    int vertex)
{
    Vec2 sum = Vec2::Zero();
    double area = 0.0;
    for (const int f : stars[vertex]) {
        const double part = twice_area(mesh.corners(f));
        sum += part * stretches[f];
        area += part;
    }
    return sum / area;
}

}  // namespace

ClothStrain measure_cloth_strain(const Materials& materials, const std::vector<Vec2>& stretches,
                                 const ClothMesh& mesh, const VertexFaces& stars)
{
    // Height of a star over its longest edge up to which cloth has no folds: cloth that has taken up 1 % of
    // compression by folding has slopes of 0.1.
    constexpr double kPlane = 1e-3;
    ClothStrain found;
    PlaneStars plane(mesh.faces, stars, mesh.vertex_count(),
                     [&](int v) { return find_plane_normal(v, mesh.faces, stars, mesh.world, kPlane); });
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Vec2 around = mean_stretches(stretches, mesh, stars, v);
        const double most = around.maxCoeff() - 1.0, least = around.minCoeff() - 1.0;
        if (most > found.stretch.strain) found.stretch = {most, v};
        if (least < found.compression.strain) found.compression = {least, v};
        if (!(least < found.in_plane.strain)) continue;
        // Cloth that is pulled contracts across the pull without compressive tension.
        const Vec2 tensions = principal_tensions(around, materials.at(mesh.material[v]));
        if (tensions.minCoeff() < 0.0 && plane.is_plane_around(v)) found.in_plane = {least, v};
    }
    return found;
}

}  // namespace arris
