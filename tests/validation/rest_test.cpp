// SPDX-License-Identifier: GPL-3.0-or-later
// Cloth at rest. All changes of energy are round-off there, or the way by which rows give way. Compared with
// themselves they looked like a rise of energy, and most steps were solved five times.
#include <gtest/gtest.h>

#include <algorithm>

#include "cloth_run.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "geometry/surgery/initial_target.h"
#include "grid_patterns.h"
#include "tests/failures_since.h"

namespace arris {
namespace {

constexpr double kThickness = 1e-3;  // m

struct Rest {
    const char* name;
    Vec3 box;       ///< m, below the cloth
    double height;  ///< m, of the box's top
    Vec2 size;      ///< m, of the sheet
    double youngs_modulus, bending;
    bool has_eol;
    Integrator integrator = Integrator::Bdf2;
};

constexpr double kWide = 2.0;

const Rest kRests[] = {
    {"on a table", {kWide, kWide, 0.1}, 0.0, {0.5, 0.4}, 1000.0, 1e-5, true},
    {"on a table, rows and bounds alone", {kWide, kWide, 0.1}, 0.0, {0.5, 0.4}, 1000.0, 1e-5, false},
    {"a kilometre up", {kWide, kWide, 0.1}, 1000.0, {0.5, 0.4}, 1000.0, 1e-5, true},
    {"stiff", {kWide, kWide, 0.1}, 0.1, {0.5, 0.4}, 1e6, 1e-3, true},
    {"implicit Euler", {kWide, kWide, 0.1}, 0.0, {0.5, 0.4}, 1000.0, 1e-5, true, Integrator::ImplicitEuler},
    {"over two edges", {0.3, kWide, 0.1}, 0.2, {0.5, 0.4}, 1000.0, 1e-4, true},
    {"over two edges, rows", {0.3, kWide, 0.1}, 0.2, {0.5, 0.4}, 1000.0, 1e-4, false},
};

TEST(Rest, TakesOneSolveAStepAndStaysThere)
{
    for (const Rest& rest : kRests) {
        const FailuresSince failures;
        ClothMesh mesh = make_sheet(rest.size, {10, 8}, GridPattern::Cross);
        lay(mesh, Vec3(-0.5 * rest.size.x(), -0.5 * rest.size.y(), rest.height + kThickness));
        Scene scene;
        scene.materials[0] = {0.2, rest.youngs_modulus, 0.3, rest.bending, 0.01, kThickness};
        scene.gravity = Gravity{};
        Placement place;
        place.translation = Vec3(0.0, 0.0, rest.height - 0.5 * rest.box.z());
        scene.obstacles.push_back(MovingObstacle("box", make_box(rest.box), place, {}, 30.0));
        if (rest.has_eol) scene.eol = make_initial_target(mesh);
        // Held in the middle, as nothing else keeps it from sliding off.
        Pin pin;
        pin.material = {0.5 * rest.size - Vec2(0.03, 0.03), 0.5 * rest.size + Vec2(0.03, 0.03)};
        scene.pins = {pin};
        ClothRun run(std::move(scene), std::move(mesh));
        run.settings.integrator = rest.integrator;
        run.advance(4.0, 0.005);  // until what hangs over an edge has come to rest
        if (failures.any()) {
            ADD_FAILURE() << rest.name;
            continue;
        }
        const std::vector<Vec3> at_rest = run.state.mesh.world;
        int solves = 0, steps = 0;
        run.advance(1.0, 0.005, [&](const StepReport& report) {
            solves += report.solves;
            ++steps;
        });
        EXPECT_LE(solves, 1.02 * steps) << rest.name;
        double moved = 0.0;
        for (std::size_t v = 0; v < at_rest.size() && run.state.mesh.world.size() == at_rest.size(); ++v)
            moved = std::max(moved, (run.state.mesh.world[v] - at_rest[v]).norm());
        EXPECT_LT(moved, 1e-4) << rest.name;
    }
}

}  // namespace
}  // namespace arris
