// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloth_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/obstacle_input/obstacle_shapes.h"
#include "geometry/surgery/initial_target.h"
#include "solver/advance.h"
#include "solver/energy_balance.h"
#include "solver/step.h"

namespace arris {

ClothMesh make_sheet(Vec2 size, std::array<int, 2> resolution, GridPattern pattern, double pattern_angle)
{
    ClothGrid grid;
    grid.size = size;
    grid.resolution = resolution;
    grid.pattern = pattern;
    grid.pattern_angle = pattern_angle;
    return make_cloth_grid(grid);
}

void lay(ClothMesh& mesh, const Vec3& corner)
{
    for (std::size_t v = 0; v < mesh.world.size(); ++v)
        mesh.world[v] = Vec3(mesh.material[v].x(), mesh.material[v].y(), 0.0) + corner;
}

Scene make_table_scene(const ClothMesh& mesh, const Material& material, const Vec3& size, const Vec3& middle)
{
    Scene scene;
    scene.materials[0] = material;
    scene.gravity = Gravity{};
    Placement place;
    place.translation = middle;
    scene.obstacles.push_back(MovingObstacle("table", make_box(size), place, {}, 30.0));
    scene.eol = make_initial_target(mesh);
    return scene;
}

ClothRun::ClothRun(Scene a_scene, ClothMesh mesh, const Vec3& velocity)
    : scene(std::move(a_scene)), state(make_state(scene, std::move(mesh), velocity))
{
    prepare(scene, state, work);
}

StepReport ClothRun::advance(double dt, const Look& look)
{
    StepReport last;
    const auto accept = [&](const StepReport& report, bool) {
        EXPECT_LE(report.kkt_residual, settings.tolerance);
        last = report;
        if (look) look(report);
        return true;
    };
    const double begin = state.time;
    const std::optional<StepReport> failed =
        arris::advance(scene, settings, state.time + dt, state, work, accept);
    EXPECT_FALSE(failed) << "at " << begin << " s, status " << static_cast<int>(failed->status);
    return last;
}

void ClothRun::advance(double duration, double dt, const Look& look)
{
    const double begin = state.time;
    const int steps = static_cast<int>(std::ceil(duration / dt - 1e-9));
    for (int k = 1; k <= steps && !failures.any(); ++k)
        advance(begin + duration * k / steps - state.time, look);
}

ClothEnergy measure_energy(ClothRun& run)
{
    const State& state = run.state;
    prepare(run.scene, state, run.work);  // rebuilds the elements where material has flowed
    return compute_cloth_energy(
        run.scene, run.work,
        {state.mesh.world, state.mesh.material, {state.velocity, state.material_velocity}});
}

EnergySpan watch_energy(ClothRun& run, double duration, double dt,
                        const std::function<void(const StepReport&)>& look)
{
    const double first = measure_energy(run).sum(), begin = run.state.time;
    EnergySpan span{first, first, first};
    const int steps = static_cast<int>(std::ceil(duration / dt - 1e-9));
    for (int k = 1; k <= steps && !run.failures.any(); ++k) {
        const StepReport report = run.advance(begin + duration * k / steps - run.state.time);
        span.last = measure_energy(run).sum();
        span.greatest = std::max(span.greatest, span.last);
        look(report);
    }
    return span;
}

void settle(ClothRun& run)
{
    constexpr double kStill = 1e-10;  // greatest motion in one step of cloth at rest, over the cloth's size
    // Greatest motion in one step for which the next step may grow, over the cloth's size.
    constexpr double kGentle = 0.02;
    constexpr int kMostSteps = 3000;
    const double size = material_size(run.state.mesh.material);
    run.settings.integrator = Integrator::ImplicitEuler;
    double dt = 1e-3, moved = 0.0;
    for (int k = 0; k < kMostSteps; ++k) {
        const std::vector<Vec3> before = run.state.mesh.world;
        run.state.time = 0.0;
        std::fill(run.state.velocity.begin(), run.state.velocity.end(), Vec3::Zero());
        run.advance(dt);
        if (run.failures.any()) return;
        moved = 0.0;
        for (std::size_t v = 0; v < before.size(); ++v)
            moved = std::max(moved, (run.state.mesh.world[v] - before[v]).norm());
        constexpr double kLongest = 1e4;
        if (moved < kStill * size && dt >= kLongest) return;
        if (moved < kGentle * size)
            dt = std::min(2.0 * dt, kLongest);
        else if (moved > 4.0 * kGentle * size)
            dt *= 0.5;
    }
    FAIL() << "still moving by " << moved << " m a step";
}

}  // namespace arris
