// SPDX-License-Identifier: GPL-3.0-or-later
// Work on many elements by several threads. Elements are divided into batches of a fixed size, and results
// are put together in the order of the batches, so that they do not depend on the number of threads.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

namespace arris {

/// Elements of a batch, where each takes some tenths of a microsecond: a batch is to cost far more than a
/// task.
constexpr int kBatch = 128;
/// The size for elements whose work takes a tenth of a microsecond or less.
constexpr int kCheapBatch = 1024;

/// Calls `visit(first, last, batch)` for each batch [first, last) of `count` elements, in parallel. One batch
/// runs in the calling thread.
void for_each_batch(int count, int size, const std::function<void(int, int, int)>& visit);

/// Calls `visit(element)` for each of `count` elements. Visits must not touch each other's results.
template <class Visit>
void for_each_in_batches(int count, const Visit& visit, int size = kBatch)
{
    for_each_batch(count, size, [&](int first, int last, int) {
        for (int i = first; i < last; ++i) visit(i);
    });
}

/// Sum of `part(first, last)` over the batches, added in their order.
template <class Sum, class Part>
Sum sum_in_batches(int count, const Part& part, int size = kBatch)
{
    std::vector<Sum> parts(static_cast<std::size_t>((count + size - 1) / size));
    for_each_batch(count, size, [&](int first, int last, int batch) { parts[batch] = part(first, last); });
    Sum sum{};
    for (const Sum& one : parts) sum += one;
    return sum;
}

/// Concatenates the results that `find(first, last, results)` appends for the elements of each batch.
template <class Result, class Find>
std::vector<Result> collect_in_batches(int count, const Find& find)
{
    std::vector<std::vector<Result>> parts(static_cast<std::size_t>((count + kBatch - 1) / kBatch));
    for_each_batch(count, kBatch, [&](int first, int last, int batch) { find(first, last, parts[batch]); });
    if (parts.size() == 1) return std::move(parts.front());
    std::vector<Result> all;
    for (std::vector<Result>& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

}  // namespace arris
