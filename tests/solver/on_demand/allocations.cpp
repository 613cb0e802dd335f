// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/solver/on_demand/allocations.h"

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::int64_t> count{0}, bytes{0};

void note(std::size_t size)
{
    ++count;
    bytes += static_cast<std::int64_t>(size);
}

}  // namespace

arris::testing::Allocations arris::testing::allocations_so_far()
{
    return {count, bytes};
}

// The array forms of the standard library call these. All forms are here: under the address sanitizer, memory
// that its own `new` gave must not be freed here.
void* operator new(std::size_t size)
{
    note(size);
    if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
    throw std::bad_alloc();
}

void* operator new(std::size_t size, std::align_val_t alignment)
{
    note(size);
    const auto step = static_cast<std::size_t>(alignment);
    if (void* memory = std::aligned_alloc(step, (size / step + 1) * step)) return memory;
    throw std::bad_alloc();
}

void* operator new(std::size_t size, const std::nothrow_t&) noexcept
{
    note(size);
    return std::malloc(size > 0 ? size : 1);
}

void operator delete(void* memory) noexcept
{
    std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept
{
    std::free(memory);
}

void operator delete(void* memory, std::align_val_t) noexcept
{
    std::free(memory);
}

void operator delete(void* memory, std::size_t, std::align_val_t) noexcept
{
    std::free(memory);
}
