// SPDX-License-Identifier: GPL-3.0-or-later
// The edge lengths that cloth of a known shape and motion asks for.
#include "solver/remesh/wanted_lengths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "geometry/cloth_input/cloth_grid.h"
#include "solver/model/target_length.h"
#include "solver/remesh/sizing_field.h"
#include "solver/step.h"

namespace arris {
namespace {

constexpr double kAngle = 0.5;  // rad

struct Sheet {
    Scene scene;
    State state;

    std::vector<float> wanted() const { return find_wanted_lengths(scene, state, make_stars(state.mesh)); }

    /// Edge length asked for in the middle, m: not the mesh's mean, which is shorter.
    double in_the_middle() const
    {
        return interpolate(scene.remesh->grid, wanted(), Vec2(0.5, 0.5)) / kMeanEdge;
    }
};

/// A sheet of 1 m x 1 m whose material is mapped by `shape`.
Sheet make_sheet(GridPattern pattern, int cells, const std::function<Vec3(const Vec2&)>& shape)
{
    Sheet sheet;
    ClothGrid grid;
    grid.size = {1.0, 1.0};
    grid.resolution = {cells, cells};
    grid.pattern = pattern;
    ClothMesh mesh = make_cloth_grid(grid);
    for (std::size_t v = 0; v < mesh.world.size(); ++v) mesh.world[v] = shape(mesh.material[v]);
    sheet.scene.materials[0] = {0.15, 500.0, 0.3, 1e-5, 0.0, 1e-3};
    Remeshing remesh;
    remesh.shortest = 0.01;
    remesh.longest = 0.5;
    remesh.angle = kAngle;
    remesh.most_vertices = 1000000;
    measure_first_mesh(mesh, remesh);
    sheet.scene.remesh = remesh;
    sheet.state = make_state(sheet.scene, std::move(mesh), Vec3::Zero());
    return sheet;
}

Vec3 flat(const Vec2& X)
{
    return {X.x(), X.y(), 0.0};
}

constexpr GridPattern kPatterns[] = {GridPattern::Diagonal, GridPattern::Alternating, GridPattern::Cross,
                                     GridPattern::Unstructured};

TEST(WantedLengths, AreTheLongestOnFlatClothAtRest)
{
    for (const GridPattern pattern : kPatterns)
        EXPECT_NEAR(make_sheet(pattern, 12, flat).in_the_middle(), 0.5, 1e-6);
}

TEST(WantedLengths, TurnByTheAngleOnACylinderOfAnyDirectionOnAnyMesh)
{
    constexpr double kRadius = 0.2;
    for (const GridPattern pattern : kPatterns)
        for (const double degrees : {0.0, 30.0, 45.0, 90.0}) {
            const double turn = degrees * std::numbers::pi / 180.0;
            const Vec2 along(std::cos(turn), std::sin(turn)), across(-along.y(), along.x());
            const Sheet sheet = make_sheet(pattern, 24, [&](const Vec2& X) {
                const double s = X.dot(along) / kRadius;
                return Vec3(kRadius * std::sin(s), X.dot(across), kRadius * std::cos(s));
            });
            EXPECT_NEAR(sheet.in_the_middle(), kAngle * kRadius, 0.1 * kAngle * kRadius)
                << static_cast<int>(pattern) << ", " << degrees << " degrees";
        }
}

TEST(WantedLengths, SeeAZigzagWhoseAnglesCancel)
{
    constexpr double kSlope = 0.6;
    const Sheet sheet = make_sheet(GridPattern::Diagonal, 20, [&](const Vec2& X) {
        const int column = static_cast<int>(std::lround(20.0 * X.x()));
        return Vec3(X.x() * std::cos(kSlope), X.y(), column % 2 == 0 ? 0.0 : 0.05 * std::sin(kSlope));
    });
    // Each hinge turns by 2 kSlope over a cell of .05 m; half of that counts.
    EXPECT_NEAR(sheet.in_the_middle(), kAngle * 0.05 / kSlope, 0.2 * kAngle * 0.05 / kSlope);
}

TEST(WantedLengths, LetVelocityDifferByItsLimitAndIgnoreCommonMotion)
{
    Sheet sheet = make_sheet(GridPattern::Cross, 12, flat);
    for (std::size_t v = 0; v < sheet.state.velocity.size(); ++v)
        sheet.state.velocity[v] = Vec3(100.0, 0.0, 8.0 * sheet.state.mesh.material[v].x());
    EXPECT_NEAR(sheet.in_the_middle(), sheet.scene.remesh->velocity / 8.0, 1e-3);
}

TEST(WantedLengths, HalveWhereClothIsCompressedAndCouldBuckle)
{
    const auto squeezed = [](double share) {
        return make_sheet(GridPattern::Cross, 8,
                          [share](const Vec2& X) { return Vec3(share * X.x(), X.y(), 0.0); });
    };
    EXPECT_NEAR(squeezed(0.996).in_the_middle(), 0.5, 1e-6) << "below the limit of .005";
    const Sheet sheet = squeezed(0.95);
    const double now =
        interpolate(sheet.scene.remesh->grid, sheet.state.sizing_field, Vec2(0.5, 0.5)) / kMeanEdge;
    EXPECT_NEAR(sheet.in_the_middle(), 0.5 * now, 0.01 * now);
}

TEST(WantedLengths, GiveAWrinkleFourCellsWhateverTheBendingModel)
{
    constexpr double kStrain = 0.05, kStiffness = 0.08;  // J, so stiff that no halving limits the length
    Sheet sheet = make_sheet(GridPattern::Cross, 8,
                             [](const Vec2& X) { return Vec3((1.0 - kStrain) * X.x(), X.y(), 0.0); });
    Material& material = sheet.scene.materials[0];
    material.bending_stiffness = kStiffness;
    for (const auto& [model, rigidity] : {std::pair(BendingModel::Hinge, 4.0 / 3.0 * kStiffness),
                                          std::pair(BendingModel::Plate, kStiffness)}) {
        material.bending_model = model;
        const double wave =
            2.0 * std::numbers::pi * std::sqrt(rigidity / (material.youngs_modulus * kStrain));
        EXPECT_NEAR(sheet.in_the_middle(), 0.25 * wave, 1e-3 * wave);
    }
}

TEST(WantedLengths, HaveNoSteps)
{
    const Sheet sheet = make_sheet(GridPattern::Cross, 30, [](const Vec2& X) {
        const double s = std::max(0.0, X.x() - 0.5) / 0.1;  // flat, then a cylinder
        return X.x() < 0.5 ? Vec3(X.x(), X.y(), 0.0)
                           : Vec3(0.5 + 0.1 * std::sin(s), X.y(), 0.1 * (1.0 - std::cos(s)));
    });
    const std::vector<float> wanted = sheet.wanted();
    const MaterialGrid& grid = sheet.scene.remesh->grid;
    EXPECT_LT(interpolate(grid, wanted, Vec2(0.8, 0.5)), 0.05);
    EXPECT_GT(interpolate(grid, wanted, Vec2(0.05, 0.5)), 0.2);
    for (int i = 0; i + 1 < grid.count[0]; ++i)
        for (int j = 0; j < grid.count[1]; ++j)
            EXPECT_LE(std::abs(wanted[grid.index(i + 1, j)] - wanted[grid.index(i, j)]),
                      0.5 * grid.spacing + 1e-6);
}

TEST(WantedLengths, GrowByOneFactorWhereTheBudgetIsSmaller)
{
    Sheet sheet = make_sheet(GridPattern::Cross, 16, [](const Vec2& X) {
        return Vec3(0.1 * std::sin(X.x() / 0.1), X.y(), 0.1 * std::cos(X.x() / 0.1));
    });
    const double free = sheet.in_the_middle();
    const double cell =
        interpolate(sheet.scene.remesh->grid, sheet.state.sizing_field, Vec2(0.5, 0.5)) / kMeanEdge;
    // Vertices go with 1 / length^2.
    const double vertices = sheet.state.mesh.vertex_count() * cell * cell / (free * free);
    sheet.scene.remesh->most_vertices = static_cast<int>(vertices / 4.0);
    EXPECT_NEAR(sheet.in_the_middle(), 2.0 * free, 0.3 * free);
}

TEST(CellLengths, BecomeLongerThanAskedForWhereTheBudgetIsSmaller)
{
    Sheet sheet = make_sheet(GridPattern::Cross, 10, flat);
    Remeshing& remesh = *sheet.scene.remesh;
    remesh.shortest = 1e-4;
    remesh.longest = 2e-4;
    remesh.most_vertices = 300;
    measure_first_mesh(sheet.state.mesh, remesh);
    // 300 vertices have 600 equilateral faces, with edges of kMeanEdge of the length that is asked for.
    const double edge = kMeanEdge * remesh.longest;
    EXPECT_NEAR(600.0 * std::sqrt(3.0) / 4.0 * edge * edge, 1.0, 1e-9);

    remesh.longest = 0.5;
    measure_first_mesh(sheet.state.mesh, remesh);
    EXPECT_EQ(remesh.longest, 0.5);
}

TEST(WantedLengths, AreAtAPinnedPointNoShorterThanTheFirstMeshs)
{
    Sheet sheet = make_sheet(GridPattern::Cross, 10, [](const Vec2& X) {
        return Vec3(0.05 * std::sin(X.x() / 0.05), X.y(), 0.05 * std::cos(X.x() / 0.05));
    });
    const auto at_corner = [&] {
        return interpolate(sheet.scene.remesh->grid, sheet.wanted(), Vec2(0.1, 0.1)) / kMeanEdge;
    };
    const double fine = sheet.in_the_middle(), fine_at_corner = at_corner();
    const double first = sheet.scene.remesh->initial.length(Vec2(0.5, 0.5)) / kMeanEdge;
    EXPECT_LT(fine, 0.5 * first);
    Pin pin;
    pin.material = {Vec2(0.5, 0.5), Vec2(0.5, 0.5)};
    pin.release = 1.0;
    sheet.scene.pins = {pin};
    EXPECT_NEAR(sheet.in_the_middle(), first, 1e-6);
    EXPECT_NEAR(at_corner(), fine_at_corner, 1e-6);
    sheet.scene.pins[0].material = {Vec2(0.5, 0.0), Vec2(0.5, 1.0)};
    EXPECT_NEAR(sheet.in_the_middle(), fine, 1e-6) << "a line bears any load";
    sheet.scene.pins = {pin};
    sheet.state.time = 2.0;
    EXPECT_NEAR(sheet.in_the_middle(), fine, 1e-6) << "after its release";
}

TEST(CellLengths, HalveInAHundredthOfASecondAndGrowMoreSlowly)
{
    Sheet sheet = make_sheet(GridPattern::Cross, 8, [](const Vec2& X) {
        return Vec3(0.02 * std::sin(X.x() / 0.02), X.y(), 0.02 * std::cos(X.x() / 0.02));
    });
    const ClothStars stars = make_stars(sheet.state.mesh);
    const auto now = [&] {
        return interpolate(sheet.scene.remesh->grid, sheet.state.sizing_field, Vec2(0.5, 0.5));
    };
    const double begin = now();
    follow_wanted_lengths(sheet.scene, stars, 0.01 / kRemeshPeriod, sheet.state);
    EXPECT_NEAR(now(), 0.5 * begin, 1e-3 * begin);
    for (std::size_t v = 0; v < sheet.state.mesh.world.size(); ++v)
        sheet.state.mesh.world[v] = flat(sheet.state.mesh.material[v]);
    follow_wanted_lengths(sheet.scene, stars, 0.07 / kRemeshPeriod, sheet.state);
    EXPECT_NEAR(now(), begin, 1e-3 * begin);
}

}  // namespace
}  // namespace arris
