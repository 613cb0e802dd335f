// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "geometry/obstacle/obstacle_mesh.h"

// Shapes of which features, insides and distances are known.
namespace arris::samples {

/// A closed prism over a counter-clockwise polygon in the xy plane, with rings of points at the ascending
/// `levels`. `cap` are the polygon's triangles; where empty, a fan from its first point.
ObstacleMesh prism(const std::vector<Vec2>& polygon, const std::vector<double>& levels,
                   const std::vector<Face>& cap = {});

ObstacleMesh box(const Vec3& low, const Vec3& high);

/// Radius 1, from z = 0 to 1.
ObstacleMesh cylinder(int sides);

/// An L of two unit squares and one more, three layers high: 17 edges of the shape are convex, one is reflex.
ObstacleMesh l_prism();

/// Base of radius `radius` at z = 0, apex (the last point) at z = 1.
ObstacleMesh cone(int sides, double radius);

/// A row of right-angled ridges along y, `count` of them with tips 1 high and 2 apart on a slab 1 thick.
ObstacleMesh teeth(int count);

/// Unit sphere of 2 meridians (rings - 1) triangles, poles on z.
ObstacleMesh sphere(int rings, int meridians);

/// Points (i, j, height(i, j)), i = 0..nx, j = 0..ny.
ObstacleMesh sheet(int nx, int ny, const std::function<double(int, int)>& height);

ObstacleMesh wire(const std::vector<Vec3>& points, bool is_closed);
ObstacleMesh nails(const std::vector<Vec3>& points);

/// Both in one mesh, not joined.
ObstacleMesh together(const ObstacleMesh& first, const ObstacleMesh& second);

/// Every face the other way round.
ObstacleMesh inside_out(ObstacleMesh mesh);

ObstacleMesh moved(ObstacleMesh mesh, const std::function<Vec3(const Vec3&)>& map);

}  // namespace arris::samples
