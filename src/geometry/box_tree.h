// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cassert>
#include <vector>

namespace arris {

/// Binary tree of boxes that finds the boxes touching a given one. A query among 100 000 boxes that finds a
/// handful takes a few hundred nanoseconds. Built once; queries are const and may run in parallel.
///
/// Obstacles are searched with CGAL's AABB trees, by exact tests of their primitives. This tree is for what has
/// no primitive and is new in every step: boxes around the ways of the cloth's elements, and of contacts.
class BoxTree {
  public:
    using Box = Eigen::AlignedBox3d;

    BoxTree() = default;
    explicit BoxTree(const std::vector<Box>& boxes);

    /// Indices of the boxes that touch `box` (closed), ascending; `found` is overwritten.
    void find(const Box& box, std::vector<int>& found) const;

    /// Calls `take(index)` for each box that touches `box`, in unspecified order.
    template <typename Take>
    void visit(const Box& box, const Take& take) const;

  private:
    static constexpr int kMostPending = 64;  // one pending node per level; at most 2^31 items, halved at each

    // In depth-first order: the left child follows its parent.
    struct Node {
        Box box;
        int right = 0;  ///< branch: the right child's node; leaf: its first item
        int count = 0;  ///< number of items in a leaf; 0 in a branch
    };
    struct Item {
        Box box;
        int index;
    };

    void build(int first, int last);

    std::vector<Node> nodes_;
    std::vector<Item> items_;
};

template <typename Take>
void BoxTree::visit(const Box& box, const Take& take) const
{
    if (nodes_.empty()) return;
    std::array<int, kMostPending> pending;
    int pending_count = 0;
    int at = 0;
    while (true) {
        const Node& node = nodes_[at];
        const bool is_met = node.box.intersects(box);
        if (is_met && node.count == 0) {
            assert(pending_count < kMostPending);
            pending[pending_count++] = node.right;
            ++at;
            continue;
        }
        if (is_met)
            for (int i = node.right; i < node.right + node.count; ++i)
                if (items_[i].box.intersects(box)) take(items_[i].index);
        if (pending_count == 0) break;
        at = pending[--pending_count];
    }
}

}  // namespace arris
