// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <vector>

#include "geometry/vectors.h"
#include "physics/elements/material.h"

namespace arris {

/// The materials of a cloth, one for each of its pieces. In the material plane pieces lie side by side along
/// u, so that a place tells its piece.
class Materials {
  public:
    /// The material of cloth that is one piece.
    Materials(const Material& material = {}) : materials_{material} {}

    /// Adds a piece, which begins at `begin` (m, along u): right of all before.
    void add(double begin, const Material& material);

    int count() const { return static_cast<int>(materials_.size()); }
    int piece_at(const Vec2& X) const
    {
        return static_cast<int>(std::upper_bound(begins_.begin(), begins_.end(), X.x()) - begins_.begin());
    }

    const Material& operator[](int piece) const { return materials_[static_cast<std::size_t>(piece)]; }
    Material& operator[](int piece) { return materials_[static_cast<std::size_t>(piece)]; }
    const Material& at(const Vec2& X) const { return (*this)[piece_at(X)]; }

    auto begin() const { return materials_.begin(); }
    auto end() const { return materials_.end(); }

    /// Greatest thickness, m: what all contacts with obstacles keep.
    double thickness() const;

  private:
    std::vector<Material> materials_;
    std::vector<double> begins_;  ///< m along u, of all pieces but the first; ascending
};

}  // namespace arris
