// SPDX-License-Identifier: GPL-3.0-or-later
// Stiff cloth is thrown on the upper edge of a thin plate, off its middle, and slides off or hangs on the
// plate. EOL vertices are inserted and released on the plate's edges all the time. No force drives the cloth.
// So the energy that mesh changes add must stay small at any bending stiffness, resolved by the mesh or not.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "cloth_run.h"
#include "refinement.h"

namespace arris {
namespace {

constexpr double kSpeed = 2.0;  // m/s

ClothRun make_run(double stiffness, double width, double aside)
{
    ClothMesh mesh = make_sheet(Vec2(1.0, 1.0), {16, 16}, GridPattern::Cross);
    lay(mesh, Vec3(-0.45 + aside, -0.52, 0.24));
    Scene scene =
        make_table_scene(mesh, {0.05, 50.0, 0.01, stiffness, 0.0, 1e-3}, Vec3(width, 0.7, 0.4), Vec3::Zero());
    return ClothRun(std::move(scene), std::move(mesh), Vec3(0.0, 0.0, -kSpeed));
}

class ThinPlate : public ::testing::TestWithParam<double> {};

TEST_P(ThinPlate, DoesNotThrowStiffCloth)
{
    constexpr double kFall = 0.8, kStep = 0.005;  // s
    // Energy rise over the initial kinetic energy: the mean of falls that start within 1 mm, and the largest
    // of one fall. Each fall takes a different path. Measured means on 2 mm: 0.022 to 0.040; the least
    // stiffness has the largest rise, 0.06. If the mesh changes regardless of strain, the mean is 0.41.
    constexpr double kMeanRise = 0.06, kMostRise = 0.2;
    const double thrown = 0.5 * 0.05 * kSpeed * kSpeed;  // J
    double sum = 0.0;
    int falls = 0;
    for (const double stiffness : {2e-4, 3e-4, 1e-3})
        for (const double aside : {-1e-3, 0.0, 1e-3}) {
            ClothRun run = make_run(stiffness, GetParam(), aside);
            double least = measure_energy(run).sum(), rise = 0.0;
            run.advance(kFall, kStep, [&](const StepReport& report) {
                EXPECT_EQ(report.crossings, 0);
                const double energy = measure_energy(run).sum();
                rise = std::max(rise, energy - least);
                least = std::min(least, energy);
            });
            RecordProperty(fmt::format("rise_{}_{}", stiffness, aside), fmt::format("{:.2e}", rise));
            EXPECT_LT(rise, kMostRise * thrown) << stiffness << " J, " << GetParam() << " m";
            sum += rise;
            ++falls;
        }
    EXPECT_LT(sum / falls, kMeanRise * thrown) << GetParam() << " m";
}

INSTANTIATE_TEST_SUITE_P(Widths, ThinPlate, ::testing::Values(2e-3, 1e-2));

}  // namespace
}  // namespace arris
