// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/tree_walk.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_group.h>

#include <algorithm>
#include <numeric>

#include "solver/velocity_solve/front.h"

namespace arris {
namespace {

/// A subtree has at most this share of all flops, so that sixteen threads find work, and at least this many
/// flops, a fifteenth of a millisecond, as a task costs some microseconds.
constexpr double kLargestShare = 1.0 / 64.0, kLeastFlops = 1e6;

/// Flops from which threads are woken, half a millisecond.
constexpr double kWorthThreads = 1e7;

/// One thread alone goes in order: then updates are still in the cache when they are needed.
bool is_for_one_thread(double flops)
{
    using Control = tbb::global_control;
    return flops < kWorthThreads || Control::active_value(Control::max_allowed_parallelism) == 1;
}

}  // namespace

TreeWalk::TreeWalk(const EliminationTree& tree)
    : tree_(tree),
      start_(static_cast<std::size_t>(tree.size())),
      waits_for_(std::make_unique<std::atomic<int>[]>(start_.size()))
{
    std::vector<double> flops(start_.size());  // of each supernode's subtree
    std::iota(start_.begin(), start_.end(), 0);
    double all = 0.0;
    for (int s = 0; s < tree.size(); ++s) {
        flops[s] += tree.flops(s);
        all += tree.flops(s);
        if (const int parent = tree.parent[s]; parent >= 0) {
            flops[parent] += flops[s];
            start_[parent] = std::min(start_[parent], start_[s]);
        }
    }
    const double most = std::max(kLeastFlops, kLargestShare * all);
    for (int s = tree.size() - 1; s >= 0; --s) {
        const int parent = tree.parent[s];
        if (parent >= 0 && start_[parent] >= 0)
            start_[s] = start_[parent];
        else if (flops[s] > most && start_[s] < s)
            start_[s] = -1;
        else
            subtrees_.push_back(s);
    }
}

void TreeWalk::up(double flops, const Visit& visit) const
{
    if (is_for_one_thread(flops)) {
        for (int s = 0; s < tree_.size(); ++s) visit(s);
        return;
    }
    for (int s = 0; s < tree_.size(); ++s)
        waits_for_[s].store(tree_.first_child[s + 1] - tree_.first_child[s], std::memory_order_relaxed);
    // Whoever visits the last child of a supernode goes on with it.
    const auto climb = [&](int s) {
        for (; s >= 0 && --waits_for_[s] == 0; s = tree_.parent[s]) visit(s);
    };
    // A thread takes its own last task first, another one's first task first: so each goes through its part
    // of the tree in order, from either end.
    tbb::task_group tasks;
    for (const int root : subtrees_)
        tasks.run([&, root] {
            for (int s = start_[root]; s <= root; ++s) visit(s);
            climb(tree_.parent[root]);
        });
    tasks.wait();
}

void TreeWalk::down(double flops, const Visit& visit) const
{
    if (is_for_one_thread(flops)) {
        for (int s = tree_.size() - 1; s >= 0; --s) visit(s);
        return;
    }
    tbb::task_group tasks;
    const std::function<void(int)> descend = [&](int s) {
        if (start_[s] >= 0) {
            for (int node = s; node >= start_[s]; --node) visit(node);
            return;
        }
        visit(s);
        for (int k = tree_.first_child[s]; k < tree_.first_child[s + 1]; ++k)
            tasks.run([&, child = tree_.children[k]] { descend(child); });
    };
    for (int s = 0; s < tree_.size(); ++s)
        if (tree_.parent[s] < 0) tasks.run([&, s] { descend(s); });
    tasks.wait();
}

double TreeWalk::critical_flops() const
{
    std::vector<double> longest(start_.size());  // down from each supernode
    double most = 0.0;
    for (int s = 0; s < tree_.size(); ++s) {
        double& own = longest[s];
        for (int k = tree_.first_child[s]; k < tree_.first_child[s + 1]; ++k) {
            const double child = longest[tree_.children[k]];
            own = start_[s] >= 0 ? own + child : std::max(own, child);
        }
        const double tiled = critical_flops_of(tree_.columns(s), tree_.row_count(s));
        own += start_[s] >= 0 ? tree_.flops(s) : std::min(tiled, tree_.flops(s));
        most = std::max(most, own);
    }
    return most;
}

}  // namespace arris
