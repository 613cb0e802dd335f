// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/friction_warning.h"

#include <gtest/gtest.h>

namespace arris {
namespace {

StepReport report_of(double residual, const Vec3& place)
{
    StepReport report;
    report.friction_residual = residual;
    report.friction_place = place;
    return report;
}

TEST(FrictionWarning, NamesTheWorstStepItsTimeAndPlace)
{
    FrictionPeak peak;
    note_friction(report_of(0.25, Vec3(1, 2, 3)), 0.1, peak);
    note_friction(report_of(0.75, Vec3(0.5, 0, -0.125)), 0.2, peak);
    note_friction(report_of(0.5, Vec3(4, 5, 6)), 0.3, peak);
    note_friction(report_of(1e-5, Vec3(7, 8, 9)), 0.4, peak);
    const std::vector<std::string> lines = warn_of_friction(peak);
    ASSERT_EQ(lines.size(), 1u);
    for (const char* part : {"3 steps", "75 %", "t = 0.2 s", "[0.5, 0, -0.125]"})
        EXPECT_NE(lines[0].find(part), std::string::npos) << part << " in: " << lines[0];
}

TEST(FrictionWarning, IsNoneWhereFrictionIsNearItsLaw)
{
    FrictionPeak peak;
    note_friction(report_of(5e-4, Vec3(1, 2, 3)), 0.1, peak);
    EXPECT_TRUE(warn_of_friction(peak).empty());
}

}  // namespace
}  // namespace arris
