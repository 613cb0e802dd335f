// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/mesh_change_guard.h"

#include <algorithm>
#include <utility>

#include "geometry/from_least.h"
#include "geometry/sort_unique.h"
#include "physics/forces/make_terms.h"
#include "solver/mesh_change/strain_allowance.h"
#include "solver/mesh_change/surgery_energy.h"
#include "solver/model/target_length.h"

namespace arris {

namespace {

std::size_t find_place(const std::vector<VertexId>& ascending, VertexId v)
{
    return static_cast<std::size_t>(std::lower_bound(ascending.begin(), ascending.end(), v) -
                                    ascending.begin());
}

bool contains(const std::vector<VertexId>& ascending, VertexId v)
{
    return std::binary_search(ascending.begin(), ascending.end(), v);
}

}  // namespace

MeshChangeGuard::MeshChangeGuard(const Scene& scene, const State& state, StrainLimit limit,
                                 std::vector<VertexId> careful_at, RelaxationMemo& relaxations)
    : scene_(scene),
      state_(state),
      terms_(make_terms(scene.materials, scene.gravity, {}, {})),
      crease_widths_(find_crease_widths(scene, state.mesh)),
      limit_(limit),
      careful_at_(std::move(careful_at)),
      relaxations_(relaxations)
{
}

bool MeshChangeGuard::allows(const SurgeryEvent& event)
{
    const double thickness = scene_.materials.thickness();
    if (strains(event)) return false;
    return std::all_of(scene_.obstacles.begin(), scene_.obstacles.end(), [&](const MovingObstacle& obstacle) {
        const ObstaclePose pose = obstacle.at(state_.time);
        return is_free(event, pose, pose.placement, thickness);
    });
}

double MeshChangeGuard::allowance(const SurgeryEvent& event, double elastic_energy) const
{
    // Clearing may raise the energy by this many times as much. Otherwise the trace would be released, and a
    // constraint would hold everything that slides.
    constexpr double kClearing = 10.0;
    Heft heft;
    double squared_speed = 0.0;
    for (const PatchFace& face : event.before) {
        heft.add(scene_.materials.at(face.material[0]), 0.5 * twice_area(face.material));
        for (const VertexId id : face.cloth_vertices)
            if (const int v = state_.index_of(id); v >= 0)
                squared_speed = std::max(squared_speed, state_.velocity[v].squaredNorm());
    }
    const double motion =
        0.5 * heft.mass * squared_speed +
        weight_over(scene_, heft, target_length(scene_, state_, event.before[0].material[0]));
    return (is_clearing_ ? kClearing : 1.0) *
           (kAllowedStrain * elastic_energy + kAllowedStrain * motion + unseen_energy(heft));
}

bool MeshChangeGuard::strains(const SurgeryEvent& event)
{
    const bool is_split =
        event.operation == SurgeryOperation::SplitEdge || event.operation == SurgeryOperation::SplitFace;
    if (is_split) return false;  // changes only the width of hinges, not the surface
    const Energies before = find_energies(*surgery_, event, event.before, terms_, crease_widths_);
    const Energies after = find_energies(*surgery_, event, event.after, terms_, crease_widths_);
    double rise = after.sum() - before.sum();
    if (!(rise > 0.0)) return false;  // the allowance is not needed
    rise -= allowance(event, before.elastic());
    if (!(rise > 0.0)) return false;
    return !can_give_way(event, rise);
}

bool MeshChangeGuard::can_give_way(const SurgeryEvent& event, double rise)
{
    const auto is_careful = [this](const PatchFace& face) {
        return std::any_of(face.cloth_vertices.begin(), face.cloth_vertices.end(),
                           [this](VertexId v) { return contains(careful_at_, v); });
    };
    if (limit_ != StrainLimit::GivesWay ||
        std::any_of(event.before.begin(), event.before.end(), is_careful) ||
        !relaxations_.can_relax_by(scene_, make_patch(event), rise))
        return false;
    for (const PatchFace& face : event.before)
        relies_at_.insert(relies_at_.end(), face.cloth_vertices.begin(), face.cloth_vertices.end());
    return true;
}

std::vector<VertexId> MeshChangeGuard::relies_at() const
{
    std::vector<VertexId> vertices = relies_at_;
    sort_unique(vertices);
    return vertices;
}

MeshChangeGuard::Neighbourhood MeshChangeGuard::look_around(const SurgeryEvent& event) const
{
    std::vector<std::pair<VertexId, VertexRing>> found;  // ring after ring
    std::vector<VertexId> near, added;                   // ascending
    for (const PatchFace& face : event.before)
        added.insert(added.end(), face.vertices.begin(), face.vertices.end());
    for (int ring = 0; ring <= kPatchRings; ++ring) {
        sort_unique(added);
        std::erase_if(added, [&](VertexId v) { return contains(near, v); });
        const auto known = static_cast<std::ptrdiff_t>(near.size());
        near.insert(near.end(), added.begin(), added.end());
        std::inplace_merge(near.begin(), near.begin() + known, near.end());
        std::vector<VertexId> next;
        for (const VertexId v : added) {
            const VertexRing& around = found.emplace_back(v, surgery_->ring(v)).second;
            next.insert(next.end(), around.vertices.begin(), around.vertices.end());
        }
        added.swap(next);
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    Neighbourhood around;
    around.near = std::move(near);
    for (auto& [v, ring] : found) around.rings.push_back(std::move(ring));
    add_kept_faces(event, around);
    return around;
}

void MeshChangeGuard::add_kept_faces(const SurgeryEvent& event, Neighbourhood& around) const
{
    std::vector<IdFace> replaced, faces;
    for (const PatchFace& face : event.before) replaced.push_back(from_least(face.vertices));
    for (std::size_t i = 0; i < around.near.size(); ++i) {
        const VertexId v = around.near[i];
        const VertexRing& ring = around.rings[i];
        const std::size_t n = ring.vertices.size();
        for (std::size_t k = 0; k + (ring.is_closed ? 0 : 1) < n; ++k) {
            const IdFace face = {v, ring.vertices[k], ring.vertices[(k + 1) % n]};
            const bool is_first = v < face[1] && v < face[2];  // each face once
            if (is_first && contains(around.near, face[1]) && contains(around.near, face[2]) &&
                std::find(replaced.begin(), replaced.end(), face) == replaced.end())
                faces.push_back(face);
        }
    }
    std::sort(faces.begin(), faces.end());
    around.kept.reserve(faces.size());
    for (const IdFace& face : faces) around.kept.push_back(surgery_->patch_face(face));
}

LoosePatch MeshChangeGuard::make_patch(const SurgeryEvent& event) const
{
    const Neighbourhood around = look_around(event);
    LoosePatch patch;
    patch.creases.widths = crease_widths_;
    std::vector<int> local(around.near.size(), -1);
    const auto add = [&](const PatchFace& face) {
        Face made;
        for (int i = 0; i < 3; ++i) {
            const VertexId v = face.vertices[i];
            const auto at = find_place(around.near, v);
            if (local[at] < 0) {
                local[at] = patch.mesh.vertex_count();
                patch.mesh.material.push_back(face.material[i]);
                patch.mesh.world.push_back(face.world[i]);
                const bool is_free = is_loose(v, around.rings[at], around.near, event);
                patch.is_free.push_back(is_free);
                patch.normals.push_back(is_free ? find_kept_normal(scene_, state_, v) : Vec3(Vec3::Zero()));
            }
            made[i] = local[at];
        }
        patch.mesh.faces.push_back(made);
        for (int i = 0; i < 3; ++i)
            if (const int a = made[i], b = made[(i + 1) % 3];
                a < b && is_on_trace(*surgery_, event, face.vertices[i], face.vertices[(i + 1) % 3]))
                patch.creases.edges.push_back({a, b});
    };
    for (const PatchFace& face : event.after) add(face);
    for (const PatchFace& face : around.kept) add(face);
    std::sort(patch.creases.edges.begin(), patch.creases.edges.end());
    return patch;
}

bool MeshChangeGuard::is_loose(VertexId v, const VertexRing& ring, const std::vector<VertexId>& near,
                               const SurgeryEvent& event) const
{
    const bool is_changed = std::any_of(event.changes.begin(), event.changes.end(),
                                        [v](const VertexChange& change) { return change.vertex == v; });
    if (is_changed || !surgery_->has_vertex(v) || surgery_->is_fixed(v) || surgery_->is_on_seam(v) ||
        surgery_->role(v) != TraceRole::Free || is_stuck(state_, v))
        return false;
    return std::all_of(ring.vertices.begin(), ring.vertices.end(),
                       [&](VertexId w) { return contains(near, w); });
}

}  // namespace arris
