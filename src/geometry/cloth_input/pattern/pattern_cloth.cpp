// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/pattern/pattern_cloth.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <utility>

#include "geometry/cloth/mesh_quality.h"
#include "geometry/cloth/piece_layout.h"
#include "geometry/cloth/sewing.h"

namespace arris {
namespace {

// Room between neighbours, in edge lengths, however small the panels.
constexpr double kLeastRoom = 4.0;

// Boxes around the panels' own material. They are of the pattern and not of a mesh, so that a material point
// is at one place of the plane for every edge length.
std::vector<Eigen::AlignedBox2d> find_boxes(const SewingPattern& pattern, const PatternMesh& meshes)
{
    std::vector<Eigen::AlignedBox2d> boxes;
    for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
        boxes.emplace_back();
        const double side = meshes.panels[p].is_mirrored ? -1.0 : 1.0;
        for (const Vec2& uv : outline_of(curves_of(pattern.panels[p])))
            boxes.back().extend(Vec2(side * uv.x(), uv.y()));
    }
    return boxes;
}

std::vector<PlacedPanel> place_panels(const SewingPattern& pattern, const PatternMesh& meshes,
                                      double edge_length)
{
    const std::vector<Eigen::AlignedBox2d> boxes = find_boxes(pattern, meshes);
    // Arcs of a mesh may leave the box of the outline's polygon by a part of this room.
    double room = (kLeastRoom + 1.0) * edge_length;
    for (const Eigen::AlignedBox2d& box : boxes) room = std::max(room, box.sizes().maxCoeff());
    const std::vector<PiecePlace> places = lay_out(boxes, room);
    std::vector<PlacedPanel> panels;
    int face = 0;
    for (std::size_t p = 0; p < boxes.size(); ++p) {
        const ClothMesh& mesh = meshes.panels[p].mesh;
        panels.push_back({places[p], material_area(mesh), face, mesh.face_count()});
        panels.back().place.name = pattern.panels[p].name;
        panels.back().place.is_mirrored = meshes.panels[p].is_mirrored;
        face += mesh.face_count();
    }
    return panels;
}

// All panels as one mesh in which every point is a vertex.
class Parts {
  public:
    Parts(const PatternMesh& meshes, const std::vector<PlacedPanel>& panels)
    {
        std::vector<ClothMesh> moved;
        for (std::size_t p = 0; p < panels.size(); ++p) {
            first_.push_back(count_);
            count_ += meshes.panels[p].mesh.vertex_count();
            moved.push_back(meshes.panels[p].mesh);
            for (Vec2& X : moved.back().material) X.x() += panels[p].place.shift;
        }
        mesh = join(moved);
    }

    int point(const PanelVertex& v) const { return first_[v.panel] + v.vertex; }

    ClothMesh mesh;

  private:
    std::vector<int> first_;
    int count_ = 0;
};

std::vector<SeamPoints> find_seams(const SewingPattern& pattern, const PatternMesh& meshes,
                                   const Parts& parts, double edge_length, SewnSeams sewn)
{
    std::vector<SeamPoints> seams;
    for (std::size_t s = 0; s < meshes.seams.size(); ++s) {
        SeamPoints seam;
        for (const auto& [v, w] : meshes.seams[s]) seam.pairs.push_back({parts.point(v), parts.point(w)});
        const auto touches = [&](const std::array<int, 2>& pair) {
            return (parts.mesh.world[pair[0]] - parts.mesh.world[pair[1]]).norm() <=
                   kSeamTouches * edge_length;
        };
        seam.is_closed =
            !pattern.seams[s].is_tie &&
            (sewn == SewnSeams::All || std::all_of(seam.pairs.begin(), seam.pairs.end(), touches));
        seams.push_back(std::move(seam));
    }
    return seams;
}

// The name that `sew` gives to each point.
std::vector<int> sewn_names(const std::vector<int>& vertex_of)
{
    int vertices = 0;
    for (const int v : vertex_of) vertices = std::max(vertices, v + 1);
    std::vector<int> names;
    int first = 0, further = vertices;
    for (const int v : vertex_of) names.push_back(v == first ? first++ : further++);
    return names;
}

std::vector<LabelledLines> find_labels(const SewingPattern& pattern, const PatternMesh& meshes,
                                       const Parts& parts)
{
    std::map<std::string, LabelledLines> labels;
    for (int p = 0; p < static_cast<int>(pattern.panels.size()); ++p)
        for (int e = 0; e < static_cast<int>(pattern.panels[p].edges.size()); ++e) {
            const std::string& label = pattern.panels[p].edges[e].label;
            if (label.empty()) continue;
            LabelledLines& found = labels.try_emplace(label, LabelledLines{label, {}}).first->second;
            const std::vector<int> vertices = meshes.panels[p].vertices_of(e);
            const auto place = [&](int v) { return parts.mesh.material[parts.point({p, v})]; };
            for (std::size_t k = 1; k < vertices.size(); ++k)
                found.lines.push_back({place(vertices[k - 1]), place(vertices[k])});
        }
    std::vector<LabelledLines> list;
    for (auto& [label, lines] : labels) list.push_back(std::move(lines));
    return list;
}

}  // namespace

PatternCloth join_panels(const SewingPattern& pattern, const PatternMesh& meshes, double edge_length,
                         SewnSeams sewn)
{
    PatternCloth cloth;
    cloth.panels = place_panels(pattern, meshes, edge_length);
    Parts parts(meshes, cloth.panels);
    cloth.seams = find_seams(pattern, meshes, parts, edge_length, sewn);
    std::vector<std::array<int, 2>> closed;
    for (const SeamPoints& seam : cloth.seams)
        if (seam.is_closed) closed.insert(closed.end(), seam.pairs.begin(), seam.pairs.end());
    const std::vector<int> vertex_of = number_vertices(parts.mesh.vertex_count(), closed);
    const std::vector<int> names = sewn_names(vertex_of);
    for (SeamPoints& seam : cloth.seams)
        for (auto& pair : seam.pairs) pair = {names[pair[0]], names[pair[1]]};
    cloth.labels = find_labels(pattern, meshes, parts);
    cloth.mesh = sew(std::move(parts.mesh), vertex_of);
    return cloth;
}

}  // namespace arris
