// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/update_places.h"

#include <algorithm>

namespace arris {
namespace {

struct Span {
    std::size_t first, end;
};

/// The first place from `begin` for `size` entries that none of `used` has.
std::size_t first_gap(std::size_t begin, std::size_t size, std::vector<Span> used)
{
    std::sort(used.begin(), used.end(), [](const Span& a, const Span& b) { return a.first < b.first; });
    for (const Span& span : used) {
        if (begin + size <= span.first) break;
        begin = std::max(begin, span.end);
    }
    return begin;
}

}  // namespace

/// A supernode takes space of those below it, but not of its children. One thread alone works in a subtree,
/// in order: there, it takes space of all whose parents have been visited.
UpdatePlaces::UpdatePlaces(const EliminationTree& tree, const TreeWalk& walk)
    : first(static_cast<std::size_t>(tree.size()))
{
    const auto span_of = [&](int s) {
        const std::size_t side = static_cast<std::size_t>(tree.below(s));
        return Span{first[s], first[s] + side * side};
    };
    std::vector<std::size_t> begin(first.size());  // of the space of a supernode and all below it
    std::vector<int> needed;                       // in the subtree at hand
    for (int s = 0; s < tree.size(); ++s) {
        const auto child = tree.children.begin() + tree.first_child[s],
                   last_child = tree.children.begin() + tree.first_child[s + 1];
        const int start = walk.subtree_start(s);
        if (start == s) needed.clear();
        if (start < 0) needed.assign(child, last_child);
        if (start == s)
            begin[s] = size;
        else
            begin[s] = start >= 0 ? begin[start] : begin[*child];
        std::vector<Span> used;
        for (const int other : needed) used.push_back(span_of(other));
        const std::size_t side = static_cast<std::size_t>(tree.below(s));
        first[s] = first_gap(begin[s], side * side, std::move(used));
        size = std::max(size, first[s] + side * side);
        std::erase_if(needed, [&](int other) { return tree.parent[other] == s; });
        needed.push_back(s);
    }
}

}  // namespace arris
