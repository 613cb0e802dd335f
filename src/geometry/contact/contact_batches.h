// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <vector>

namespace arris {

/// Concatenates the results that `find(first, last, results)` appends for the elements [first, last) of each
/// batch, in the order of the elements. Batches run in parallel. Their size is fixed, so the result does not
/// depend on the number of threads.
template <class Result, class Find>
std::vector<Result> collect_in_batches(int count, const Find& find)
{
    constexpr int kBatch = 128;
    const int batch_count = (count + kBatch - 1) / kBatch;
    std::vector<std::vector<Result>> slots(batch_count);
    tbb::parallel_for(0, batch_count,
                      [&](int b) { find(b * kBatch, std::min(count, (b + 1) * kBatch), slots[b]); });
    std::vector<Result> all;
    for (std::vector<Result>& slot : slots) all.insert(all.end(), slot.begin(), slot.end());
    return all;
}

}  // namespace arris
