// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// The convex hull of a cloth face's corners at begin and end. Whatever the moving face meets touches this
/// hull.
class SweptFace {
  public:
    /// `begin`, `end`: positions of the cloth's vertices.
    SweptFace(const std::vector<Vec3>& begin, const std::vector<Vec3>& end, const Face& face);

    const std::array<Vec3, 3>& begin() const { return begin_; }
    const std::array<Vec3, 3>& end() const { return end_; }
    bool is_moving() const { return begin_ != end_; }

    /// Whether a plane across `normal` (unit) or across one of the cloth's own normals strictly separates the
    /// hull and the hull of up to six points. If so, no elements of the two meet. True is certain in spite
    /// of rounding; false proves nothing.
    bool is_apart(std::span<const Vec3> points, const Vec3* normal = nullptr) const;

  private:
    struct Slab {
        Vec3 normal;
        double low, high;
    };
    Slab make_slab(const Vec3& normal) const;

    std::array<Vec3, 3> begin_, end_;
    std::array<Vec3, 6> offsets_;  ///< of the corners, relative to the first corner at begin
    double size_;                  ///< largest offset
    std::array<Slab, 2> own_;      ///< slabs across the cloth's normals at begin and end
};

}  // namespace arris
