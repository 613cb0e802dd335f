// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/forces/seam_spring.h"

#include <algorithm>

namespace arris {

double SeamSpring::energy(const SpringState& spring) const
{
    const double excess = std::max((spring.x[0] - spring.x[1]).norm() - spring.element.length, 0.0);
    return 0.5 * spring.element.stiffness * excess * excess;
}

void SeamSpring::add(const SpringState& spring, SpringSystem& system) const
{
    const SpringElement& element = spring.element;
    const Vec3 way = spring.x[0] - spring.x[1];
    const double distance = way.norm();
    if (!(element.stiffness > 0.0) || distance < element.length) return;
    // Along the way the stiffness is k; across it the force turns with the way, k (1 - l / d) >= 0.
    Mat3 stiffness = element.stiffness * Mat3::Identity();
    Vec3 pull = element.stiffness * way;
    if (element.length > 0.0) {
        const Vec3 along = way.stableNormalized();
        const double slack = distance > 0.0 ? element.length / distance : 1.0;
        stiffness -= element.stiffness * slack * (Mat3::Identity() - along * along.transpose());
        pull -= element.stiffness * element.length * along;
    }
    system.add_elastic_force(0, -pull);
    system.add_elastic_force(1, pull);
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j <= i; ++j) system.add_stiffness(i, j, i == j ? stiffness : Mat3(-stiffness));
}

}  // namespace arris
