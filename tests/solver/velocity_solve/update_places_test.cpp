// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/update_places.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <mutex>
#include <random>

namespace arris {
namespace {

/// Supernodes of one column block each, with random parents after them; several roots.
EliminationTree random_tree(int size, int columns, int most_below, unsigned seed)
{
    std::mt19937 random(seed);
    EliminationTree tree;
    tree.first_child.assign(static_cast<std::size_t>(size) + 1, 0);
    std::vector<std::vector<int>> children(static_cast<std::size_t>(size));
    // A postorder: a supernode takes some of the last subtrees that have no parent.
    std::vector<int> open;
    tree.parent.assign(static_cast<std::size_t>(size), -1);
    for (int s = 0; s < size; ++s) {
        const std::size_t taken = open.empty() ? 0 : random() % std::min<std::size_t>(open.size() + 1, 4);
        for (std::size_t k = 0; k < taken; ++k) {
            children[s].insert(children[s].begin(), open.back());
            tree.parent[open.back()] = s;
            open.pop_back();
        }
        open.push_back(s);
    }
    for (int s = 0; s < size; ++s) {
        tree.first_column.push_back(s * columns);
        tree.first_row.push_back(static_cast<int>(tree.rows.size()));
        const int below = tree.parent[s] < 0 ? 0 : 1 + static_cast<int>(random() % most_below);
        tree.rows.resize(tree.rows.size() + static_cast<std::size_t>(columns + below));
        tree.children.insert(tree.children.end(), children[s].begin(), children[s].end());
        tree.first_child[s + 1] = static_cast<int>(tree.children.size());
    }
    tree.first_column.push_back(size * columns);
    tree.first_row.push_back(static_cast<int>(tree.rows.size()));
    return tree;
}

class EveryTree : public ::testing::TestWithParam<unsigned> {
  protected:
    /// Large supernodes, so that many are tasks of their own.
    EliminationTree tree = random_tree(300, 60, 150, GetParam());
    TreeWalk walk{tree};
};

/// Each visit writes its own update, and reads those of its children unspoilt, in any order threads choose.
TEST_P(EveryTree, KeepsUpdatesUntilTheirParentsAreVisited)
{
    const UpdatePlaces places(tree, walk);
    for (const std::size_t threads : {1, 2, 8}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        std::vector<int> workspace(places.size, -1);
        std::atomic<int> spoilt = 0, visits = 0;
        walk.up(1e9, [&](int s) {
            ++visits;
            const auto square = [&](int node) {
                return static_cast<std::size_t>(tree.below(node) * tree.below(node));
            };
            std::fill_n(workspace.begin() + static_cast<std::ptrdiff_t>(places.first[s]), square(s), s);
            for (int k = tree.first_child[s]; k < tree.first_child[s + 1]; ++k) {
                const int child = tree.children[k];
                for (std::size_t e = 0; e < square(child); ++e)
                    if (workspace[places.first[child] + e] != child) ++spoilt;
            }
        });
        EXPECT_EQ(visits, tree.size());
        EXPECT_EQ(spoilt, 0);
    }
}

TEST_P(EveryTree, IsVisitedUpAndDownOnceEach)
{
    for (const double flops : {0.0, 1e9}) {
        std::mutex mutex;
        std::vector<int> order;
        const auto note = [&](int s) {
            const std::scoped_lock lock(mutex);
            order.push_back(s);
        };
        const auto places_of = [&] {
            std::vector<int> place(order.size(), -1);
            for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = static_cast<int>(k);
            return place;
        };
        walk.up(flops, note);
        ASSERT_EQ(static_cast<int>(order.size()), tree.size());
        std::vector<int> place = places_of();
        for (int s = 0; s < tree.size(); ++s)
            if (tree.parent[s] >= 0) {
                EXPECT_LT(place[s], place[tree.parent[s]]);
            }
        order.clear();
        walk.down(flops, note);
        ASSERT_EQ(static_cast<int>(order.size()), tree.size());
        place = places_of();
        for (int s = 0; s < tree.size(); ++s)
            if (tree.parent[s] >= 0) {
                EXPECT_GT(place[s], place[tree.parent[s]]);
            }
    }
}

TEST_P(EveryTree, TakesLessSpaceThanAllUpdates)
{
    const UpdatePlaces places(tree, walk);
    std::size_t all = 0;
    for (int s = 0; s < tree.size(); ++s) all += static_cast<std::size_t>(tree.below(s) * tree.below(s));
    EXPECT_LE(places.size, all);
    EXPECT_GT(walk.critical_flops(), 0.0);
    EXPECT_LE(walk.critical_flops(), tree.flops());
}

/// A supernode with very many children: the cost must not be quadratic, or this takes minutes.
TEST(UpdatePlaces, OfAStarAreFoundInNoTime)
{
    const int leaves = 200000;
    EliminationTree tree;
    for (int s = 0; s <= leaves; ++s) {
        tree.first_column.push_back(3 * s);
        tree.first_row.push_back(static_cast<int>(tree.rows.size()));
        tree.rows.resize(tree.rows.size() + (s < leaves ? 6 : 3));
        tree.parent.push_back(s < leaves ? leaves : -1);
        tree.first_child.push_back(0);
        if (s < leaves) tree.children.push_back(s);
    }
    tree.first_column.push_back(3 * leaves + 3);
    tree.first_row.push_back(static_cast<int>(tree.rows.size()));
    tree.first_child.push_back(leaves);
    const TreeWalk walk(tree);
    EXPECT_GE(UpdatePlaces(tree, walk).size, 9U * leaves);
}

INSTANTIATE_TEST_SUITE_P(UpdatePlaces, EveryTree, ::testing::Range(0u, 12u));

}  // namespace
}  // namespace arris
