// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace arris {

/// Boxes in a binary tree, to find those that touch another: a few hundred nanoseconds among 100 000 for a
/// box that touches a handful. Built once; queries are const and may run in parallel.
class BoxTree {
  public:
    using Box = Eigen::AlignedBox3d;

    BoxTree() = default;
    explicit BoxTree(const std::vector<Box>& boxes);

    /// Indices of the boxes that touch `box` (closed), ascending; `found` is overwritten.
    void find(const Box& box, std::vector<int>& found) const;

  private:
    // In depth-first order: the left child follows its parent.
    struct Node {
        Box box;
        int right = 0;  ///< the other child's node; a leaf: its first item
        int count = 0;  ///< of a leaf's items; 0 in a branch
    };
    struct Item {
        Box box;
        int index;
    };

    void build(int first, int last);

    std::vector<Node> nodes_;
    std::vector<Item> items_;
};

}  // namespace arris
