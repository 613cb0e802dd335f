// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/cloth/cloth_mesh.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/obstacle/obstacle.h"

namespace arris {

/// Where an obstacle that deforms and the cloth begin a step, in the world.
struct MovingSides {
    std::shared_ptr<const Obstacle> obstacle;
    std::vector<Vec3> cloth;
};

/// Motion of the cloth during a step, in an obstacle's frame; one entry per vertex.
struct ClothMotion {
    const std::vector<Face>* faces = nullptr;
    const std::vector<MeshEdge>* edges = nullptr;
    std::vector<Vec3> begin;  ///< positions at the step's start, free of the obstacle
    /// Before the solve: where the cloth would be without obstacles. After the solve: where it went.
    std::vector<Vec3> end;
    /// Null on a rigid obstacle. Else the frame is the world, and `begin` is where the cloth would be at the
    /// end if each vertex rode with the place of the obstacle nearest to it (see ContactBegin).
    std::shared_ptr<const MovingSides> sides = nullptr;
};

enum class ContactKind { Vertex, Edge, Triangle };  ///< element of the cloth

/// A point of the cloth: weights on up to three vertices.
struct ClothPoint {
    std::array<int, 3> vertices;    ///< -1 where there are fewer
    std::array<double, 3> weights;  ///< >= 0, sum 1

    template <class Field>
    Vec3 at(const Field& field) const
    {
        Vec3 sum = Vec3::Zero();
        for (int i = 0; i < 3; ++i)
            if (vertices[i] >= 0) sum += weights[i] * field[vertices[i]];
        return sum;
    }

    /// Changes `field` by `change` at the point, with the least change at its vertices.
    void shift(const Vec3& change, std::vector<Vec3>& field) const
    {
        double squares = 0.0;
        for (int i = 0; i < 3; ++i)
            if (vertices[i] >= 0) squares += weights[i] * weights[i];
        for (int i = 0; i < 3; ++i)
            if (vertices[i] >= 0) field[vertices[i]] += (weights[i] / squares) * change;
    }
};

/// A point of the cloth that must keep its distance from a plane tangent to the obstacle, at the step's end:
/// normal . (sum_i weights_i x_i' - point) >= least_gap, in the obstacle's frame.
struct ObstacleContact : ClothPoint {  // vertices ascending, unused ones last
    ContactKind kind;
    int element;  ///< element of the obstacle. Edge: an edge of the topology. Triangle: a point of the mesh.
                  ///< Vertex: a face, or without a face an edge or corner of `features()`; it serves for
                  ///< comparison only.
    Vec3 normal;  ///< unit vector from the obstacle to the cloth
    Vec3 point;   ///< on the obstacle
    double least_gap;  ///< m, the thickness, or less where the cloth was nearer. Then the gap is the cloth's
                       ///< distance from the obstacle at begin, as far as its free motion keeps it. A larger
                       ///< gap would fix the speed at which the cloth comes out, against any force that
                       ///< pulls it back.
};

/// Reference positions: where the cloth would end if it slid along the obstacle. Each vertex moves from
/// `begin` towards `end`. At a face it continues along that face, a few times at most. Each leg is free of
/// the obstacle's faces by exact predicates. Without a face in the way the result is `end`.
std::vector<Vec3> slide(const Obstacle& obstacle, const ClothMotion& motion, double thickness);

// Contacts of a step, found before its solve. `reference` is the result of `slide`. Each function sorts its
// contacts by (vertices, element). The search covers three thicknesses around the reference position, and
// more where the cloth moves far. A plane behind which the cloth began is left out: it would pull the cloth
// through to where its free motion ends.

/// Contacts of a vertex: one plane at each local minimum of its distance to the obstacle, around its
/// reference position. At most three planes, the nearest first, with normals more than 20 degrees apart. Near
/// only a convex edge or corner this is one plane.
std::vector<ObstacleContact> find_vertex_contacts(const Obstacle& obstacle, const ClothMotion& motion,
                                                  const std::vector<Vec3>& reference, double thickness);

/// Contacts of a cloth edge and a feature edge: in the interior of the cloth edge, and anywhere on the
/// feature edge but at corners. Edges within 1 degree of parallel have a contact only where they touch during
/// the step.
std::vector<ObstacleContact> find_edge_contacts(const Obstacle& obstacle, const ClothMotion& motion,
                                                const std::vector<Vec3>& reference, double thickness);

/// Contacts of a cloth face and a corner, anywhere on the face but at its vertices; reported once on an edge
/// between two faces.
std::vector<ObstacleContact> find_face_contacts(const Obstacle& obstacle, const ClothMotion& motion,
                                                const std::vector<Vec3>& reference, double thickness);

// The contact of one pair. If the motion from `begin` to `reference` touches, this is the plane at the first
// touch; else the plane between the closest points at `reference`. Returns nothing where the closest points
// are no local minimum of distance in the interiors of both elements (a vertex's contact then). Returns
// nothing, too, where the side of the cloth is unknown.

/// Cloth edge `vertices` (a < b) and edge `element` of the obstacle's topology.
std::optional<ObstacleContact> make_edge_contact(const Obstacle& obstacle, const ClothMotion& motion,
                                                 const std::vector<Vec3>& reference,
                                                 const std::array<int, 2>& vertices, int element,
                                                 double thickness);

/// Cloth face (index) and point `element` of the obstacle's mesh.
std::optional<ObstacleContact> make_face_contact(const Obstacle& obstacle, const ClothMotion& motion,
                                                 const std::vector<Vec3>& reference, int face, int element,
                                                 double thickness);

}  // namespace arris
