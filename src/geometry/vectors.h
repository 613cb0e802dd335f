// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace arris {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat2 = Eigen::Matrix2d;
using Mat3 = Eigen::Matrix3d;
using Mat23 = Eigen::Matrix<double, 2, 3>;
using Mat32 = Eigen::Matrix<double, 3, 2>;

/// The rotation and scaling of the plane that takes `from` to `to`.
inline Mat2 turn_between(const Vec2& from, const Vec2& to)
{
    const double cosine = from.dot(to), sine = from.x() * to.y() - from.y() * to.x();
    Mat2 turn;
    turn << cosine, -sine, sine, cosine;
    return turn / from.squaredNorm();
}

/// Vertex indices of a triangle, counter-clockwise in material space.
using Face = std::array<int, 3>;

}  // namespace arris
