// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/surgery/vertex_table.h"

#include <bit>
#include <cassert>
#include <utility>

namespace arris {

VertexTable::VertexTable(std::size_t count)
{
    ids_.reserve(count);
    grow(static_cast<int>(std::bit_width(2 * count + 1)));
}

void VertexTable::grow(int bits)
{
    const std::vector<Slot> old = std::exchange(slots_, std::vector<Slot>(std::size_t{1} << bits));
    shift_ = 32 - bits;
    for (const Slot& s : old)
        if (s.id != kNoVertex) slots_[place(s.id)] = s;
}

void VertexTable::add(VertexId id, std::uint32_t vertex)
{
    assert((ids_.empty() || ids_.back() < id) && "ids ascend");
    if (2 * (ids_.size() + 1) > slots_.size()) grow(static_cast<int>(std::bit_width(slots_.size())));
    ids_.push_back(id);
    slots_[place(id)] = {id, vertex};
    ++count_;
}

void VertexTable::remove(VertexId id)
{
    assert(find(id) != kNone && "a vertex of this table");
    slots_[place(id)].vertex = kNone;
    --count_;
}

std::vector<std::uint32_t> VertexTable::in_order() const
{
    std::vector<std::uint32_t> vertices;
    vertices.reserve(static_cast<std::size_t>(count_));
    for (const VertexId id : ids_)
        if (const std::uint32_t vertex = find(id); vertex != kNone) vertices.push_back(vertex);
    return vertices;
}

}  // namespace arris
