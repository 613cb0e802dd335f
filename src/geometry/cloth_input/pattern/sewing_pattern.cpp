// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/pattern/sewing_pattern.h"

#include <algorithm>
#include <numeric>

namespace arris {
namespace {

// Panels in groups that are sewn together; each panel is turned over or not relative to its group's root.
class TurnedGroups {
  public:
    explicit TurnedGroups(std::size_t count) : parent_(count), is_turned_(count, 0)
    {
        std::iota(parent_.begin(), parent_.end(), 0);
    }

    struct Place {
        int root;
        bool is_turned;
    };

    Place find(int panel)
    {
        int root = panel;
        bool is_turned = false;
        for (; parent_[root] != root; root = parent_[root]) is_turned ^= is_turned_[root] != 0;
        // All panels on the way now name the root.
        for (bool left = is_turned; parent_[panel] != root && panel != root;) {
            const int next = parent_[panel];
            const bool own = is_turned_[panel] != 0;
            parent_[panel] = root;
            is_turned_[panel] = left;
            left ^= own;
            panel = next;
        }
        return {root, is_turned};
    }

    /// False where the panels are already joined the other way. The least panel is the root.
    bool join(int a, int b, bool are_unlike)
    {
        Place first = find(a), second = find(b);
        if (first.root == second.root) return (first.is_turned != second.is_turned) == are_unlike;
        if (second.root < first.root) std::swap(first, second);
        parent_[second.root] = first.root;
        is_turned_[second.root] = (first.is_turned != second.is_turned) != are_unlike;
        return true;
    }

  private:
    std::vector<int> parent_;
    std::vector<char> is_turned_;  // relative to the parent
};

bool runs_along_loop(const SewingPattern& pattern, const SeamSide& side)
{
    return side.is_backward == pattern.panels[side.panel].is_turned_over;
}

}  // namespace

std::vector<int> edges_of(const SeamSide& side, std::size_t edge_count)
{
    std::vector<int> edges;
    for (int k = 0; k < side.count; ++k)
        edges.push_back(static_cast<int>(static_cast<std::size_t>(side.edge + k) % edge_count));
    return edges;
}

int find_panel(const SewingPattern& pattern, std::string_view name)
{
    const auto found = std::find_if(pattern.panels.begin(), pattern.panels.end(),
                                    [&](const Panel& panel) { return panel.name == name; });
    return found == pattern.panels.end() ? -1 : static_cast<int>(found - pattern.panels.begin());
}

bool joins_right_to_wrong(const SewingPattern& pattern, const Seam& seam)
{
    return runs_along_loop(pattern, seam.sides[0]) == runs_along_loop(pattern, seam.sides[1]);
}

void agree_on_sides(SewingPattern& pattern)
{
    TurnedGroups groups(pattern.panels.size());
    for (Seam& seam : pattern.seams)
        seam.is_tie = seam.is_tie || !groups.join(seam.sides[0].panel, seam.sides[1].panel,
                                                  joins_right_to_wrong(pattern, seam));
    for (std::size_t p = 0; p < pattern.panels.size(); ++p)
        pattern.panels[p].is_turned_over ^= groups.find(static_cast<int>(p)).is_turned;
}

}  // namespace arris
