// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/surgery/cloth_surgery.h"

namespace arris {

/// Which of a mesh's vertices has an id: open addressing, as surgery asks that more often than anything.
/// Ids are added in ascending order and never twice.
class VertexTable {
  public:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    /// Room for `count` ids before it grows.
    explicit VertexTable(std::size_t count);

    int count() const { return count_; }
    /// kNone where there is none.
    std::uint32_t find(VertexId id) const { return slots_[place(id)].vertex; }
    void add(VertexId id, std::uint32_t vertex);
    void remove(VertexId id);
    /// Vertices in the order of their ids.
    std::vector<std::uint32_t> in_order() const;

  private:
    struct Slot {
        VertexId id = kNoVertex;
        std::uint32_t vertex = kNone;  // also of an id that was removed
    };

    // Where an id is or, if it is nowhere, would be.
    std::size_t place(VertexId id) const
    {
        std::size_t at = (id * 2654435769u) >> shift_;  // multiplicative: neighbouring ids spread
        while (slots_[at].id != id && slots_[at].id != kNoVertex) at = (at + 1) & (slots_.size() - 1);
        return at;
    }
    void grow(int bits);

    std::vector<VertexId> ids_;  // all that were added
    std::vector<Slot> slots_;
    int shift_ = 0;
    int count_ = 0;
};

}  // namespace arris
