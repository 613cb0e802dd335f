// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "app/scene/parts/obstacle_records.h"
#include "tests/formula_deformation.h"

namespace arris {

/// Where a point of a stretching obstacle is, in the obstacle's frame: it grows along x from 0 s on, and by
/// its own length a second.
inline Vec3 stretched(const Vec3& rest, double time)
{
    return {rest.x() * (1.0 + time), rest.y(), rest.z()};
}

/// An obstacle of this mesh that stretches.
inline ObstacleRecord make_stretching(const std::string& name, ObstacleMesh mesh)
{
    auto deformation = std::make_shared<FormulaDeformation>(
        mesh.points, stretched, [](const Vec3& rest, double) { return Vec3(rest.x(), 0.0, 0.0); },
        std::vector<double>{0.0, 100.0});
    return {name, std::move(mesh), {}, {}, std::move(deformation)};
}

}  // namespace arris
