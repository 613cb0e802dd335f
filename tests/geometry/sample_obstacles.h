// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "geometry/obstacle/obstacle_mesh.h"

// Shapes with known features, insides and distances.
namespace arris::samples {

/// A closed prism over a counter-clockwise polygon in the xy plane, with rings of points at the ascending
/// `levels`. `cap` has the polygon's triangles; if empty, a fan from its first point.
ObstacleMesh prism(const std::vector<Vec2>& polygon, const std::vector<double>& levels,
                   const std::vector<Face>& cap = {});

ObstacleMesh box(const Vec3& low, const Vec3& high);

/// A cylinder of radius 1 from z = 0 to 1.
ObstacleMesh cylinder(int sides);

/// An L of three unit squares, three layers high: 17 edges of the shape are convex, one is reflex.
ObstacleMesh l_prism();

/// A cone with a base of radius `radius` at z = 0 and the apex (the last point) at z = 1.
ObstacleMesh cone(int sides, double radius);

/// A row of `count` right-angled ridges along y with tips 1 high and 2 apart, on a slab 1 thick.
ObstacleMesh teeth(int count);

/// Unit sphere of 2 meridians (rings - 1) triangles, with poles on z.
ObstacleMesh sphere(int rings, int meridians);

/// A sheet with points (i, j, height(i, j)), i = 0..nx, j = 0..ny.
ObstacleMesh sheet(int nx, int ny, const std::function<double(int, int)>& height);

ObstacleMesh wire(const std::vector<Vec3>& points, bool is_closed);
ObstacleMesh nails(const std::vector<Vec3>& points);

/// One mesh of the two given, not joined.
ObstacleMesh together(const ObstacleMesh& first, const ObstacleMesh& second);

/// The mesh with all faces reversed.
ObstacleMesh inside_out(ObstacleMesh mesh);

ObstacleMesh moved(ObstacleMesh mesh, const std::function<Vec3(const Vec3&)>& map);

}  // namespace arris::samples
