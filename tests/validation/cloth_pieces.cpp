// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloth_pieces.h"

#include <Eigen/Geometry>
#include <numbers>

namespace arris {

void add_piece(const ClothMesh& sheet, const Vec3& corner, double degrees, ClothMesh& cloth)
{
    const int first = cloth.vertex_count();
    const Mat3 turn = Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, Vec3::UnitZ()).toRotationMatrix();
    for (const Face& f : sheet.faces) cloth.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
    for (const Vec2& p : sheet.material) {
        cloth.material.push_back(p + Vec2(first, 0.0));
        cloth.world.push_back(corner + turn * Vec3(p.x(), p.y(), 0.0));
    }
}

}  // namespace arris
