// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/check/face_groups.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace arris {
namespace {

/// Unit squares of a chessboard in random order.
std::vector<Box3> shuffled_board(int side)
{
    std::vector<Box3> boxes;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j) boxes.emplace_back(Vec3(i, j, 0), Vec3(i + 1, j + 1, 0));
    std::mt19937_64 random(1);
    std::shuffle(boxes.begin(), boxes.end(), random);
    return boxes;
}

std::vector<int> order_all(const std::vector<Box3>& boxes, int group_size)
{
    std::vector<int> all(boxes.size());
    std::iota(all.begin(), all.end(), 0);
    return order_by_place(boxes, std::move(all), group_size);
}

TEST(FaceGroups, HoldEveryBoxOnce)
{
    for (const int side : {0, 1, 3, 10, 17}) {
        const std::vector<Box3> boxes = shuffled_board(side);
        std::vector<int> order = order_all(boxes, 16);
        std::sort(order.begin(), order.end());
        std::vector<int> all(boxes.size());
        std::iota(all.begin(), all.end(), 0);
        EXPECT_EQ(order, all);
    }
}

TEST(FaceGroups, LieClose)
{
    constexpr int kGroup = 16;
    const std::vector<Box3> boxes = shuffled_board(32);
    const std::vector<int> order = order_all(boxes, kGroup);
    for (std::size_t first = 0; first < order.size(); first += kGroup) {
        Box3 group;
        for (int k = 0; k < kGroup; ++k) group.extend(boxes[order[first + k]]);
        EXPECT_EQ(group.sizes().x() * group.sizes().y(), 16.0);  // 4 x 4 squares without gaps
    }
}

TEST(FaceGroups, CoincidentBoxesAreNoTrouble)
{
    const std::vector<Box3> boxes(1000, Box3(Vec3(1, 2, 3), Vec3(1, 2, 3)));
    EXPECT_EQ(order_all(boxes, 16), order_all(boxes, 16));
    EXPECT_EQ(order_all(boxes, 16).size(), 1000U);
}

TEST(FaceGroups, HoldOnlyTheElementsAskedFor)
{
    const std::vector<Box3> boxes = shuffled_board(10);
    std::vector<int> order = order_by_place(boxes, {3, 5, 98}, 2);
    std::sort(order.begin(), order.end());
    EXPECT_EQ(order, (std::vector<int>{3, 5, 98}));
    EXPECT_TRUE(order_by_place(boxes, {}, 16).empty());
}

/// Enough for halves that several threads order.
TEST(FaceGroups, AreTheSameWithAnyNumberOfThreads)
{
    const std::vector<Box3> boxes = shuffled_board(120);
    const std::vector<int> expected = order_all(boxes, 16);
    for (const std::size_t threads : {1, 2, 4}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        EXPECT_EQ(order_all(boxes, 16), expected) << threads;
    }
}

}  // namespace
}  // namespace arris
