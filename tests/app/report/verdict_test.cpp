// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/report/verdict.h"

#include <gtest/gtest.h>

namespace arris {
namespace {

RunReport finished(bool has_obstacle, bool has_self_contact)
{
    RunReport report;
    report.effects = {{"obstacle", has_obstacle, ""}, {"self_contact", has_self_contact, ""}};
    report.scene = {{"duration", 2.0}};
    return report;
}

TEST(Verdict, SaysOnlyWhatWasChecked)
{
    EXPECT_EQ(verdict(finished(true, true)), "Finished. Nothing passed through anything. No warnings.");
    EXPECT_EQ(verdict(finished(true, false)),
              "Finished. The cloth passed through no obstacle; whether through itself was not checked. No "
              "warnings.");
    EXPECT_EQ(verdict(finished(false, true)),
              "Finished. The cloth did not pass through itself. No warnings.");
    EXPECT_EQ(verdict(finished(false, false)),
              "Finished. There was no obstacle; whether the cloth passed through itself was not checked. No "
              "warnings.");
}

TEST(Verdict, CountsWarningsAndPassages)
{
    RunReport report = finished(true, true);
    report.warnings = {"a"};
    EXPECT_EQ(verdict(report), "Finished. Nothing passed through anything. 1 warning.");
    report.warnings = {"a", "b", "c"};
    report.totals.crossings = 2;
    EXPECT_EQ(verdict(report),
              "Finished. Something passed through the cloth or an obstacle 2 times. 3 warnings.");
    EXPECT_TRUE(has_passed_through(report.totals));
    report.totals = {};
    EXPECT_FALSE(has_passed_through(report.totals));
    report.totals.max_penetration = 1e-4;
    EXPECT_EQ(verdict(report), "Finished. The cloth was inside an obstacle, 0.0001 m deep. 3 warnings.");
    EXPECT_TRUE(has_passed_through(report.totals));
}

TEST(Verdict, SaysWhereAndWhyARunEnded)
{
    RunReport report = finished(true, true);
    report.totals.simulated_seconds = 0.25;
    report.status = RunStatus::Infeasible;
    report.message = "pin.0 holds vertex 7 where the table is";
    EXPECT_EQ(verdict(report),
              "Stopped at 0.25 s of 2 s: pin.0 holds vertex 7 where the table is. Nothing passed through "
              "anything. No "
              "warnings.");
    report.status = RunStatus::Interrupted;
    EXPECT_EQ(
        verdict(report),
        "Interrupted at 0.25 s of 2 s; arris resume continues the run. Nothing passed through anything. No "
        "warnings.");
}

}  // namespace
}  // namespace arris
