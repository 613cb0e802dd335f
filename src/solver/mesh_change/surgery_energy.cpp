// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/surgery_energy.h"

#include <algorithm>

namespace arris {

namespace {

bool has_tag(const ClothSurgery& surgery, VertexId a, VertexId b)
{
    return surgery.has_vertex(a) && surgery.has_vertex(b) && surgery.edge_tag(a, b) != kNoTag;
}

/// A few faces, with the hinges between them and to the mesh around.
class PatchElements {
  public:
    PatchElements(const ClothSurgery& surgery, const SurgeryEvent& event, const std::vector<PatchFace>& faces,
                  const Materials& materials)
        : surgery_(surgery), event_(event), materials_(materials)
    {
        for (const PatchFace& face : faces) {
            Face points;
            for (int k = 0; k < 3; ++k)
                points[k] = add(face.vertices[k], face.cloth_vertices[k], face.material[k], face.world[k]);
            elements_.faces.push_back(make_element(points));
        }
    }

    void add_hinges(const std::vector<double>& crease_widths)
    {
        const int count = static_cast<int>(elements_.faces.size());
        for (int f = 0; f < count; ++f)
            for (int k = 0; k < 3; ++k) add_hinge(f, k, crease_widths[elements_.faces[f].piece]);
    }

    Energies energies(const Terms& terms) const { return compute_energies(elements_, terms, world_); }

  private:
    int add(VertexId id, VertexId cloth_vertex, const Vec2& material, const Vec3& world)
    {
        const auto found = std::find(ids_.begin(), ids_.end(), id);
        if (found != ids_.end()) return static_cast<int>(found - ids_.begin());
        ids_.push_back(id);
        cloth_vertices_.push_back(cloth_vertex);
        material_.push_back(material);
        world_.push_back(world);
        return static_cast<int>(ids_.size()) - 1;
    }

    /// On a seam, the first of the points here that are at the same vertex: as a vertex it stands for all.
    int vertex_at(int point) const
    {
        const auto first = std::find(cloth_vertices_.begin(), cloth_vertices_.end(), cloth_vertices_[point]);
        return static_cast<int>(first - cloth_vertices_.begin());
    }

    FaceElement make_element(const Face& points) const
    {
        const Face vertices = {vertex_at(points[0]), vertex_at(points[1]), vertex_at(points[2])};
        return make_face_element(material_, vertices, points, materials_.piece_at(material_[points[0]]));
    }

    /// Adds the hinge across edge k of face f; an edge between two of the faces once only.
    void add_hinge(int f, int k, double crease_width)
    {
        const Face &face = elements_.faces[f].vertices, &points = elements_.faces[f].points;
        const int a = face[k], b = face[(k + 1) % 3], c = face[(k + 2) % 3];
        const int inner = face_within(b, a);
        if (inner >= 0 && ids_[a] > ids_[b]) return;
        const int beyond = inner >= 0 ? inner : face_around(f, k);
        if (beyond < 0) return;
        const auto within = elements_.faces.size();
        const FaceElement other = inner >= 0 ? elements_.faces[beyond] : elements_.rim[beyond - within];
        HingeElement hinge{{a, b, c, apex_of(other.vertices, a, b)}, {f, beyond}};
        const bool is_crease =
            crease_width > 0.0 && is_on_trace(surgery_, event_, ids_[points[k]], ids_[points[(k + 1) % 3]]);
        hinge.crease_width = is_crease ? crease_width : 0.0;
        set_hinge(material_, elements_.faces[f], other, hinge);
        elements_.hinges.push_back(hinge);
    }

    /// The face with the directed edge (a, b), or -1.
    int face_within(int a, int b) const
    {
        for (std::size_t f = 0; f < elements_.faces.size(); ++f) {
            const Face& face = elements_.faces[f].vertices;
            for (int k = 0; k < 3; ++k)
                if (face[k] == a && face[(k + 1) % 3] == b) return static_cast<int>(f);
        }
        return -1;
    }

    static int apex_of(const Face& face, int a, int b)
    {
        return *std::find_if(face.begin(), face.end(), [&](int v) { return v != a && v != b; });
    }

    /// Index of a face beside the patch.
    int add_rim(const Face& points)
    {
        const auto found = std::find_if(elements_.rim.begin(), elements_.rim.end(), [&](const auto& listed) {
            return std::is_permutation(points.begin(), points.end(), listed.points.begin());
        });
        const auto index = elements_.faces.size() + static_cast<std::size_t>(found - elements_.rim.begin());
        if (found == elements_.rim.end()) elements_.rim.push_back(make_element(points));
        return static_cast<int>(index);
    }

    /// Index of the face around the patch across edge k of face f, perhaps over a seam; -1 without one.
    int face_around(int f, int k)
    {
        const Face& points = elements_.faces[f].points;
        std::array<VertexId, 2> edge = {ids_[points[k]], ids_[points[(k + 1) % 3]]};
        if (!surgery_.has_vertex(edge[0]) || !surgery_.has_vertex(edge[1])) return -1;
        if (const auto other_side = surgery_.partner(edge[0], edge[1])) edge = *other_side;
        const VertexId apex = surgery_.apex(edge[1], edge[0]);
        if (apex == kNoVertex) return -1;
        const auto add_point = [&](VertexId id) {
            return add(id, surgery_.vertex_of(id), surgery_.material(id), surgery_.world(id));
        };
        return add_rim({add_point(edge[1]), add_point(edge[0]), add_point(apex)});
    }

    const ClothSurgery& surgery_;
    const SurgeryEvent& event_;
    const Materials& materials_;
    std::vector<VertexId> ids_, cloth_vertices_;  // by point, about twelve
    std::vector<Vec2> material_;
    std::vector<Vec3> world_;
    ClothElements elements_;
};

}  // namespace

bool is_on_trace(const ClothSurgery& surgery, const SurgeryEvent& event, VertexId a, VertexId b)
{
    if (has_tag(surgery, a, b)) return true;
    const auto [first, second] = event.edge;
    const auto is_made = [&](VertexId at, VertexId other) {
        if (event.operation == SurgeryOperation::Collapse)
            return at == second && other != first && has_tag(surgery, first, other);
        return event.operation == SurgeryOperation::SplitEdge && at == event.changes[0].vertex &&
               (other == first || other == second) && has_tag(surgery, first, second);
    };
    return is_made(a, b) || is_made(b, a);
}

Energies find_energies(const ClothSurgery& surgery, const SurgeryEvent& event,
                       const std::vector<PatchFace>& faces, const Terms& terms,
                       const std::vector<double>& crease_widths)
{
    PatchElements patch(surgery, event, faces, terms.materials);
    if (!terms.hinges.empty()) patch.add_hinges(crease_widths);
    return patch.energies(terms);
}

}  // namespace arris
