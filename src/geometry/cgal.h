// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include "geometry/vectors.h"

// CGAL's names in one place. Include only from .cpp files of the geometry layer: CGAL is slow to compile, and
// no other layer uses it.
namespace arris {

/// Exact predicates, constructions in double.
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point2 = Kernel::Point_2;
using Point3 = Kernel::Point_3;

inline Point2 to_cgal(const Vec2& p)
{
    return {p.x(), p.y()};
}
inline Point3 to_cgal(const Vec3& p)
{
    return {p.x(), p.y(), p.z()};
}
inline Vec2 to_eigen(const Point2& p)
{
    return {p.x(), p.y()};
}
inline Vec3 to_eigen(const Point3& p)
{
    return {p.x(), p.y(), p.z()};
}

/// 1 where a, b, c turn counter-clockwise, -1 clockwise, 0 on one line; exact.
inline int exact_orientation(const Vec2& a, const Vec2& b, const Vec2& c)
{
    return static_cast<int>(CGAL::orientation(to_cgal(a), to_cgal(b), to_cgal(c)));
}

}  // namespace arris
