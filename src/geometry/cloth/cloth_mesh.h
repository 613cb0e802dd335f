// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// Persistent: a vertex keeps its id for life, and no other ever gets it.
using VertexId = std::uint32_t;

/// The cloth's triangles as plain arrays; the form in which layers exchange them. `material` and `world`
/// have one entry a vertex. Faces are counter-clockwise in material space, and every vertex belongs to one.
struct ClothMesh {
    std::vector<Vec2> material;  ///< X, m: which point of the cloth a vertex is
    std::vector<Vec3> world;     ///< x, m: where it is
    std::vector<Face> faces;

    int vertex_count() const { return static_cast<int>(world.size()); }
    int face_count() const { return static_cast<int>(faces.size()); }
};

/// Twice the signed area of a material triangle, m^2; positive where a, b, c turn counter-clockwise.
inline double twice_area(const Vec2& a, const Vec2& b, const Vec2& c)
{
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

}  // namespace arris
