// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/obstacle/obstacle.h"

namespace arris {

/// A slab 40 m wide. Its upper side is the plane normal . x = offset (m), with unit `normal`.
inline MovingObstacle make_floor(const Vec3& normal = Vec3::UnitZ(), double offset = 0.0)
{
    ObstacleMesh slab;
    for (int corner = 0; corner < 8; ++corner)
        slab.points.push_back(
            {corner & 1 ? 20.0 : -20.0, corner & 2 ? 20.0 : -20.0, corner & 4 ? 0.0 : -1.0});
    slab.faces = {{4, 5, 7}, {4, 7, 6}, {0, 3, 1}, {0, 2, 3}, {0, 1, 5}, {0, 5, 4},
                  {2, 7, 3}, {2, 6, 7}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    const Mat3 lean = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), normal).toRotationMatrix();
    return MovingObstacle("floor", std::move(slab), {lean, offset * normal}, {}, 30.0);
}

}  // namespace arris
