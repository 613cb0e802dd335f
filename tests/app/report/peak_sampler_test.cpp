// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/report/peak_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace arris {
namespace {

std::vector<Sample> sampled(std::int64_t count, double (*value)(std::int64_t))
{
    PeakSampler sampler;
    for (std::int64_t i = 0; i < count; ++i) sampler.add({static_cast<double>(i), {value(i)}});
    return sampler.samples();
}

bool is_ascending(const std::vector<Sample>& samples)
{
    return std::is_sorted(samples.begin(), samples.end(),
                          [](const auto& a, const auto& b) { return a.x < b.x; });
}

TEST(PeakSampler, KeepsEverySampleOfAShortStream)
{
    EXPECT_TRUE(sampled(0, [](std::int64_t) { return 0.0; }).empty());
    for (const std::int64_t count : {1, 2, 499, 500}) {
        const auto samples = sampled(count, [](std::int64_t i) { return static_cast<double>(i * 7 % 13); });
        ASSERT_EQ(std::ssize(samples), count);
        for (std::int64_t i = 0; i < count; ++i) EXPECT_EQ(samples[i].x, static_cast<double>(i));
    }
}

TEST(PeakSampler, KeepsTheOnePeakOfAnyStreamInAThousandSamples)
{
    for (const std::int64_t count : {501, 1000, 1001, 4321, 100000, 1000003}) {
        const auto samples = sampled(count, [](std::int64_t i) {
            return i == 333 ? 1e9 : i == 77 ? -1e9 : std::sin(static_cast<double>(i));
        });
        EXPECT_LE(samples.size(), 1000U);
        EXPECT_GE(samples.size(), 250U);
        EXPECT_TRUE(is_ascending(samples));
        const auto has = [&](double x, double y) {
            return std::any_of(samples.begin(), samples.end(),
                               [&](const Sample& s) { return s.x == x && s.values[0] == y; });
        };
        EXPECT_TRUE(has(333.0, 1e9));
        EXPECT_TRUE(has(77.0, -1e9));
    }
}

TEST(PeakSampler, KeepsTheValuesOfOneTimeTogether)
{
    PeakSampler sampler;
    for (int i = 0; i < 5000; ++i)
        sampler.add({static_cast<double>(i),
                     {static_cast<double>(i), static_cast<double>(5000 - i), i == 2500 ? 9.0 : 0.0}});
    bool has_peak = false;
    for (const Sample& sample : sampler.samples()) {
        EXPECT_EQ(sample.values[0] + sample.values[1], 5000.0);
        has_peak = has_peak || sample.values[2] == 9.0;
    }
    EXPECT_TRUE(has_peak);
}

TEST(PeakSampler, LeavesOutWhatIsNotFinite)
{
    PeakSampler sampler;
    for (const double value : {std::nan(""), std::numeric_limits<double>::infinity(), 3.0})
        sampler.add({0.0, {1.0, value}});
    sampler.add({std::nan(""), {1.0, 1.0}});
    ASSERT_EQ(sampler.samples().size(), 1U);
    EXPECT_EQ(sampler.samples()[0].values[1], 3.0);
}

}  // namespace
}  // namespace arris
