// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/scatter.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace arris {
namespace {

TEST(Scatter, HasTheQuantilesOfItsSamples)
{
    const Scatter scatter({5.0, 1.0, 4.0, 2.0, 3.0});
    EXPECT_EQ(scatter.median(), 3.0);
    EXPECT_EQ(scatter.quantile(0.0), 1.0);
    EXPECT_EQ(scatter.quantile(0.125), 1.5);
    EXPECT_EQ(scatter.quantile(1.0), 5.0);
    EXPECT_EQ(Scatter({7.0}).median(), 7.0);
    EXPECT_EQ(Scatter({7.0}).error(), 0.0);
}

TEST(Scatter, EstimatesDeviationAndErrorOfNormalSamples)
{
    std::mt19937 random(1);
    std::normal_distribution<double> normal(2.0, 0.5);
    std::vector<double> values(20001), medians(401);
    for (double& value : values) value = normal(random);
    EXPECT_NEAR(Scatter(values).deviation(), 0.5, 0.02);
    const int count = 101;
    double error = 0.0;
    for (double& median : medians) {
        std::vector<double> few(count);
        for (double& value : few) value = normal(random);
        const Scatter scatter(few);
        median = scatter.median();
        error += scatter.error() / static_cast<double>(medians.size());
    }
    EXPECT_NEAR(error, Scatter(medians).deviation(), 0.1 * error);
}

TEST(Scatter, ABoundHasToBeFourErrorsAway)
{
    const Scatter scatter({0.9, 1.0, 1.1});
    const double away = kErrorsAway * scatter.error();
    EXPECT_TRUE(median_is_below(scatter, 1.001 + away));
    EXPECT_FALSE(median_is_below(scatter, 0.999 + away));
    EXPECT_TRUE(median_is_above(scatter, 0.999 - away));
    EXPECT_FALSE(median_is_above(scatter, 1.001 - away));
    EXPECT_TRUE(median_is_near(scatter, 1.05, 0.051 + away));
    EXPECT_FALSE(median_is_near(scatter, 1.05, 0.049 + away));
    EXPECT_FALSE(median_is_below(Scatter({std::numeric_limits<double>::quiet_NaN()}), 1.0));
}

}  // namespace
}  // namespace arris
