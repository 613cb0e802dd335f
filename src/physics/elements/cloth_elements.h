// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/cloth/cloth_mesh.h"
#include "geometry/cloth/mesh_topology.h"
#include "physics/elements/materials.h"

namespace arris {

/// A triangle's shape in the material. `gradients` are the gradients of its shape functions, 1/m, so that F =
/// sum_i x_i gradients[i]^T (3x2).
struct FaceElement {
    Face vertices;
    Face points;        ///< of the material (ClothMesh), at its corners
    double area = 0.0;  ///< m^2, in the material
    std::array<Vec2, 3> gradients;
    int piece = 0;  ///< of the cloth: whose material it has
};

/// Two faces (a, b, c), (b, a, d) that share the edge (a, b). `weight` = 3 |e|^2 / A, with e the edge and A
/// the area of both faces, in the material; for a crease, 3 |e| / its width. On a seam |e| is the mean of the
/// edge's lengths on both sides.
struct HingeElement {
    std::array<int, 4> vertices;
    std::array<int, 2> faces;
    double weight = 0.0;
    double crease_width = 0.0;           ///< m; 0 if the hinge is no crease (physics/forces/bending.h)
    std::array<int, 2> pieces = {0, 0};  ///< of its faces
    double share = 0.5;                  ///< of the first face in the area of both; for unlike pieces
    bool is_seam = false;                ///< whether its faces have points of their own at the edge

    bool is_crease() const { return crease_width > 0.0; }
};

/// A spring between two vertices, which pulls where they are farther apart than its length.
struct SpringElement {
    std::array<int, 2> vertices;
    double stiffness = 0.0;  ///< N/m
    double length = 0.0;     ///< m
};

/// Elements in classes ("colours") without common vertices. Elements of one class can be added to a system in
/// parallel without a race. Each matrix entry gets the same sum for any number of threads. Class k consists
/// of order[start[k]] .. order[start[k + 1] - 1].
struct ElementColors {
    std::vector<int> order;
    std::vector<int> start;
};

/// What a cloth's hinges are for: nothing, so that there are none; the momentum of material that flows around
/// them (momentum_flux.h); or, beside that, the hinge terms of an effect such as bending.
enum class HingeUse { None, Flow, Terms };

/// Everything about the mesh that the terms need, besides its positions. Rebuilt where the mesh changes.
/// Where only material coordinates change, `update_elements` suffices.
struct ClothElements {
    int vertex_count = 0;
    std::vector<FaceElement> faces;
    std::vector<HingeElement> hinges;
    std::vector<FaceElement> rim;  ///< where `faces` are a part of a cloth: further faces of `hinges`, which
                                   ///< have the indices from faces.size() on, and no terms of their own
    std::vector<SpringElement> springs = {};
    HingeUse hinge_use = HingeUse::Terms;
    ElementColors face_colors, hinge_colors;
};

/// Elements without colours, which suffice for energies and for assembling a few elements one after the
/// other. Linear in face count. Material orientations must be positive (`validate` checks this).
ClothElements list_elements(const ClothMesh& mesh, const MeshTopology& topology,
                            HingeUse use = HingeUse::Terms, const Materials& materials = {});

/// Elements with colours. Hinges are listed if `use` is not None, and get colours if it is Terms.
ClothElements make_elements(const ClothMesh& mesh, const MeshTopology& topology,
                            HingeUse use = HingeUse::Terms, const Materials& materials = {});

/// Recomputes the elements at vertices with `is_moved` (one entry per vertex) from the mesh's material
/// coordinates. The result is bitwise that of `make_elements`. Faces, and so colours, must be unchanged.
void update_elements(const ClothMesh& mesh, const std::vector<char>& is_moved, ClothElements& elements);

/// Material of each vertex, m^2: a third of its faces'.
std::vector<double> lump_areas(const ClothElements& elements);

/// Material of each piece, m^2.
std::vector<double> piece_areas(const Materials& materials, const ClothMesh& mesh);

/// Integral over the cloth of a property per area, such as its mass.
double integrate(double Material::*property, const Materials& materials, const ClothElements& elements);

/// Mass of each vertex, kg: a third of its faces'.
std::vector<double> lump_masses(const Materials& materials, const ClothElements& elements);

/// Element of the triangle with corners at `material[points[i]]`, m; it must be counter-clockwise.
FaceElement make_face_element(const std::vector<Vec2>& material, const Face& vertices, const Face& points,
                              int piece = 0);
/// Element of a triangle of cloth without seams, where every vertex has one point.
FaceElement make_face_element(const std::vector<Vec2>& material, const Face& face, int piece = 0);

/// The element at other material coordinates of its points.
FaceElement move_element(const FaceElement& face, const std::vector<Vec2>& material);

/// Sets a hinge's weight, pieces and share. `c` and `d` are the elements of its faces at `material`, m.
void set_hinge(const std::vector<Vec2>& material, const FaceElement& c, const FaceElement& d,
               HingeElement& hinge);

/// The points of a hinge's vertices: of its edge's ends, those in face c. `c` and `d`: its faces.
std::array<int, 4> points_of(const HingeElement& hinge, const FaceElement& c, const FaceElement& d);

std::array<int, 4> points_of(const HingeElement& hinge, const ClothElements& elements);

/// Map of a flow along a seam from the side of face c to that of d, at an end of the hinge's edge; the
/// identity where there is no seam.
Mat2 turn_over(const std::vector<Vec2>& material, const HingeElement& hinge, const FaceElement& c,
               const FaceElement& d);

/// Derivatives of a hinge's weight by the material coordinates of its points (`points_of`), 1/m: those of the
/// edge's length and of the areas of faces c and d. The other side of a seam moves along (`turn_over`).
struct HingeWeightGradients {
    std::array<Vec2, 4> by_edge;
    std::array<std::array<Vec2, 4>, 2> by_area;
};
HingeWeightGradients compute_hinge_weight_gradients(const std::vector<Vec2>& material,
                                                    const HingeElement& hinge, const FaceElement& c,
                                                    const FaceElement& d);

}  // namespace arris
