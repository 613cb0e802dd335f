// SPDX-License-Identifier: GPL-3.0-or-later
//
// Each operation is treated as the straight motion of one point, which takes the faces around it along. A
// collapse moves the removed vertex to the one it is merged into, and a move moves its vertex. A flip moves
// the middle of the old edge to the middle of the new one. The faces sweep the space between the old and the
// new surface, so the check of a step's path (check_sweep) applies.
#include "geometry/surgery/surgery_clearance.h"

#include <algorithm>

#include "geometry/check/sweep_check.h"
#include "geometry/cloth/mesh_topology.h"

namespace arris {
namespace {

/// The faces before the operation as a small cloth.
struct Patch {
    std::vector<VertexId> ids;
    std::vector<Vec3> begin;
    std::vector<Face> faces;

    int add(VertexId id, const Vec3& place)
    {
        const int known = index_of(id);
        if (known < static_cast<int>(ids.size())) return known;
        ids.push_back(id);
        begin.push_back(place);
        return known;
    }

    /// The index of the vertex; the number of vertices if the patch does not contain it.
    int index_of(VertexId id) const
    {
        return static_cast<int>(std::find(ids.begin(), ids.end(), id) - ids.begin());
    }
};

Patch make_patch(const SurgeryEvent& event)
{
    Patch patch;
    for (const PatchFace& face : event.before) {
        Face made;
        for (int i = 0; i < 3; ++i) made[i] = patch.add(face.vertices[i], face.world[i]);
        patch.faces.push_back(made);
    }
    return patch;
}

/// Cuts both faces of a flip at the middle of the edge, the point that moves; returns its index.
int cut_in_the_middle(const std::array<VertexId, 2>& edge, Patch& patch)
{
    const int a = patch.index_of(edge[0]), b = patch.index_of(edge[1]);
    const int middle = patch.add(kNoVertex, 0.5 * (patch.begin[a] + patch.begin[b]));
    std::vector<Face> halves;
    for (const Face& face : patch.faces)
        for (const int gone : {a, b}) {
            Face half = face;
            std::replace(half.begin(), half.end(), gone, middle);
            halves.push_back(half);
        }
    patch.faces = halves;
    return middle;
}

/// The middle of the flip's new edge, which joins the two vertices across the old one.
Vec3 middle_across(const std::array<VertexId, 2>& edge, const Patch& patch)
{
    Vec3 sum = Vec3::Zero();
    for (std::size_t v = 0; v < patch.ids.size(); ++v)
        if (patch.ids[v] != edge[0] && patch.ids[v] != edge[1] && patch.ids[v] != kNoVertex)
            sum += patch.begin[v];
    return 0.5 * sum;
}

}  // namespace

bool is_free(const SurgeryEvent& event, const Obstacle& obstacle, const Placement& placement,
             double thickness)
{
    Patch patch = make_patch(event);
    std::vector<Vec3> end = patch.begin;
    switch (event.operation) {
        case SurgeryOperation::SplitEdge:
        case SurgeryOperation::SplitFace:
            return true;
        case SurgeryOperation::Flip:
            end.resize(patch.begin.size() + 1);
            end[cut_in_the_middle(event.edge, patch)] = middle_across(event.edge, patch);
            break;
        case SurgeryOperation::Move:
        case SurgeryOperation::Collapse:
            for (const VertexChange& change : event.changes)
                end[patch.index_of(change.vertex)] = change.new_world;
            break;
    }
    if (event.operation == SurgeryOperation::Collapse)
        for (const VertexChange& gone : event.changes)
            end[patch.index_of(gone.vertex)] = patch.begin[patch.index_of(gone.parents[0])];
    const MeshTopology topology = make_topology(static_cast<int>(patch.begin.size()), patch.faces);
    const ClothMotion motion = {&patch.faces, &topology.edges, to_local(placement, patch.begin),
                                to_local(placement, end)};
    return check_sweep(obstacle, motion, thickness).is_clean();
}

}  // namespace arris
