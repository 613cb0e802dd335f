// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>

#include "geometry/contact/obstacle_contact.h"

namespace arris {

// What the classes of contact share.

/// Distances below this share of the thickness have no direction to speak of.
inline constexpr double kTinyDistance = 1e-3;

/// Weight below which a contact is at the end of a cloth's edge (then it is the vertex's), or on the side of
/// a face (then it is the edge's): sweeps know the place to 1e-6 of the way.
inline constexpr double kEndWeight = 1e-4;

/// Distance at which a sweep counts as touching, m: a millionth of the thickness, or what rounding leaves of
/// coordinates of this size.
double touch_distance(const Obstacle& obstacle, double thickness);

/// How far from its reference position an element is looked for, m: three times the thickness, and up to a
/// quarter of the step's way where nothing is nearer: what stiffness and neighbours may add to the
/// prediction. What is missed is found by the check after the solve.
inline constexpr double kReachThicknesses = 3.0;
inline constexpr double kReachShareOfWay = 0.25;
double longest_reach(const ClothMotion& motion, std::span<const int> vertices, double thickness);

/// Fills in vertices in ascending order.
ObstacleContact make_contact(ContactKind kind, const ClothPoint& cloth_point, int element, const Vec3& normal,
                             const Vec3& point, double least_gap);

/// The same of what is found before the solve, with `least_gap` by where the cloth's point began and by where
/// its free way ends.
ObstacleContact make_contact(const Obstacle& obstacle, const ClothMotion& motion, ContactKind kind,
                             const ClothPoint& cloth_point, int element, const Vec3& normal,
                             const Vec3& point, double thickness);

}  // namespace arris
