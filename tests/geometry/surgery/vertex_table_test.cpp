// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surgery/vertex_table.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace arris {
namespace {

TEST(VertexTable, FindsWhatAMapFindsWhileIdsComeAndGo)
{
    // Steps between ids range from 1 to values that hash to equal slots. There are many more ids than initial
    // slots.
    for (const std::uint32_t widest : {1u, 5u, 1000u, 1u << 20}) {
        std::mt19937 random(widest);
        VertexTable table(10);
        std::map<VertexId, std::uint32_t> truth;
        VertexId id = 0;
        for (std::uint32_t k = 0; k < 3000; ++k) {
            id += 1 + static_cast<VertexId>(random() % widest);
            table.add(id, k);
            truth[id] = k;
            if (k % 3 == 0) {
                const auto gone = std::next(truth.begin(), random() % truth.size());
                table.remove(gone->first);
                truth.erase(gone);
            }
        }
        ASSERT_EQ(table.count(), static_cast<int>(truth.size()));
        std::vector<std::uint32_t> in_order;
        for (const auto& [known, vertex] : truth) {
            in_order.push_back(vertex);
            ASSERT_EQ(table.find(known), vertex);
            const bool has_next = truth.contains(known + 1);
            ASSERT_EQ(table.find(known + 1), has_next ? truth[known + 1] : VertexTable::kNone);
        }
        EXPECT_EQ(table.in_order(), in_order);
    }
}

TEST(VertexTable, AnEmptyOneHasNothing)
{
    VertexTable table(0);
    EXPECT_EQ(table.find(0), VertexTable::kNone);
    EXPECT_EQ(table.find(0xfffffffeu), VertexTable::kNone);
    EXPECT_EQ(table.count(), 0);
    EXPECT_TRUE(table.in_order().empty());
    table.add(7, 3);
    EXPECT_EQ(table.find(7), 3u);
    table.remove(7);
    EXPECT_EQ(table.find(7), VertexTable::kNone);
    EXPECT_EQ(table.count(), 0);
}

}  // namespace
}  // namespace arris
