// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "geometry/cloth/cloth_mesh.h"

namespace arris {

/// An interior edge (a, b) with the two vertices across it: faces (a, b, c) and (b, a, d).
struct Hinge {
    int a, b, c, d;
    int face_c, face_d;
};

/// An edge a < b; `face_right` is -1 on the cloth's border.
struct MeshEdge {
    int a, b;
    int face_left, face_right;
};

/// Connectivity derived from the faces. Edges ascend by (a, b), hinges follow the order of their edges.
struct MeshTopology {
    std::vector<MeshEdge> edges;
    std::vector<Hinge> hinges;
    std::vector<char> is_border;  ///< one entry per vertex
};

/// Linear in face count. Faces must form an oriented 2-manifold: `validate` checks that.
MeshTopology make_topology(int vertex_count, const std::vector<Face>& faces);

/// The faces at each vertex, ascending.
class VertexFaces {
  public:
    VertexFaces() = default;
    VertexFaces(int vertex_count, const std::vector<Face>& faces);

    bool empty() const { return faces_.empty(); }
    std::span<const int> operator[](int v) const
    {
        return {faces_.data() + begin_[v], static_cast<std::size_t>(begin_[v + 1] - begin_[v])};
    }

  private:
    std::vector<int> begin_;  // where each vertex's faces begin, and the end of the last vertex's
    std::vector<int> faces_;
};

/// Numbers by which messages name a mesh's vertices and faces. If empty, messages use indices counted from 0.
struct ElementNumbers {
    std::vector<int> vertices;
    std::vector<int> faces;
};

/// Checks a cloth mesh. Returns an empty string if indices are in range, every vertex is used, faces form an
/// oriented manifold, coordinates are finite and every face is counter-clockwise in material space (exact
/// predicate). Otherwise returns one sentence that names the faulty element by its number.
std::string validate(const ClothMesh& mesh, const ElementNumbers& numbers = {});

}  // namespace arris
