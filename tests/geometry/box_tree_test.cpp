// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/box_tree.h"

#include <gtest/gtest.h>

#include <random>

#include "geometry/vectors.h"

namespace arris {
namespace {

using Box = BoxTree::Box;

std::vector<int> touching(const std::vector<Box>& boxes, const Box& query)
{
    std::vector<int> found;
    for (int i = 0; i < static_cast<int>(boxes.size()); ++i)
        if ((boxes[i].min().array() <= query.max().array()).all() &&
            (query.min().array() <= boxes[i].max().array()).all())
            found.push_back(i);
    return found;
}

TEST(BoxTree, FindsWhatBruteForceFinds)
{
    std::mt19937 engine(1);
    // Boxes touch exactly, contain each other, or have no size.
    std::uniform_int_distribution<int> cell(0, 12);
    const auto any_box = [&] {
        const Vec3 a(cell(engine), cell(engine), cell(engine)), b(cell(engine), cell(engine), cell(engine));
        return Box(a.cwiseMin(b), cell(engine) < 6 ? Vec3(a.cwiseMin(b)) : Vec3(a.cwiseMax(b)));
    };
    for (const int count : {0, 1, 2, 5, 64, 1000}) {
        std::vector<Box> boxes;
        for (int i = 0; i < count; ++i) boxes.push_back(any_box());
        if (count > 100) boxes.resize(2 * count, boxes[0]);  // many equal boxes
        const BoxTree tree(boxes);
        std::vector<int> found = {-1};
        for (int k = 0; k < 200; ++k) {
            const Box query = any_box();
            tree.find(query, found);
            EXPECT_EQ(found, touching(boxes, query));
        }
    }
}

TEST(BoxTree, AnEmptyOneFindsNothing)
{
    std::vector<int> found = {3};
    BoxTree().find(Box(Vec3::Zero(), Vec3::Ones()), found);
    EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace arris
