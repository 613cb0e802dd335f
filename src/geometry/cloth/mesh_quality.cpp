// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/mesh_quality.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "geometry/cloth/mesh_pieces.h"

namespace arris {

double material_area(const ClothMesh& mesh)
{
    double doubled = 0.0;
    for (int f = 0; f < mesh.face_count(); ++f) doubled += twice_area(mesh.corners(f));
    return 0.5 * doubled;
}

Eigen::AlignedBox2d material_bounds(const ClothMesh& mesh)
{
    Eigen::AlignedBox2d box;
    for (const Vec2& X : mesh.material) box.extend(X);
    return box;
}

Vec2 material_extents(const ClothMesh& mesh)
{
    if (!mesh.has_seams()) return material_bounds(mesh).sizes();
    const std::vector<int> panel_of = label_pieces(static_cast<int>(mesh.material.size()), mesh.face_points);
    std::map<int, Eigen::AlignedBox2d> panels;
    for (std::size_t p = 0; p < panel_of.size(); ++p) panels[panel_of[p]].extend(mesh.material[p]);
    Vec2 greatest = Vec2::Zero();
    for (const auto& [first, box] : panels) greatest = greatest.cwiseMax(box.sizes());
    return greatest;
}

namespace {

/// Least angle of a face in material space, radians.
double least_angle(const std::array<Vec2, 3>& corners)
{
    // At each corner tan = cross / dot; atan2 needs no division and no clamp.
    double least = std::numbers::pi;
    const double doubled = twice_area(corners);
    for (int k = 0; k < 3; ++k) {
        const Vec2& apex = corners[k];
        const Vec2 to_next = corners[(k + 1) % 3] - apex;
        const Vec2 to_last = corners[(k + 2) % 3] - apex;
        least = std::min(least, std::atan2(doubled, to_next.dot(to_last)));
    }
    return least;
}

double in_degrees(double angle)
{
    return angle * 180.0 / std::numbers::pi;
}

}  // namespace

double least_material_angle(const ClothMesh& mesh, int face)
{
    return in_degrees(least_angle(mesh.corners(face)));
}

double least_material_angle(const ClothMesh& mesh)
{
    double least = mesh.faces.empty() ? 0.0 : std::numbers::pi;
    for (int f = 0; f < mesh.face_count(); ++f) least = std::min(least, least_angle(mesh.corners(f)));
    return in_degrees(least);
}

}  // namespace arris
