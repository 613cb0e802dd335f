// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/surgery/cloth_surgery.h"

namespace arris {

/// Finds a mesh's vertex by its id. Open addressing, as this is the most frequent query of surgery. Ids are
/// added in ascending order and never twice.
class VertexTable {
  public:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    /// Reserves room for `count` ids.
    explicit VertexTable(std::size_t count);

    int count() const { return count_; }
    /// The vertex with an id; kNone if there is none.
    std::uint32_t find(VertexId id) const { return slots_[place(id)].vertex; }
    void add(VertexId id, std::uint32_t vertex);
    void remove(VertexId id);
    /// Vertices in the order of their ids.
    std::vector<std::uint32_t> in_order() const;

  private:
    struct Slot {
        VertexId id = kNoVertex;
        std::uint32_t vertex = kNone;  // kNone also for a removed id
    };

    // The slot of an id, or the free slot where it would be added.
    std::size_t place(VertexId id) const
    {
        std::size_t at = (id * 2654435769u) >> shift_;  // multiplicative hashing spreads neighbouring ids
        while (slots_[at].id != id && slots_[at].id != kNoVertex) at = (at + 1) & (slots_.size() - 1);
        return at;
    }
    void grow(int bits);

    std::vector<VertexId> ids_;  // all ids ever added, ascending
    std::vector<Slot> slots_;
    int shift_ = 0;
    int count_ = 0;
};

}  // namespace arris
