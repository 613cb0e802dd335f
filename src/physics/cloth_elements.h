// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/cloth/cloth_mesh.h"
#include "geometry/cloth/mesh_topology.h"

namespace arris {

/// A triangle's material shape. `gradients` are those of its shape functions, 1/m, so that
/// F = sum_i x_i gradients[i]^T (3x2).
struct FaceElement {
    Face vertices;
    double area = 0.0;  ///< material, m^2
    std::array<Vec2, 3> gradients;
};

/// Two faces (a, b, c), (b, a, d) that share the edge (a, b). `weight` = 3 |e|^2 / A, e the edge and A the
/// area of both faces, in material space; of a crease 3 |e| / its width.
struct HingeElement {
    std::array<int, 4> vertices;
    std::array<int, 2> faces;
    double weight = 0.0;
    double crease_width = 0.0;  ///< m; 0 where it is no crease (physics/bending.h)

    bool is_crease() const { return crease_width > 0.0; }
};

/// Elements in classes ("colours") that share no vertex: those of one class can be added to a system in
/// parallel without a race, and the sum a matrix entry receives is the same for any number of threads. Class
/// k holds order[start[k]] .. order[start[k + 1] - 1].
struct ElementColors {
    std::vector<int> order;
    std::vector<int> start;
};

/// All that the terms need to know of the mesh besides where it is. Made anew where the mesh changes; where
/// only material coordinates do, `update_elements` is enough.
struct ClothElements {
    int vertex_count = 0;
    std::vector<FaceElement> faces;
    std::vector<HingeElement> hinges;
    ElementColors face_colors, hinge_colors;
};

/// Without colours: energies do not need them, and a few elements are added to a system one after the other.
/// Linear in face count. Material orientations must be positive
/// (`validate` checks it).
ClothElements list_elements(const ClothMesh& mesh, const MeshTopology& topology);

/// The same with colours.
ClothElements make_elements(const ClothMesh& mesh, const MeshTopology& topology);

/// Brings the elements at the vertices with `is_moved` (one a vertex) to the mesh's present material
/// coordinates: the same, to the bit, as `make_elements`. Faces, and so colours, must be what they were.
void update_elements(const ClothMesh& mesh, const std::vector<char>& is_moved, ClothElements& elements);

/// Of the triangle whose corners are at `material[face[i]]`, m; it must be counter-clockwise.
FaceElement make_face_element(const std::vector<Vec2>& material, const Face& face);

/// `weight` of a hinge whose vertices are at `material`, m, between faces of these areas.
double compute_hinge_weight(const std::vector<Vec2>& material, const HingeElement& hinge, double area_c,
                            double area_d);

/// Its derivatives by the material coordinates of the hinge's vertices, 1/m. `c` and `d` are its faces'
/// elements at `material`.
std::array<Vec2, 4> compute_hinge_weight_gradients(const std::vector<Vec2>& material,
                                                   const HingeElement& hinge, const FaceElement& c,
                                                   const FaceElement& d);

}  // namespace arris
