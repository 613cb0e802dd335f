// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>

#include "geometry/contact/obstacle_contact.h"

namespace arris {

/// A cloth face on its way: the hull of its corners at begin and end, which what it meets must touch.
class SweptFace {
  public:
    SweptFace(const ClothMotion& motion, int face);

    const std::array<Vec3, 3>& begin() const { return begin_; }
    const std::array<Vec3, 3>& end() const { return end_; }
    bool is_moving() const { return begin_ != end_; }

    /// Whether a plane keeps the hull and that of up to three points strictly apart, across `normal` (unit)
    /// or the cloth's own normals: then nothing of the one meets anything of the other. Certain in spite of
    /// rounding; false proves nothing.
    bool is_apart(std::span<const Vec3> points, const Vec3* normal = nullptr) const;

  private:
    struct Slab {
        Vec3 normal;
        double low, high;
    };
    Slab make_slab(const Vec3& normal) const;

    std::array<Vec3, 3> begin_, end_;
    std::array<Vec3, 6> offsets_;  ///< of the corners from the first at begin
    double size_;                  ///< greatest of the offsets
    std::array<Slab, 2> own_;      ///< across the cloth's normals at begin and end
};

}  // namespace arris
