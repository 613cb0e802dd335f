// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/LU>
#include <array>

#include "geometry/vectors.h"

namespace arris {

/// F = dx/dX of a triangle with corners at `X` in the material and at `x` in the world.
inline Mat32 deformation_gradient(const std::array<Vec2, 3>& X, const std::array<Vec3, 3>& x)
{
    Mat2 DX;
    Mat32 Dx;
    DX << X[1] - X[0], X[2] - X[0];
    Dx << x[1] - x[0], x[2] - x[0];
    return Dx * DX.inverse();
}

}  // namespace arris
