// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/batches.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <numeric>

namespace arris {
namespace {

double sum_of_sines(int count)
{
    return sum_in_batches<double>(count, [](int first, int last) {
        double sum = 0.0;
        for (int i = first; i < last; ++i) sum += std::sin(i);
        return sum;
    });
}

TEST(Batches, VisitEachElementOnce)
{
    for (const int count : {0, 1, kBatch - 1, kBatch, kBatch + 1, 1000}) {
        std::vector<int> visits(static_cast<std::size_t>(count), 0);
        for_each_in_batches(count, [&](int i) { ++visits[i]; });
        EXPECT_EQ(visits, std::vector<int>(visits.size(), 1)) << count;
    }
}

TEST(Batches, SumTheSameWithAnyNumberOfThreads)
{
    const double all = sum_of_sines(100000);
    for (const std::size_t threads : {1, 2, 4}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        EXPECT_EQ(sum_of_sines(100000), all) << threads;
    }
    EXPECT_EQ(sum_of_sines(0), 0.0);
}

TEST(Batches, CollectInTheElementsOrder)
{
    for (const int count : {0, 1, kBatch, 1000}) {
        const std::vector<int> collected =
            collect_in_batches<int>(count, [](int first, int last, std::vector<int>& found) {
                for (int i = first; i < last; ++i) found.push_back(i);
            });
        std::vector<int> expected(static_cast<std::size_t>(count));
        std::iota(expected.begin(), expected.end(), 0);
        EXPECT_EQ(collected, expected);
    }
}

}  // namespace
}  // namespace arris
