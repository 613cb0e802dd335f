// SPDX-License-Identifier: GPL-3.0-or-later
// A square of cotton falls onto a smaller box and slides over its edges. Prints height and EOL vertices over
// time.
#include <algorithm>
#include <cstdio>

#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "geometry/surgery/initial_target.h"
#include "solver/advance.h"
#include "solver/step.h"

int main()
{
    using namespace arris;
    ClothMesh cloth = make_cloth_grid({.size = {1.0, 1.0}, .resolution = {8, 8}});
    for (Vec3& x : cloth.world) x += Vec3(-0.3, -0.4, 0.1);  // m; up is +z

    Scene scene;
    scene.materials = *find_material_preset("cotton");
    scene.gravity = Gravity{};
    scene.obstacles.emplace_back("box", make_box({0.5, 0.5, 0.1}), Placement{}, RigidMotion{}, 30.0);
    scene.eol = make_initial_target(cloth);

    const Settings settings;
    State state = make_state(scene, cloth, Vec3::Zero());
    Workspace work;
    for (int k = 1; k <= 60; ++k) {  // advance makes one step, or several where one is not accepted
        const auto failed = advance(scene, settings, k * settings.step, state, work,
                                    [](const StepReport&, bool) { return true; });
        if (failed) return std::puts("no step was possible"), 1;
        double lowest = 1e9;
        for (const Vec3& x : state.mesh.world) lowest = std::min(lowest, x.z());
        std::printf("%.3f s: lowest point at %.6f m, %zu EOL vertices\n", state.time, lowest,
                    state.eol.size());
    }
}
