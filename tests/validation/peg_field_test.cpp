// SPDX-License-Identifier: GPL-3.0-or-later
// A sheet is launched over a field of pegs, mostly finer than its cells, and rubs on them as on a plate:
// Coulomb's law knows no areas. Most contacts there are beside an EOL vertex, and have their part of the
// friction.
#include <gtest/gtest.h>

#include <cmath>

#include "cloth_run.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "geometry/surgery/initial_target.h"

namespace arris {
namespace {

const Material kCotton = {0.15, 500.0, 0.3, 1e-5, 0.0, 1e-3};

struct PegField {
    const char* name;
    int cells;     ///< of a sheet 0.2 m wide
    double width;  ///< m, of a peg
    GridPattern pattern;
    double coefficient;
};

constexpr PegField kFields[] = {
    {"pegs of a sixth of a cell", 10, 0.003, GridPattern::Cross, 0.3},
    {"pegs of a quarter of a finer cell", 16, 0.003, GridPattern::Cross, 0.3},
    {"pins", 10, 0.0005, GridPattern::Diagonal, 0.3},
    {"pegs of half a cell", 10, 0.01, GridPattern::Alternating, 0.3},
    {"smooth pegs", 10, 0.003, GridPattern::Cross, 0.2},
    {"unstructured", 10, 0.003, GridPattern::Unstructured, 0.2},
};

ClothRun make_run(const PegField& field)
{
    constexpr double kTop = 0.0065;
    ClothMesh mesh = make_sheet(Vec2(0.2, 0.2), {field.cells, field.cells}, field.pattern);
    lay(mesh, Vec3(-0.1, -0.1, kTop + 0.0011));
    Scene scene;
    scene.materials[0] = kCotton;
    scene.gravity = Gravity{};
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 5; ++j) {
            Placement placement;
            placement.translation = Vec3(-0.085 + 0.025 * i, -0.07 + 0.035 * j, 0.5 * kTop);
            scene.obstacles.push_back(
                MovingObstacle("peg", make_box(Vec3(field.width, field.width, kTop)), placement, {}, 30.0));
        }
    Placement low;
    low.translation = Vec3(0.1, 0.0, -0.01);
    scene.obstacles.push_back(MovingObstacle("floor", make_box(Vec3(0.6, 0.4, 0.02)), low, {}, 30.0));
    scene.friction = Friction{std::vector<double>(scene.obstacles.size(), field.coefficient)};
    scene.eol = make_initial_target(mesh);
    return ClothRun(std::move(scene), std::move(mesh), Vec3(0.5, 0.0, 0.0));
}

TEST(PegField, SlowsAsAPlateDoes)
{
    constexpr double kDuration = 0.13;
    for (const PegField& field : kFields) {
        SCOPED_TRACE(field.name);
        ClothRun run = make_run(field);
        run.advance(kDuration, 0.004);
        const double mass = kCotton.density * 0.2 * 0.2;
        const double speed = std::sqrt(2.0 * measure_energy(run).kinetic / mass);
        // A contact has no friction in its first step, and part of the energy is that of cells that shake on
        // pegs.
        const double lost = (0.5 - speed) / (field.coefficient * 9.81 * kDuration);
        EXPECT_GT(lost, 0.75);
        EXPECT_LT(lost, 1.1);
    }
}

}  // namespace
}  // namespace arris
