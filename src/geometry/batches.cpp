// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/batches.h"

#include <oneapi/tbb/parallel_for.h>

namespace arris {

void for_each_batch(int count, int size, const std::function<void(int, int, int)>& visit)
{
    const int batches = (count + size - 1) / size;
    const auto visit_batch = [&](int b) { visit(b * size, std::min(count, (b + 1) * size), b); };
    if (batches == 1)
        visit_batch(0);
    else if (batches > 1)
        tbb::parallel_for(0, batches, visit_batch);
}

}  // namespace arris
