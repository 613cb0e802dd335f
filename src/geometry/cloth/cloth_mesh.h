// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// Persistent number of a vertex: kept as long as the vertex exists, and never reused.
using VertexId = std::uint32_t;

/// The cloth's triangle mesh as plain arrays; layers exchange it in this form. `material` and `world` have
/// one entry per vertex. Faces are counter-clockwise in material space, and every vertex belongs to a face.
struct ClothMesh {
    std::vector<Vec2> material;  ///< X, m: position on the flat cloth
    std::vector<Vec3> world;     ///< x, m: position in space
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
