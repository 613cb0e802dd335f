// SPDX-License-Identifier: GPL-3.0-or-later
// Counts what this test binary allocates with `new`, as std::vector and std::unique_ptr do.
#pragma once

#include <cstdint>

namespace arris::testing {

struct Allocations {
    std::int64_t count = 0, bytes = 0;
};

/// Since the start of the program, by all threads.
Allocations allocations_so_far();

/// Allocations made by one call.
template <typename Call>
Allocations allocations_of(const Call& call)
{
    const Allocations before = allocations_so_far();
    call();
    const Allocations after = allocations_so_far();
    return {after.count - before.count, after.bytes - before.bytes};
}

}  // namespace arris::testing
