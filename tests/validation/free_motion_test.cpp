// SPDX-License-Identifier: GPL-3.0-or-later
// Cloth in free flight: the parabola, and conservation of momentum.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "cloth_run.h"
#include "physics/forces/inertia.h"
#include "refinement.h"

namespace arris {
namespace {

constexpr std::array kIntegrators = {Integrator::ImplicitEuler, Integrator::Bdf2};
constexpr double kG = 9.81;

TEST(FreeFall, LagsTheParabolaByExactlyWhatTheIntegratorDoes)
{
    // Implicit Euler: y_n = -g h^2 n (n + 1) / 2 = -g t^2 / 2 - g h t / 2. BDF2 is exact except for its first
    // third of a step, which is made with implicit Euler and leaves the error e = -g h^2 / 18. The second
    // step is twice and the third 1.5 times as long as the step before. These steps raise the error to 9/5 e
    // and 9/4 e. From there (4 e_n - e_(n-1)) / 3 tends to 99/40 e.
    Scene scene;
    scene.materials[0] = {0.05, 50.0, 0.3, 1e-5, 0.0, 1e-3};
    scene.gravity = Gravity{Vec3(0.0, 0.0, -kG)};
    for (const Integrator integrator : kIntegrators) {
        const double h = 0.005, t = 0.5;
        const Vec3 velocity(1.0, 0.0, 2.0);
        ClothRun run(scene, make_sheet(Vec2(1, 1), {6, 6}, GridPattern::Cross), velocity);
        run.settings.integrator = integrator;
        const std::vector<Vec3> start = run.state.mesh.world;
        run.advance(t, h);
        const double lag = integrator == Integrator::Bdf2 ? kBdf2StartLag * kG * h * h : 0.5 * kG * h * t;
        const Vec3 fall = velocity * t - Vec3(0.0, 0.0, 0.5 * kG * t * t + lag);
        for (std::size_t v = 0; v < start.size(); ++v)
            EXPECT_LT((run.state.mesh.world[v] - start[v] - fall).norm(), 1e-11) << "vertex " << v;
    }
}

/// A crumpled sheet, far from balance, that moves and turns.
ClothRun make_crumpled(Integrator integrator, const std::optional<Gravity>& gravity)
{
    ClothMesh mesh = make_sheet(Vec2(1, 1), {8, 8}, GridPattern::Alternating);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> noise(-0.02, 0.02);
    for (Vec3& x : mesh.world) x += Vec3(noise(random), noise(random), noise(random));
    Scene scene;
    scene.materials[0] = {0.05, 500.0, 0.3, 1e-3, 0.0, 1e-3};
    scene.gravity = gravity;
    ClothRun run(scene, mesh, Vec3(0.3, -0.2, 0.1));
    run.settings.integrator = integrator;
    return run;
}

TEST(LinearMomentum, IsKeptToRoundOff)
{
    for (const Integrator integrator : kIntegrators) {
        ClothRun run = make_crumpled(integrator, {});
        const Vec3 before = linear_momentum(Material{0.05}, run.work.mesh.elements, run.state.velocity);
        run.advance(1.0, 0.005);
        const Vec3 after = linear_momentum(Material{0.05}, run.work.mesh.elements, run.state.velocity);
        EXPECT_LT((after - before).norm(), 1e-12 * before.norm());
    }
}

TEST(LinearMomentum, GrowsByTheWeight)
{
    for (const Integrator integrator : kIntegrators) {
        ClothRun run = make_crumpled(integrator, Gravity{Vec3(1.0, 2.0, -kG)});
        const Vec3 before = linear_momentum(Material{0.05}, run.work.mesh.elements, run.state.velocity);
        run.advance(1.0, 0.005);
        const Vec3 after = linear_momentum(Material{0.05}, run.work.mesh.elements, run.state.velocity);
        EXPECT_LT((after - before - 0.05 * Vec3(1.0, 2.0, -kG)).norm(), 1e-12);
    }
}

TEST(AngularMomentum, OfASpinningSheetConvergesAtTheIntegratorsOrder)
{
    Table table("angular_momentum", {"step", "implicit Euler: loss", "step", "BDF2: loss"});
    // Both integrators must resolve the sheet's fastest modes; implicit Euler shows its order only at shorter
    // steps.
    const std::array<std::vector<double>, 2> steps = {std::vector{5e-4, 2.5e-4, 1.25e-4, 6.25e-5},
                                                      std::vector{1e-3, 5e-4, 2.5e-4, 1.25e-4}};
    std::array<std::vector<double>, 2> losses;
    for (int k = 0; k < 2; ++k)
        for (const double h : steps[k]) {
            Scene scene;
            scene.materials[0] = {0.05, 200.0, 0.3, 1e-4, 0.0, 1e-3};
            ClothMesh mesh = make_sheet(Vec2(0.4, 0.3), {4, 3}, GridPattern::Cross);
            for (Vec3& x : mesh.world) x -= Vec3(0.2, 0.15, 0.0);
            ClothRun run(scene, mesh);
            run.settings.integrator = kIntegrators[k];
            const Vec3 spin(0.5, -0.3, 6.0);  // rad/s
            for (std::size_t v = 0; v < mesh.world.size(); ++v)
                run.state.velocity[v] = spin.cross(mesh.world[v]);
            const auto momentum = [&] {
                return angular_momentum(Material{0.05}, run.work.mesh.elements, run.state.mesh.world,
                                        run.state.velocity);
            };
            const Vec3 before = momentum();
            double loss = 0.0;  // the maximum, as the loss oscillates
            run.advance(0.4, h, [&](const StepReport&) {
                loss = std::max(loss, (momentum() - before).norm() / before.norm());
            });
            ASSERT_FALSE(HasFailure());
            losses[k].push_back(loss);
        }
    for (std::size_t i = 0; i < steps[0].size(); ++i)
        table.add({fmt::format("{:g} ms", 1e3 * steps[0][i]), fmt::format("{:.3e}", losses[0][i]),
                   fmt::format("{:g} ms", 1e3 * steps[1][i]), fmt::format("{:.3e}", losses[1][i])});
    const double euler = order_of(steps[0], losses[0]), bdf2 = order_of(steps[1], losses[1]);
    table.add({"order", fmt::format("{:.3f}", euler), "order", fmt::format("{:.3f}", bdf2)});
    EXPECT_NEAR(euler, 1.0, 0.1);
    EXPECT_GT(bdf2, 1.85);
    EXPECT_LT(bdf2, 2.2);
}

}  // namespace
}  // namespace arris
