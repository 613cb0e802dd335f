// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/step.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/cloth_grid.h"
#include "physics/inertia.h"

namespace arris {
namespace {

ClothMesh make_sheet(Vec2 size, std::array<int, 2> resolution, GridPattern pattern = GridPattern::Cross)
{
    ClothGrid grid;
    grid.size = size;
    grid.resolution = resolution;
    grid.pattern = pattern;
    return make_cloth_grid(grid);
}

Material soft_cloth()
{
    return {0.05, 50.0, 0.3, 1e-5, 0.0, 1e-3};
}

/// Steps of equal length until `end`.
void advance(const Scene& scene, const Settings& settings, double end, State& state, Workspace& work)
{
    const double begin = state.time;
    const int steps = static_cast<int>(std::ceil((end - begin) / settings.step - 1e-9));
    for (int k = 1; k <= steps; ++k) {
        const StepReport report = step(scene, settings, begin + (end - begin) * k / steps, state, work);
        ASSERT_EQ(report.status, StepStatus::Done);
        ASSERT_LE(report.kkt_residual, settings.tolerance);
    }
}

TEST(Step, FreeFallIsTheParabola)
{
    Scene scene;
    scene.material = soft_cloth();
    scene.gravity = Gravity{};
    for (const Integrator integrator : {Integrator::ImplicitEuler, Integrator::Bdf2}) {
        Settings settings;
        settings.integrator = integrator;
        State state = make_state(scene, make_sheet(Vec2(1, 1), {4, 4}), Vec3(1.0, 0.0, 2.0));
        Workspace work;
        const Vec3 start = state.mesh.world[7];
        advance(scene, settings, 0.5, state, work);
        const Vec3 exact = start + Vec3(0.5, 0.0, 1.0 - 0.5 * 9.81 * 0.25);
        // Implicit Euler takes g h at the step's end: it falls g h t / 2 further. BDF2: only its first step
        // does, by h^2 g / 2.
        const double h = settings.step;
        const double lag = integrator == Integrator::Bdf2 ? 9.81 * h * h : 0.5 * 9.81 * h * 0.5;
        EXPECT_LT((state.mesh.world[7] - exact).norm(), 1.01 * lag);
        const Vec3 momentum = linear_momentum(0.05, work.elements, state.velocity);
        EXPECT_LT((momentum - 0.05 * Vec3(1.0, 0.0, 2.0 - 9.81 * 0.5)).norm(), 1e-13);
    }
}

}  // namespace
}  // namespace arris
