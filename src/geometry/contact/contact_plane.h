// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>
#include <span>

#include "geometry/contact/contact_begin.h"
#include "geometry/contact/obstacle_contact.h"

namespace arris {

// Shared by the contacts of vertices, edges and faces.

/// Most planes that hold a vertex: three fix a point.
inline constexpr std::size_t kMostPlanes = 3;

/// Cosine of the angle (20 degrees) within which two planes of a vertex hold the same way: the nearer one is
/// enough. Raising the angle lets a vertex pass one side of a blunt corner until the next round.
inline const double kSameDirection = std::cos(20.0 * M_PI / 180.0);

/// Distance, as a share of the thickness, below which the vector between the closest points gives no reliable
/// direction.
inline constexpr double kTinyDistance = 1e-3;

/// Weight below which a contact on a cloth edge belongs to the edge's vertex, and a contact on a face to the
/// face's edge. Sweeps locate a meeting point to 1e-6 of the element.
inline constexpr double kEndWeight = 1e-4;

/// Distance at which a sweep counts as a touch, m: a millionth of the thickness, or the rounding error of
/// coordinates of this size if that is larger.
double touch_distance(const Obstacle& obstacle, double thickness);

/// Search distance around the reference position of an element, m: three thicknesses, plus a quarter of the
/// element's way in the step. The quarter allows for what stiffness and neighbours add to the prediction.
/// Contacts beyond are found by the check after the solve.
inline constexpr double kReachThicknesses = 3.0;
inline constexpr double kReachShareOfWay = 0.25;
double longest_reach(const ClothMotion& motion, std::span<const int> vertices, double thickness);

/// Sorts the vertices ascending.
ObstacleContact make_contact(ContactKind kind, const ClothPoint& cloth_point, int element, const Vec3& normal,
                             const Vec3& point, double least_gap);

/// As above, for contacts found before the solve. `least_gap` follows from where the cloth's point began and
/// from where its free motion ends.
ObstacleContact make_contact(const Obstacle& obstacle, const ClothMotion& motion, const ContactBegin& begin,
                             ContactKind kind, const ClothPoint& cloth_point, int element, const Vec3& normal,
                             const Vec3& point, double thickness);

}  // namespace arris
