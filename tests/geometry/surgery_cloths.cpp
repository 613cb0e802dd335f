// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/geometry/surgery_cloths.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/cgal.h"
#include "geometry/cloth/mesh_quality.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/cloth_input/cloth_grid.h"

namespace arris {
namespace {

// Split points change the border's length only by rounding; cutting off a corner changes it more.
constexpr double kBorderTolerance = 1e-11;
constexpr double kAreaTolerance = 1e-12;

Vec3 wave(const Vec2& X)
{
    return {X.x(), X.y(), 0.05 * std::sin(5.0 * X.x() + 3.0 * X.y())};
}

double border_length(const ClothMesh& mesh)
{
    double length = 0.0;
    for (const MeshEdge& e : make_topology(mesh.vertex_count(), mesh.faces).edges)
        if (e.face_right < 0) length += (mesh.material[e.b] - mesh.material[e.a]).norm();
    return length;
}

// The area is summed about the first vertex, which avoids cancellation far from the origin.
double area(ClothMesh mesh)
{
    const Vec2 origin = mesh.material[0];
    for (Vec2& X : mesh.material) X -= origin;
    return material_area(mesh);
}

bool has_positive_faces(const ClothMesh& mesh, std::span<const int> faces)
{
    return std::all_of(faces.begin(), faces.end(), [&](int f) {
        const auto& [a, b, c] = mesh.faces[f];
        return exact_orientation(mesh.material[a], mesh.material[b], mesh.material[c]) > 0;
    });
}

}  // namespace

std::vector<VertexId> SurgeryCloth::ids() const
{
    std::vector<VertexId> ids(mesh.world.size());
    std::iota(ids.begin(), ids.end(), 0u);
    return ids;
}

ClothSurgery SurgeryCloth::surgery() const
{
    return ClothSurgery(mesh, ids(), static_cast<VertexId>(mesh.vertex_count()));
}

SurgeryCloth square_cloth(int n, double jitter, unsigned seed)
{
    ClothGrid grid;
    grid.resolution = {n, n};
    grid.pattern = GridPattern::Diagonal;
    SurgeryCloth cloth{fmt::format("square {} jitter {}", n, jitter), make_cloth_grid(grid), 1.0 / n};
    const MeshTopology topology = make_topology(cloth.mesh.vertex_count(), cloth.mesh.faces);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shift(-jitter * cloth.cell, jitter * cloth.cell);
    for (int v = 0; v < cloth.mesh.vertex_count(); ++v) {
        if (topology.is_border[v] == 0 && jitter > 0.0) {
            const double u = shift(random);
            cloth.mesh.material[v] += Vec2(u, shift(random));
        }
        cloth.mesh.world[v] = wave(cloth.mesh.material[v]);
    }
    return cloth;
}

SurgeryCloth square_without(int n, std::array<int, 4> cut, const std::string& name)
{
    SurgeryCloth whole = square_cloth(n);
    SurgeryCloth cloth{name, {}, whole.cell};
    std::vector<int> index(whole.mesh.world.size(), -1);
    for (Face face : whole.mesh.faces) {
        const Vec2 centre =
            (whole.mesh.material[face[0]] + whole.mesh.material[face[1]] + whole.mesh.material[face[2]]) / 3;
        const Vec2 cell = centre / whole.cell;
        if (cell.x() > cut[0] && cell.x() < cut[1] && cell.y() > cut[2] && cell.y() < cut[3]) continue;
        for (const int v : face) index[v] = 0;
        cloth.mesh.faces.push_back(face);
    }
    int count = 0;
    for (int v = 0; v < whole.mesh.vertex_count(); ++v) {
        if (index[v] < 0) continue;
        index[v] = count++;
        cloth.mesh.material.push_back(whole.mesh.material[v]);
        cloth.mesh.world.push_back(whole.mesh.world[v]);
    }
    for (Face& face : cloth.mesh.faces)
        for (int& v : face) v = index[v];
    return cloth;
}

SurgeryCloth bay_cloth(int n)
{
    return square_without(n, {n / 3, 2 * n / 3, n / 3, n}, "bay");
}

SurgeryCloth holed_cloth(int n)
{
    return square_without(n, {n / 3, 2 * n / 3, n / 3, 2 * n / 3}, "hole");
}

SurgeryCloth turned_cloth(int n)
{
    SurgeryCloth cloth = square_cloth(n);
    cloth.name = "turned";
    const double c = std::cos(0.3), s = std::sin(0.3);
    for (Vec2& X : cloth.mesh.material) X = Vec2(c * X.x() - s * X.y(), s * X.x() + c * X.y());
    return cloth;
}

SurgeryCloth placed(SurgeryCloth cloth, double scale, const Vec2& offset)
{
    for (Vec2& X : cloth.mesh.material) X = scale * X + offset;
    cloth.cell *= scale;
    cloth.name += fmt::format(" x {} + ({}, {})", scale, offset.x(), offset.y());
    return cloth;
}

SurgeryCloth sabotaged_cloth(int n, unsigned seed)
{
    SurgeryCloth cloth = square_cloth(n, 0.2, seed);
    cloth.name = fmt::format("sabotaged {}", seed);
    ClothMesh& mesh = cloth.mesh;
    const MeshTopology topology = make_topology(mesh.vertex_count(), mesh.faces);
    const VertexFaces faces_at(mesh.vertex_count(), mesh.faces);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        if (topology.is_border[v] != 0 || unit(random) > 0.3) continue;
        const Face& face = mesh.faces[faces_at[v].front()];
        const auto at = std::find(face.begin(), face.end(), v) - face.begin();
        const Vec2 a = mesh.material[face[(at + 1) % 3]];
        const Vec2 d = mesh.material[face[(at + 2) % 3]] - a;
        const double s = 0.2 + 0.6 * unit(random);
        const double altitude = std::pow(10.0, -17.0 + 8.0 * unit(random));
        const Vec2 old = mesh.material[v];
        mesh.material[v] = a + s * d + altitude * Vec2(-d.y(), d.x()).normalized();
        if (!has_positive_faces(mesh, faces_at[v])) mesh.material[v] = old;
    }
    return cloth;
}

SurgeryCheck::SurgeryCheck(const ClothSurgery& surgery)
{
    const SurgeryResult result = surgery.result();
    area_ = area(result.mesh);
    border_length_ = border_length(result.mesh);
    for (const VertexId v : result.ids)
        if (surgery.is_fixed(v)) fixed_.emplace_back(v, surgery.material(v));
}

std::string SurgeryCheck::find_wrong(const ClothSurgery& surgery) const
{
    const SurgeryResult result = surgery.result();
    if (std::string wrong = validate(result.mesh); !wrong.empty()) return wrong;
    const double change = area(result.mesh) / area_ - 1.0;
    if (!(std::abs(change) <= kAreaTolerance)) return fmt::format("area off by {} of it", change);
    const double border_change = border_length(result.mesh) / border_length_ - 1.0;
    if (!(std::abs(border_change) <= kBorderTolerance))
        return fmt::format("border's length off by {} of it", border_change);
    for (const auto& [v, X] : fixed_)
        if (!surgery.has_vertex(v) || surgery.material(v) != X) return fmt::format("corner {} is gone", v);
    for (const auto& edge : result.tagged_edges)
        if (result.roles[edge.a] == TraceRole::Free || result.roles[edge.b] == TraceRole::Free)
            return fmt::format("tagged edge {}-{} ends at a free vertex", edge.a, edge.b);
    if (!std::is_sorted(result.ids.begin(), result.ids.end())) return "ids do not ascend";
    return {};
}

bool is_same(const SurgeryResult& a, const SurgeryResult& b)
{
    const auto same_edges = [](const auto& e, const auto& f) {
        return e.a == f.a && e.b == f.b && e.tag == f.tag;
    };
    return a.mesh.material == b.mesh.material && a.mesh.world == b.mesh.world &&
           a.mesh.faces == b.mesh.faces && a.ids == b.ids && a.next_id == b.next_id && a.roles == b.roles &&
           a.tags == b.tags &&
           std::equal(a.tagged_edges.begin(), a.tagged_edges.end(), b.tagged_edges.begin(),
                      b.tagged_edges.end(), same_edges);
}

VertexId nearest_vertex(const ClothSurgery& surgery, const Vec2& material)
{
    const SurgeryResult result = surgery.result();
    const auto nearest = std::min_element(
        result.mesh.material.begin(), result.mesh.material.end(), [&](const Vec2& X, const Vec2& Y) {
            return (X - material).squaredNorm() < (Y - material).squaredNorm();
        });
    return result.ids[nearest - result.mesh.material.begin()];
}

}  // namespace arris
