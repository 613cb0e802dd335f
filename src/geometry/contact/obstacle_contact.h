// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "geometry/cloth/cloth_mesh.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/obstacle/obstacle.h"

namespace arris {

/// The cloth's way during a step in an obstacle's frame; one entry a vertex.
struct ClothMotion {
    const std::vector<Face>* faces = nullptr;
    const std::vector<MeshEdge>* edges = nullptr;
    std::vector<Vec3> begin;  ///< where it is; free of the obstacle
    std::vector<Vec3>
        end;  ///< before the solve: where it would be if nothing were in its way; after: where it went
};

enum class ContactKind { Vertex, Edge, Triangle };  ///< which element of the cloth meets the obstacle

/// A point of the cloth: weights on up to three vertices.
struct ClothPoint {
    std::array<int, 3> vertices;    ///< -1 where there are fewer
    std::array<double, 3> weights;  ///< >= 0, sum 1

    Vec3 at(const std::vector<Vec3>& field) const
    {
        Vec3 sum = Vec3::Zero();
        for (int i = 0; i < 3; ++i)
            if (vertices[i] >= 0) sum += weights[i] * field[vertices[i]];
        return sum;
    }

    /// Changes `field` at the point by `change`, with the least change at its vertices.
    void shift(const Vec3& change, std::vector<Vec3>& field) const
    {
        double squares = 0.0;
        for (int i = 0; i < 3; ++i)
            if (vertices[i] >= 0) squares += weights[i] * weights[i];
        for (int i = 0; i < 3; ++i)
            if (vertices[i] >= 0) field[vertices[i]] += (weights[i] / squares) * change;
    }
};

/// A point of the cloth that must keep its distance from a plane that touches the obstacle:
/// normal . (sum_i weights_i x_i' - point) >= least_gap at the step's end, in the obstacle's frame.
struct ObstacleContact : ClothPoint {  // vertices ascending, unused ones last
    ContactKind kind;
    int element;  ///< of the obstacle: Vertex: a face, or with no face a feature edge or corner of
                  ///< `features()` (they only serve to compare); Edge: an edge of the topology; Triangle: a
                  ///< point of the mesh
    Vec3 normal;  ///< unit, from the obstacle to the cloth
    Vec3 point;   ///< on the obstacle
    double least_gap;  ///< m: the thickness, or less where the cloth was nearer: its distance from the
                       ///< obstacle at the begin, as far as its free way brings it there. More would hold it
                       ///< to the speed at which it comes out: what else pulls it back would be overcome,
                       ///< step by step.
};

/// Where the cloth would end if it slid along what is in its way: from `begin` towards `end`, at a face it
/// meets it goes on along that face, at most a few times; each leg is free of the obstacle's faces by exact
/// predicates. Where nothing is in the way it is `end`.
std::vector<Vec3> slide(const Obstacle& obstacle, const ClothMotion& motion, double thickness);

// Contacts of a step, before its solve. `reference` is `slide`'s. Each class sorted by (vertices, element).
// What is within three thicknesses of the reference position is found, more where the way is long; a plane
// behind which the cloth began is left out: it would pull it through to the side where its free flight ends.

/// A vertex and what of the obstacle it may reach: at each local minimum of the distance around its reference
/// position, one plane; at most three, the nearest first, of directions more than 20 degrees apart. Where
/// only a convex edge or corner is near it is one plane.
std::vector<ObstacleContact> find_vertex_contacts(const Obstacle& obstacle, const ClothMotion& motion,
                                                  const std::vector<Vec3>& reference, double thickness);

/// A cloth edge and a feature edge, inside the one and anywhere on the other but at corners. Edges within 1
/// degree of parallel have a contact only where they touch on the way.
std::vector<ObstacleContact> find_edge_contacts(const Obstacle& obstacle, const ClothMotion& motion,
                                                const std::vector<Vec3>& reference, double thickness);

/// A cloth face and a corner, anywhere but at the face's vertices; on an edge between two faces once.
std::vector<ObstacleContact> find_face_contacts(const Obstacle& obstacle, const ClothMotion& motion,
                                                const std::vector<Vec3>& reference, double thickness);

// One pair: where the way from `begin` to `reference` touches, the plane at the first touch; else that of the
// closest points at `reference`. Nothing where the closest point is no local minimum of the distance within
// the pair's interiors (a vertex's contact then), or where it cannot be told which side the cloth is on.

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
