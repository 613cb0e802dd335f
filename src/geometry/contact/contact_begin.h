// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>

#include "geometry/contact/obstacle_contact.h"
#include "geometry/obstacle/surface_ride.h"

namespace arris {

/// Where the cloth's vertices began, seen from an element of the obstacle at the step's end. Each vertex of
/// `motion.begin` has ridden with the place nearest to it. Where the obstacle deforms, two such vertices and
/// an element between them may then change sides. So vertices of one contact ride with the contact's own
/// element.
class ContactBegin {
  public:
    /// Each vertex with the place nearest to it.
    explicit ContactBegin(const ClothMotion& motion) : motion_(motion) {}

    /// All with `on`, a place of `obstacle`, which is the obstacle at the step's end.
    ContactBegin(const Obstacle& obstacle, const ClothMotion& motion, const SurfacePlace& on)
        : motion_(motion)
    {
        if (motion.sides) way_ = find_way(*motion.sides->obstacle, obstacle, on);
    }

    Vec3 operator[](int vertex) const
    {
        return way_ ? (*way_)(motion_.sides->cloth[vertex]) : motion_.begin[vertex];
    }

  private:
    const ClothMotion& motion_;
    std::optional<Placement> way_;
};

/// With an edge of the topology, where it was nearest to a cloth edge.
ContactBegin begin_from_edge(const Obstacle& obstacle, const ClothMotion& motion,
                             const std::array<int, 2>& cloth_edge, int edge);

/// With a point of the mesh.
ContactBegin begin_from_point(const Obstacle& obstacle, const ClothMotion& motion, int point);

}  // namespace arris
