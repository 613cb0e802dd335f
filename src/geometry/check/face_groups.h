// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "geometry/batches.h"
#include "geometry/obstacle/obstacle.h"

namespace arris {

/// Orders `elements` so that the boxes of each run of `group_size` (the last one may be shorter) lie close
/// together, and one query serves a run. Repeatedly halves the set at the median along its longest side. A
/// function of boxes and elements alone. O(n log n).
std::vector<int> order_by_place(const std::vector<Box3>& boxes, std::vector<int> elements, int group_size);

/// Collects what `search(faces, box, results)` appends for groups of neighbouring `faces` with these boxes,
/// where `box` is the group's. In parallel; the order does not depend on the number of threads. `search` is
/// copied for each batch.
template <class Result, class Search>
std::vector<Result> collect_in_groups(const std::vector<Box3>& boxes, std::vector<int> faces,
                                      const Search& search)
{
    // Smaller groups cost more queries, larger ones have larger boxes.
    constexpr int kGroupSize = 16;
    const std::vector<int> order = order_by_place(boxes, std::move(faces), kGroupSize);
    const auto search_batch = [&](int begin, int end, std::vector<Result>& results) {
        Search mine = search;
        for (int first = begin; first < end; first += kGroupSize) {
            const std::span<const int> group(&order[first], std::min(kGroupSize, end - first));
            Box3 box;
            for (const int f : group) box.extend(boxes[f]);
            mine(group, box, results);
        }
    };
    return collect_in_batches<Result>(static_cast<int>(order.size()), search_batch);
}

}  // namespace arris
