// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/cloth_elements.h"

#include <cassert>

namespace arris {

namespace {

FaceElement make_face(const ClothMesh& mesh, const Face& face)
{
    const Vec2& a = mesh.material[face[0]];
    const Vec2& b = mesh.material[face[1]];
    const Vec2& c = mesh.material[face[2]];
    const double doubled = twice_area(a, b, c);
    assert(doubled > 0.0 && "material faces are counter-clockwise");

    // grad N_a is perpendicular to the edge across from a, and its length is one over the altitude.
    const auto gradient = [&](const Vec2& from, const Vec2& to) -> Vec2 {
        return Vec2(from.y() - to.y(), to.x() - from.x()) / doubled;
    };
    return {face, 0.5 * doubled, {gradient(b, c), gradient(c, a), gradient(a, b)}};
}

HingeElement make_hinge(const ClothMesh& mesh, const Hinge& hinge, const std::vector<FaceElement>& faces)
{
    const double squared_length = (mesh.material[hinge.b] - mesh.material[hinge.a]).squaredNorm();
    const double area = faces[hinge.face_c].area + faces[hinge.face_d].area;
    return {{hinge.a, hinge.b, hinge.c, hinge.d}, {hinge.face_c, hinge.face_d}, 3.0 * squared_length / area};
}

/// Greedy: each element, in order, takes the least colour none of its vertices has.
template <typename Element>
ElementColors color_elements(int vertex_count, const std::vector<Element>& elements)
{
    std::vector<std::vector<int>> used(vertex_count);  // colours at a vertex
    std::vector<int> color(elements.size());
    std::vector<int> seen_by;  // last element that met this colour
    int color_count = 0;
    for (int e = 0; e < static_cast<int>(elements.size()); ++e) {
        for (const int v : elements[e].vertices)
            for (const int k : used[v]) seen_by[k] = e;
        int free_color = 0;
        while (free_color < color_count && seen_by[free_color] == e) ++free_color;
        if (free_color == color_count) {
            ++color_count;
            seen_by.push_back(-1);
        }
        color[e] = free_color;
        for (const int v : elements[e].vertices) used[v].push_back(free_color);
    }

    // Counting sort by colour; within one, elements keep their order.
    ElementColors colors;
    colors.start.assign(color_count + 1, 0);
    for (const int k : color) ++colors.start[k + 1];
    for (int k = 0; k < color_count; ++k) colors.start[k + 1] += colors.start[k];
    colors.order.resize(elements.size());
    std::vector<int> next = colors.start;
    for (int e = 0; e < static_cast<int>(elements.size()); ++e) colors.order[next[color[e]]++] = e;
    return colors;
}

}  // namespace

ClothElements make_elements(const ClothMesh& mesh, const MeshTopology& topology)
{
    ClothElements elements;
    elements.vertex_count = mesh.vertex_count();
    elements.faces.reserve(mesh.faces.size());
    for (const Face& face : mesh.faces) elements.faces.push_back(make_face(mesh, face));
    elements.hinges.reserve(topology.hinges.size());
    for (const Hinge& hinge : topology.hinges)
        elements.hinges.push_back(make_hinge(mesh, hinge, elements.faces));
    elements.face_colors = color_elements(elements.vertex_count, elements.faces);
    elements.hinge_colors = color_elements(elements.vertex_count, elements.hinges);
    return elements;
}

}  // namespace arris
