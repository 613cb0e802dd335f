// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/update_places.h"

#include <algorithm>
#include <limits>

namespace arris {

/// An update takes the space before those of the supernode's children where that is enough, else that behind
/// them. The space before has been that of supernodes below the children, whose parents have been visited.
/// One thread alone works in a subtree, in order: there, it begins behind the last update whose parent has
/// not been visited.
UpdatePlaces::UpdatePlaces(const EliminationTree& tree, const TreeWalk& walk)
    : first(static_cast<std::size_t>(tree.size()))
{
    const auto size_of = [&](int s) {
        const std::size_t side = static_cast<std::size_t>(tree.below(s));
        return side * side;
    };
    std::vector<std::size_t> begin(first.size());  // of the space of a supernode and all below it
    std::vector<int> needed;                       // in the subtree at hand, by place; last the children
    for (int s = 0; s < tree.size(); ++s) {
        const int start = walk.subtree_start(s), first_child = tree.first_child[s],
                  end_child = tree.first_child[s + 1];
        const bool is_in_subtree = start >= 0;
        if (start == s) {
            needed.clear();
            begin[s] = size;
        } else {
            begin[s] = begin[is_in_subtree ? start : tree.children[first_child]];
        }
        std::size_t free = begin[s];
        if (is_in_subtree) {
            needed.resize(needed.size() - static_cast<std::size_t>(end_child - first_child));
            if (!needed.empty()) free = first[needed.back()] + size_of(needed.back());
        }
        std::size_t least = std::numeric_limits<std::size_t>::max(), behind = free;
        for (int k = first_child; k < end_child; ++k) {
            const int child = tree.children[k];
            least = std::min(least, first[child]);
            behind = std::max(behind, first[child] + size_of(child));
        }
        first[s] = free + size_of(s) <= least ? free : behind;
        size = std::max(size, first[s] + size_of(s));
        if (is_in_subtree) needed.push_back(s);
    }
}

}  // namespace arris
