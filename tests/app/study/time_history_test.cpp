// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/time_history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/app/error_of.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(TimeHistory, CubicInterpolationIsExactForACubicOnUnevenTimes)
{
    const auto cubic = [](double t) { return 2.0 - t + 3.0 * t * t - 0.5 * t * t * t; };
    TimeHistory history;
    for (const double t : {0.0, 0.1, 0.4, 0.5, 0.9, 1.0}) {
        history.times.push_back(t);
        history.values.push_back(cubic(t));
    }
    const std::vector<double> times = {0.0, 0.05, 0.3, 0.45, 0.7, 0.95, 1.0};
    const std::vector<double> values = interpolate(history, times, Interpolation::Cubic, "here");
    for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(values[i], cubic(times[i]), 1e-14) << times[i];
    EXPECT_NEAR(interpolate(history, {0.2}, Interpolation::Linear, "here")[0],
                cubic(0.1) + (cubic(0.4) - cubic(0.1)) / 3.0, 1e-14);
}

TEST(TimeHistory, TimesOutsideAreAnError)
{
    const TimeHistory history = {{0.0, 1.0}, {2.0, 3.0}};
    EXPECT_THAT(error_of([&] { interpolate(history, {1.5}, Interpolation::Cubic, "ref.csv"); }),
                HasSubstr("ref.csv: has no value at 1.5 s; it covers 0 to 1 s"));
    EXPECT_THAT(interpolate(history, {1.0 + 1e-12}, Interpolation::Cubic, ""), ElementsAre(3.0));
}

TEST(TimeHistory, AProbeIsItsDisplacementAndAColumnItsValue)
{
    const TemporaryDirectory folder;
    write_bytes(folder / "probes.csv", "time,tip_x,tip_y,tip_z\n0,1,2,3\n0.5,1,2,2.5\n");
    write_bytes(folder / "steps.csv", "time,bending_energy\n0,\n0.5,4\n");
    ErrorRule rule;
    rule.probe = "tip";
    EXPECT_THAT(read_history(folder.path(), rule).values, ElementsAre(0.0, -0.5));
    rule.quantity = ErrorRule::Quantity::Column;
    rule.column = "bending_energy";
    const TimeHistory energy = read_history(folder.path(), rule);
    EXPECT_THAT(energy.times, ElementsAre(0.5)) << "rows without a value are left out";
    EXPECT_THAT(energy.values, ElementsAre(4.0));
}

TEST(TimeHistory, AReferenceFileHasTimeAndValueOrIsThatOfARun)
{
    const TemporaryDirectory folder;
    ErrorRule rule;
    rule.probe = "tip";
    write_bytes(folder / "a.csv", "time,value\n0,7\n1,8\n");
    EXPECT_THAT(read_reference_file(folder / "a.csv", rule).values, ElementsAre(7.0, 8.0));
    write_bytes(folder / "b.csv", "time,tip_z\n0,7\n1,8\n");
    EXPECT_THAT(read_reference_file(folder / "b.csv", rule).values, ElementsAre(0.0, 1.0));
    write_bytes(folder / "c.csv", "time,other\n0,7\n");
    EXPECT_THAT(error_of([&] { read_reference_file(folder / "c.csv", rule); }),
                HasSubstr("columns time and value"));
    write_bytes(folder / "d.csv", "time,value\n1,7\n0,8\n");
    EXPECT_THAT(error_of([&] { read_reference_file(folder / "d.csv", rule); }),
                HasSubstr("row 2 is not later"));
    write_bytes(folder / "e.csv", "time,value\n0,inf\n");
    EXPECT_THAT(error_of([&] { read_reference_file(folder / "e.csv", rule); }), HasSubstr("is not finite"));
    EXPECT_THAT(error_of([&] { read_reference_file(folder / "f.csv", rule); }),
                HasSubstr("cannot be opened"));
}

}  // namespace
}  // namespace arris
