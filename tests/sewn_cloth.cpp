// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/sewn_cloth.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace arris {

ClothMesh part_and_sew(ClothMesh mesh, const Cut& cut)
{
    const std::vector<Vec2> whole = mesh.material;
    const Vec2 origin = cut.at * Vec2::Unit(cut.axis), shift = cut.apart * Vec2::Unit(cut.axis);
    const Mat2 turn =
        cut.ease * Eigen::Rotation2Dd(cut.degrees * std::numbers::pi / 180.0).toRotationMatrix();
    const bool is_turned = cut.degrees != 0.0 || cut.ease != 1.0;
    const auto place = [&](const Vec2& X) {
        return Vec2(is_turned ? Vec2(origin + turn * (X - origin)) + shift : X + shift);
    };
    std::vector<int> beyond(whole.size(), -1);  // points of the farther part on the seam
    const auto is_on_seam = [&](int v) { return std::abs(whole[v][cut.axis] - cut.at) < 1e-12; };
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        if (whole[v][cut.axis] > cut.at && !is_on_seam(v)) mesh.material[v] = place(whole[v]);
        if (!is_on_seam(v)) continue;
        beyond[v] = static_cast<int>(mesh.material.size());
        mesh.material.push_back(place(whole[v]));
        mesh.seam_vertices.push_back(v);
    }
    for (const Face& face : mesh.faces) {
        const double middle = (whole[face[0]] + whole[face[1]] + whole[face[2]])[cut.axis] / 3.0;
        Face points = face;
        for (int& p : points)
            if (middle > cut.at && beyond[p] >= 0) p = beyond[p];
        mesh.face_points.push_back(points);
    }
    return mesh;
}

}  // namespace arris
