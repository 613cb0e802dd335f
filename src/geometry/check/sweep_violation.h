// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "geometry/contact/contact_plane.h"
#include "geometry/contact/continuous_collision.h"

namespace arris {

// Each function makes a contact from a hit of the sweep from `motion.begin` to `motion.end`. The contact's
// plane has the cloth's point on its free side at begin, and is violated at the end. Returns nothing only
// where that point touched at begin or does not move. `begin`: that point at begin, as seen from the obstacle
// at the end. The stand-off is the thickness, or the point's gap at begin where that was less.

/// A vertex and a face.
std::optional<ObstacleContact> make_vertex_violation(const Obstacle& obstacle, const ClothMotion& motion,
                                                     int vertex, int face, const SweepHit& hit,
                                                     const Vec3& begin, double thickness);

/// A cloth edge (index) and an edge of the topology.
std::optional<ObstacleContact> make_edge_violation(const Obstacle& obstacle, const ClothMotion& motion,
                                                   int cloth_edge, int edge, const SweepHit& hit,
                                                   const Vec3& begin, double thickness);

/// A cloth face and a point of the mesh.
std::optional<ObstacleContact> make_face_violation(const Obstacle& obstacle, const ClothMotion& motion,
                                                   int cloth_face, int point, const SweepHit& hit,
                                                   const Vec3& begin, double thickness);

}  // namespace arris
