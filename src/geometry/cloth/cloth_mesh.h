// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// Persistent number of a vertex: kept as long as the vertex exists, and never reused.
using VertexId = std::uint32_t;

/// The cloth's triangle mesh as plain arrays; layers exchange it in this form. A *vertex* is a place in the
/// world, a *point* one of the flat material. A vertex on a seam has a point on each side; every other one
/// has a single point. Point v is one of vertex v's; further points of seam vertices come after those. Faces
/// are counter-clockwise in the material, and every vertex and point belongs to a face.
struct ClothMesh {
    std::vector<Vec2> material;           ///< X, m, of each point: position on the flat cloth
    std::vector<Vec3> world;              ///< x, m, of each vertex: position in space
    std::vector<Face> faces;              ///< vertices at the corners
    std::vector<Face> face_points = {};   ///< points at the corners; empty without seams
    std::vector<int> seam_vertices = {};  ///< vertex of each point beyond vertex_count()

    int vertex_count() const { return static_cast<int>(world.size()); }
    int face_count() const { return static_cast<int>(faces.size()); }
    bool has_seams() const { return !face_points.empty(); }

    /// Points at the corners of a face.
    const Face& points_of(int face) const { return has_seams() ? face_points[face] : faces[face]; }
    /// Point of a vertex in one of its faces.
    int point_of(int vertex, int face) const
    {
        if (!has_seams()) return vertex;
        int k = 0;
        while (faces[face][k] != vertex) ++k;
        return face_points[face][k];
    }
    int vertex_of(int point) const
    {
        return point < vertex_count() ? point : seam_vertices[point - vertex_count()];
    }
    /// Material coordinates, m, of a face's corners.
    std::array<Vec2, 3> corners(int face) const
    {
        const auto& [a, b, c] = points_of(face);
        return {material[a], material[b], material[c]};
    }
};

/// Twice the signed area of a material triangle, m^2; positive where a, b, c turn counter-clockwise.
inline double twice_area(const Vec2& a, const Vec2& b, const Vec2& c)
{
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}
inline double twice_area(const std::array<Vec2, 3>& corners)
{
    return twice_area(corners[0], corners[1], corners[2]);
}

}  // namespace arris
