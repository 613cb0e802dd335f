// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/mesh_target.h"

namespace arris {

MeshTarget uniform_target(double length, double least_angle)
{
    return {[length](const Vec2&) { return length; },
            [least_angle](const Vec2&) { return least_angle; },
            {length}};
}

}  // namespace arris
