// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/check/face_groups.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "geometry/batches.h"

namespace arris {
namespace {

using Iterator = std::vector<int>::iterator;

void halve(const std::vector<Vec3>& centers, int group_size, Iterator begin, Iterator end)
{
    const int count = static_cast<int>(end - begin);
    if (count <= group_size) return;
    Box3 box;
    for (Iterator i = begin; i != end; ++i) box.extend(centers[*i]);
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    // The first half gets whole groups, so that no group straddles the halves.
    const int groups = (count + group_size - 1) / group_size;
    const Iterator middle = begin + groups / 2 * group_size;
    std::nth_element(begin, middle, end, [&](int a, int b) {
        return std::pair(centers[a][axis], a) < std::pair(centers[b][axis], b);
    });
    constexpr int kWorthATask = 2000;  // elements, a tenth of a millisecond
    const auto halve_half = [&](int half) {
        half == 0 ? halve(centers, group_size, begin, middle) : halve(centers, group_size, middle, end);
    };
    for_each_in_batches(2, halve_half, count < kWorthATask ? 2 : 1);
}

}  // namespace

std::vector<int> order_by_place(const std::vector<Box3>& boxes, std::vector<int> elements, int group_size)
{
    assert(group_size > 0);
    std::vector<Vec3> centers(boxes.size());
    for (const int e : elements) centers[e] = boxes[e].center();
    halve(centers, group_size, elements.begin(), elements.end());
    return elements;
}

}  // namespace arris
