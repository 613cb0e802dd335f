// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/box_tree.h"

#include <algorithm>

namespace arris {
namespace {

constexpr int kLeafSize = 4;

}  // namespace

BoxTree::BoxTree(const std::vector<Box>& boxes)
{
    items_.reserve(boxes.size());
    for (int i = 0; i < static_cast<int>(boxes.size()); ++i) items_.push_back({boxes[i], i});
    if (!items_.empty()) build(0, static_cast<int>(items_.size()));
}

void BoxTree::build(int first, int last)
{
    const int self = static_cast<int>(nodes_.size());
    nodes_.emplace_back();
    Box centres;
    for (int i = first; i < last; ++i) {
        nodes_[self].box.extend(items_[i].box);
        centres.extend(items_[i].box.center());
    }
    if (last - first <= kLeafSize) {
        nodes_[self].right = first;
        nodes_[self].count = last - first;
        return;
    }
    // Splits at the median along the longest side. Ties go by index, so the tree depends on the boxes alone.
    int axis = 0;
    centres.sizes().maxCoeff(&axis);
    const int middle = first + (last - first) / 2;
    std::nth_element(items_.begin() + first, items_.begin() + middle, items_.begin() + last,
                     [axis](const Item& a, const Item& b) {
                         const double x = a.box.min()[axis] + a.box.max()[axis];
                         const double y = b.box.min()[axis] + b.box.max()[axis];
                         return x != y ? x < y : a.index < b.index;
                     });
    build(first, middle);
    nodes_[self].right = static_cast<int>(nodes_.size());
    build(middle, last);
}

void BoxTree::find(const Box& box, std::vector<int>& found) const
{
    found.clear();
    visit(box, [&](int index) { found.push_back(index); });
    std::sort(found.begin(), found.end());
}

}  // namespace arris
