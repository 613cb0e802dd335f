// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/obstacle/obstacle_mesh.h"

namespace arris {

/// A row of ridges along x, each a prism that runs along y: the solid over the base slab.
///
///     z = height    /\        /\        /\      each ridge is 2 height tan(tip_degrees / 2) wide at z = 0
///                  /  \      /  \      /  \     valleys are flat at z = 0
///     z = 0    ___/    \____/    \____/    \___
///     z = -height |_____________________________|
///
struct TeethShape {
    int count;           ///< ridges, 1 to 10000
    double pitch;        ///< m, from tip to tip; at least a ridge's width at its base
    double height;       ///< m, of the tips above the valleys
    double width;        ///< m, along y
    double tip_degrees;  ///< between the two flanks at a tip, inside (0, 180)
};

/// A solid box of these sizes (m) along x, y and z, centred on its origin: 8 points, 12 faces. Throws
/// InputError, which names the size, unless each size is finite, positive and at most 1e6 m.
ObstacleMesh make_box(const Vec3& sizes);

/// Lone points (nails), in the given order. Throws InputError for an empty list, and for a point that is not
/// finite, beyond 1e6 m or a duplicate. The error names the point by its number, counted from 1.
ObstacleMesh make_points(const std::vector<Vec3>& points);

/// Segments from each point to the next; `is_closed` adds one from the last to the first. Throws InputError
/// for fewer than 2 points (3 where closed), for a point that is not finite or beyond 1e6 m, and for equal
/// consecutive points. A wire may touch itself elsewhere.
ObstacleMesh make_wire(const std::vector<Vec3>& points, bool is_closed);

/// The solid of `shape`. It spans x from -count pitch / 2 to count pitch / 2, with tips at the middles of the
/// `count` pitches. It spans y from -width / 2 to width / 2 and z from -height to height. The solid is closed
/// and manifold: at a valley of zero width, two flanks share their points. Throws InputError naming the value
/// and its range.
ObstacleMesh make_teeth(const TeethShape& shape);

}  // namespace arris
