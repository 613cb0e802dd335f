// SPDX-License-Identifier: GPL-3.0-or-later
// Friction at an impact: a sheet that lands flat with normal speed w loses mu w along the floor, or all of
// its speed if that is less.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cloth_run.h"
#include "geometry/surgery/initial_target.h"
#include "grid_patterns.h"
#include "tests/solver/floor.h"

namespace arris {
namespace {

constexpr double kThickness = 1e-3, kDown = 0.5;  // m, m/s
constexpr double kDuration = 0.1;                 // s
// Redundant contacts between layers share an impact: relative error of its friction.
constexpr double kOnLayer = 3e-3;
constexpr int kPhases = 8;  // of a step, at which the sheet lands

enum class Ground { Floor, Layer };

struct Landing {
    Ground ground;
    Integrator integrator;
    double friction, along;  ///< coefficient; m/s
    double gravity = 0.0;    ///< m/s^2
    double step = 0.005;     ///< s
};

/// Mean velocity along the ground after kDuration, m/s. `phase`: of the landing in its step.
double land(const Landing& landing, double phase)
{
    Scene scene;
    scene.materials[0] = {0.15, 2000.0, 0.3, 1e-3, 0.0, kThickness};
    scene.friction = Friction{{landing.friction}, {}, {}};
    if (landing.gravity > 0.0) scene.gravity = Gravity{{0.0, 0.0, -landing.gravity}};
    ClothMesh cloth = make_sheet({0.2, 0.2}, {3, 3}, GridPattern::Cross);
    const int count = cloth.vertex_count();
    lay(cloth, {0.0, 0.0, kThickness + kDown * landing.step * (4.0 + phase)});
    if (landing.ground == Ground::Floor) {
        scene.obstacles.push_back(make_floor());
        scene.friction->of_pieces = {landing.friction};
    } else {
        scene.self_contact = ClothContact{kThickness};
        const ClothMesh below = make_sheet({0.5, 0.4}, {5, 4}, GridPattern::Cross);
        for (const Face& f : below.faces) cloth.faces.push_back({f[0] + count, f[1] + count, f[2] + count});
        for (const Vec2& p : below.material) {
            cloth.material.push_back(p + Vec2(1.0, 0.0));
            cloth.world.push_back({p.x() - 0.1, p.y() - 0.1, 0.0});
        }
        scene.pins.push_back({.material = {{1.0, 0.0}, {1.5, 0.4}}, .motion = {}});
    }
    ClothRun run(std::move(scene), cloth);
    run.settings.integrator = landing.integrator;
    for (int v = 0; v < count; ++v) run.state.velocity[v] = {landing.along, 0.0, -kDown};
    run.advance(kDuration, landing.step);
    double sum = 0.0, area = 0.0;
    for (const Face& face : run.state.mesh.faces) {
        if (face[0] >= count) continue;
        const std::vector<Vec2>& X = run.state.mesh.material;
        const double own = twice_area(X[face[0]], X[face[1]], X[face[2]]);
        for (const int v : face) sum += own / 3.0 * run.state.velocity[v].x();
        area += own;
    }
    return sum / area;
}

/// Greatest difference from `expected` over the phases, m/s.
double worst_of(const Landing& landing, double expected)
{
    double worst = 0.0;
    for (int k = 0; k < kPhases; ++k)
        worst = std::max(worst, std::abs(land(landing, static_cast<double>(k) / kPhases) - expected));
    return worst;
}

TEST(FrictionAtLanding, TakesMuTimesTheNormalSpeedAtAnyPhase)
{
    constexpr double kOnFloor = 1e-7;  // m/s: friction's springs give way by 3e-8
    for (const Ground ground : {Ground::Floor, Ground::Layer})
        for (const Integrator integrator : {Integrator::Bdf2, Integrator::ImplicitEuler})
            for (const double friction : {0.2, 0.5})
                for (const double along : {1.0, 0.05}) {  // slides on, sticks
                    const double expected = std::max(along - friction * kDown, 0.0);
                    EXPECT_LT(worst_of({ground, integrator, friction, along}, expected),
                              ground == Ground::Floor ? kOnFloor : kOnLayer * friction * kDown)
                        << static_cast<int>(ground) << " " << static_cast<int>(integrator) << " " << friction
                        << " " << along;
                }
}

// Friction of the weight, too, begins in the middle of a step: BDF2 misses mu g h / 2 at most.
TEST(FrictionAtLanding, ConvergesUnderGravityWithTheStep)
{
    constexpr double kGravity = 9.81, kFriction = 0.3, kAlong = 1.0, kExact = 1e-4;  // m/s^2, -, m/s, m/s
    const double expected = kAlong - kFriction * (kDown + kGravity * kDuration);
    for (const double step : {0.01, 0.005, 0.0025}) {
        const auto worst = [&](Integrator integrator) {
            return worst_of({Ground::Floor, integrator, kFriction, kAlong, kGravity, step}, expected);
        };
        EXPECT_LT(worst(Integrator::Bdf2), 0.5 * kFriction * kGravity * step + kExact) << step;
        EXPECT_LT(worst(Integrator::ImplicitEuler), kExact) << step;
    }
}

}  // namespace
}  // namespace arris
