// SPDX-License-Identifier: GPL-3.0-or-later
#include "cantilever.h"

#include <algorithm>
#include <cmath>

#include "cloth_run.h"

namespace arris {

Tip settle_cantilever(const ClothMesh& strip, const Material& material, double weight, double tip_load)
{
    double width = 0.0;
    for (const Vec2& X : strip.material) width = std::max(width, X.y());
    Scene scene;
    scene.materials[0] = material;
    scene.gravity = Gravity{Vec3(0.0, 0.0, -weight / material.density)};
    scene.pins.push_back({{Vec2(1.0, 0.0), Vec2(1.0, width)}, {}, {true, true, true}});
    if (tip_load > 0.0)
        for (const double u : {0.0, 2.0})
            scene.pulls.push_back({{Vec2(u, 0.0), Vec2(u, width)}, Vec3(0.0, 0.0, -tip_load * width)});

    ClothRun run(scene, strip);
    settle(run);
    Tip tip{0.0, 0.0, 0.0};
    const std::vector<int> line = vertices_inside(run.state.mesh, {Vec2(2.0, 0.0), Vec2(2.0, width)});
    const auto count = static_cast<double>(line.size());
    for (const int v : line) {
        const Vec3 moved = run.state.mesh.world[v] - Vec3(1.0, run.state.mesh.material[v].y(), 0.0);
        tip.x += moved.x() / count;
        tip.y -= moved.z() / count;
        tip.sideways += std::abs(moved.y()) / count;
    }
    return tip;
}

}  // namespace arris
