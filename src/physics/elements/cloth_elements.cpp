// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/elements/cloth_elements.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <span>

namespace arris {

namespace {

bool has_moved(const std::vector<char>& is_moved, std::span<const int> vertices)
{
    return std::any_of(vertices.begin(), vertices.end(), [&](int v) { return is_moved[v] != 0; });
}

/// Greedy colouring: each element, in order, takes the lowest colour that none of its vertices has.
template <typename Element>
ElementColors color_elements(int vertex_count, const std::vector<Element>& elements)
{
    // Colours used at each vertex so far: used[begin[v]] .. used[end[v] - 1].
    std::vector<int> begin(vertex_count + 1, 0);
    for (const Element& element : elements)
        for (const int v : element.vertices) ++begin[v + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<int> end(begin.begin(), begin.end() - 1), used(begin.back());
    std::vector<int> color(elements.size());
    std::vector<int> seen_by;  // for each colour, the last element that met it
    int color_count = 0;
    for (int e = 0; e < static_cast<int>(elements.size()); ++e) {
        for (const int v : elements[e].vertices)
            for (int u = begin[v]; u < end[v]; ++u) seen_by[used[u]] = e;
        int free_color = 0;
        while (free_color < color_count && seen_by[free_color] == e) ++free_color;
        if (free_color == color_count) {
            ++color_count;
            seen_by.push_back(-1);
        }
        color[e] = free_color;
        for (const int v : elements[e].vertices) used[end[v]++] = free_color;
    }

    // Counting sort by colour; within a colour, elements keep their order.
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

FaceElement make_face_element(const std::vector<Vec2>& material, const Face& vertices, const Face& points,
                              int piece)
{
    const Vec2& a = material[points[0]];
    const Vec2& b = material[points[1]];
    const Vec2& c = material[points[2]];
    const double doubled = twice_area(a, b, c);
    assert(doubled > 0.0 && "material faces are counter-clockwise");

    // grad N_a is perpendicular to the edge opposite a, and its length is one over the altitude.
    const auto gradient = [&](const Vec2& from, const Vec2& to) -> Vec2 {
        return Vec2(from.y() - to.y(), to.x() - from.x()) / doubled;
    };
    return {vertices, points, 0.5 * doubled, {gradient(b, c), gradient(c, a), gradient(a, b)}, piece};
}

FaceElement make_face_element(const std::vector<Vec2>& material, const Face& face, int piece)
{
    return make_face_element(material, face, face, piece);
}

FaceElement move_element(const FaceElement& face, const std::vector<Vec2>& material)
{
    return make_face_element(material, face.vertices, face.points, face.piece);
}

namespace {

int point_in(const FaceElement& face, int vertex)
{
    int k = 0;
    while (face.vertices[k] != vertex) ++k;
    return face.points[k];
}

/// The points in a face at the ends of a hinge's edge.
std::array<int, 2> ends_in(const FaceElement& face, const HingeElement& hinge)
{
    return {point_in(face, hinge.vertices[0]), point_in(face, hinge.vertices[1])};
}

/// A hinge's edge in the material. On a seam its direction is that in face c.
struct MaterialEdge {
    Vec2 way;
    double squared_length, length;
    bool is_seam;
};

MaterialEdge find_edge(const std::vector<Vec2>& material, const HingeElement& hinge, const FaceElement& c,
                       const FaceElement& d)
{
    const auto [a_in_c, b_in_c] = ends_in(c, hinge);
    const auto [a_in_d, b_in_d] = ends_in(d, hinge);
    const Vec2 e = material[b_in_c] - material[a_in_c];
    if (a_in_c == a_in_d && b_in_c == b_in_d) return {e, e.squaredNorm(), e.norm(), false};
    const double length = 0.5 * (e.norm() + (material[b_in_d] - material[a_in_d]).norm());
    return {e, length * length, length, true};
}

}  // namespace

void set_hinge(const std::vector<Vec2>& material, const FaceElement& c, const FaceElement& d,
               HingeElement& hinge)
{
    const MaterialEdge edge = find_edge(material, hinge, c, d);
    hinge.weight = hinge.is_crease() ? 3.0 * edge.length / hinge.crease_width
                                     : 3.0 * edge.squared_length / (c.area + d.area);
    hinge.pieces = {c.piece, d.piece};
    hinge.share = c.area / (c.area + d.area);
    hinge.is_seam = edge.is_seam;
}

std::array<int, 4> points_of(const HingeElement& hinge, const FaceElement& c, const FaceElement& d)
{
    const auto [a, b] = ends_in(c, hinge);
    return {a, b, point_in(c, hinge.vertices[2]), point_in(d, hinge.vertices[3])};
}

std::array<int, 4> points_of(const HingeElement& hinge, const ClothElements& elements)
{
    return points_of(hinge, elements.faces[hinge.faces[0]], elements.faces[hinge.faces[1]]);
}

Mat2 turn_over(const std::vector<Vec2>& material, const HingeElement& hinge, const FaceElement& c,
               const FaceElement& d)
{
    if (!hinge.is_seam) return Mat2::Identity();
    const auto [a_in_c, b_in_c] = ends_in(c, hinge);
    const auto [a_in_d, b_in_d] = ends_in(d, hinge);
    return turn_between(material[b_in_c] - material[a_in_c], material[b_in_d] - material[a_in_d]);
}

HingeWeightGradients compute_hinge_weight_gradients(const std::vector<Vec2>& material,
                                                    const HingeElement& hinge, const FaceElement& c,
                                                    const FaceElement& d)
{
    const MaterialEdge edge = find_edge(material, hinge, c, d);
    HingeWeightGradients gradients;
    for (auto* each : {&gradients.by_edge, &gradients.by_area[0], &gradients.by_area[1]})
        each->fill(Vec2::Zero());
    if (hinge.is_crease()) {
        gradients.by_edge[1] = 3.0 / hinge.crease_width * edge.way.normalized();
        gradients.by_edge[0] = -gradients.by_edge[1];
        return gradients;
    }
    // w = 3 |e|^2 / A: dw = 6 e . de / A - w dA / A, and a face's area grows by A_f b_i . dX_i.
    const double area = c.area + d.area;
    const double weight = 3.0 * edge.squared_length / area;
    const Mat2 back = turn_over(material, hinge, c, d).transpose();
    for (int i = 0; i < 4; ++i)
        for (int side = 0; side < 2; ++side) {
            const FaceElement& face = side == 0 ? c : d;
            for (int k = 0; k < 3; ++k) {
                if (face.vertices[k] != hinge.vertices[i]) continue;
                const bool is_beyond = edge.is_seam && side == 1 && i < 2;
                const Vec2 gradient = is_beyond ? Vec2(back * face.gradients[k]) : face.gradients[k];
                gradients.by_area[side][i] -= weight * face.area / area * gradient;
            }
        }
    // On a seam |e| is the mean of both sides, which grow together.
    const double share = edge.is_seam ? edge.squared_length / edge.way.squaredNorm() : 1.0;
    const Vec2 along_edge = 6.0 * share / area * edge.way;
    gradients.by_edge[0] -= along_edge;
    gradients.by_edge[1] += along_edge;
    return gradients;
}

ClothElements list_elements(const ClothMesh& mesh, const MeshTopology& topology, HingeUse use,
                            const Materials& materials)
{
    ClothElements elements;
    elements.vertex_count = mesh.vertex_count();
    elements.hinge_use = use;
    elements.faces.reserve(mesh.faces.size());
    for (int f = 0; f < mesh.face_count(); ++f) {
        const Face& points = mesh.points_of(f);
        elements.faces.push_back(make_face_element(mesh.material, mesh.faces[f], points,
                                                   materials.piece_at(mesh.material[points[0]])));
    }
    if (use == HingeUse::None) return elements;
    elements.hinges.reserve(topology.hinges.size());
    for (const Hinge& hinge : topology.hinges) {
        HingeElement made{{hinge.a, hinge.b, hinge.c, hinge.d}, {hinge.face_c, hinge.face_d}};
        set_hinge(mesh.material, elements.faces[hinge.face_c], elements.faces[hinge.face_d], made);
        elements.hinges.push_back(made);
    }
    return elements;
}

ClothElements make_elements(const ClothMesh& mesh, const MeshTopology& topology, HingeUse use,
                            const Materials& materials)
{
    ClothElements elements = list_elements(mesh, topology, use, materials);
    elements.face_colors = color_elements(elements.vertex_count, elements.faces);
    if (use == HingeUse::Terms)
        elements.hinge_colors = color_elements(elements.vertex_count, elements.hinges);
    return elements;
}

void update_elements(const ClothMesh& mesh, const std::vector<char>& is_moved, ClothElements& elements)
{
    for (FaceElement& face : elements.faces)
        if (has_moved(is_moved, face.vertices)) face = move_element(face, mesh.material);
    for (HingeElement& hinge : elements.hinges)
        if (has_moved(is_moved, hinge.vertices))
            set_hinge(mesh.material, elements.faces[hinge.faces[0]], elements.faces[hinge.faces[1]], hinge);
}

namespace {

/// A third of each face's `density(face)` times its area, at each of its corners.
template <class Density>
std::vector<double> lump(const ClothElements& elements, const Density& density)
{
    std::vector<double> sums(static_cast<std::size_t>(elements.vertex_count), 0.0);
    for (const FaceElement& face : elements.faces)
        for (const int v : face.vertices) sums[v] += density(face) * face.area / 3.0;
    return sums;
}

}  // namespace

std::vector<double> piece_areas(const Materials& materials, const ClothMesh& mesh)
{
    std::vector<double> areas(static_cast<std::size_t>(materials.count()), 0.0);
    for (int f = 0; f < mesh.face_count(); ++f) {
        const std::array<Vec2, 3> corners = mesh.corners(f);
        areas[materials.piece_at(corners[0])] += twice_area(corners);
    }
    for (double& area : areas) area *= 0.5;
    return areas;
}

double integrate(double Material::*property, const Materials& materials, const ClothElements& elements)
{
    std::vector<double> areas(static_cast<std::size_t>(materials.count()), 0.0);
    for (const FaceElement& face : elements.faces) areas[face.piece] += face.area;
    double sum = 0.0;
    for (int p = 0; p < materials.count(); ++p) sum += materials[p].*property * areas[p];
    return sum;
}

std::vector<double> lump_areas(const ClothElements& elements)
{
    return lump(elements, [](const FaceElement&) { return 1.0; });
}

std::vector<double> lump_masses(const Materials& materials, const ClothElements& elements)
{
    return lump(elements, [&](const FaceElement& face) { return materials[face.piece].density; });
}

}  // namespace arris
