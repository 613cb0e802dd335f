// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/mesh_transfer.h"

#include <algorithm>
#include <cassert>
#include <unordered_map>

#include "geometry/cloth/mesh_topology.h"
#include "physics/elements/deformation_gradient.h"
#include "solver/eol/stop_flow.h"
#include "solver/mesh_change/changed_patches.h"

namespace arris {

namespace {

/// State of one point of the material and its vertex, with its history for BDF2.
struct Carried {
    Vec2 X, V, previous_X, previous_V;
    Vec3 x, v, previous_x, previous_v;
};

Carried read(const State& state, int point)
{
    const int v = state.mesh.vertex_of(point);
    return {state.mesh.material[point],
            state.material_velocity[point],
            state.previous_material[point],
            state.previous_material_velocity[point],
            state.mesh.world[v],
            state.velocity[v],
            state.previous_world[v],
            state.previous_velocity[v]};
}

/// States by id of the point: changed by surgery, else as before.
class CarriedById {
  public:
    explicit CarriedById(const State& before) : before_(before) {}

    Carried at(VertexId id) const
    {
        const auto found = changed_.find(id);
        return found != changed_.end() ? found->second : read(before_, before_.point_with(id));
    }
    const std::unordered_map<VertexId, Carried>& changed() const { return changed_; }
    bool has_changed(VertexId id) const { return changed_.contains(id); }
    void set(VertexId id, const Carried& carried) { changed_.insert_or_assign(id, carried); }

  private:
    const State& before_;
    std::unordered_map<VertexId, Carried> changed_;
};

Vec3 weights_of(const std::array<Vec2, 3>& X, const Vec2& place)
{
    const double area = twice_area(X[0], X[1], X[2]);
    const double second = twice_area(X[0], place, X[2]) / area, third = twice_area(X[0], X[1], place) / area;
    return {1.0 - second - third, second, third};
}

/// Position, and velocity of the material, at a material point of a face.
struct SurfaceSample {
    Vec3 x, v;
};

SurfaceSample sample(const std::array<Vec2, 3>& X, const std::array<Vec3, 3>& x, const std::array<Vec3, 3>& v,
                     const std::array<Vec2, 3>& V, const Vec2& place)
{
    const Mat32 F = deformation_gradient(X, x);
    const Vec3 weights = weights_of(X, place);
    SurfaceSample at{Vec3::Zero(), Vec3::Zero()};
    for (int i = 0; i < 3; ++i) {
        at.x += weights[i] * x[i];
        at.v += weights[i] * (v[i] - F * V[i]);
    }
    return at;
}

/// Whether a material point was in a face or near enough to extend the face's plane. False where the material
/// has flowed so that the corners did not form a face one step ago: the plane of a degenerate face is
/// arbitrary.
bool is_near(const std::array<Vec2, 3>& X, const Vec2& place)
{
    constexpr double kMostWeights = 3.0;  // sum of |weights|, 1 inside: amplification of the corners' values
    return twice_area(X[0], X[1], X[2]) > 0.0 && weights_of(X, place).lpNorm<1>() <= kMostWeights;
}

/// Makes the vertex Lagrangian, with the surface's state there, now and a step of `dt` (s) ago. Where the old
/// state is unknown, the vertex is taken to have moved at its current velocity.
void interpolate(const SurgeryEvent& event, const VertexChange& change, double dt, CarriedById& all)
{
    Carried made{};
    made.X = made.previous_X = change.new_material;
    made.x = change.new_world;
    made.V = made.previous_V = Vec2::Zero();
    made.v = made.previous_v = made.previous_x = Vec3::Zero();
    double count = 0.0, previous_count = 0.0;
    for (const PatchFace& face : event.before) {
        const auto is_of_face = [&](int i) {
            return change.weights[i] == 0.0 || std::find(face.vertices.begin(), face.vertices.end(),
                                                         change.parents[i]) != face.vertices.end();
        };
        if (!is_of_face(0) || !is_of_face(1) || !is_of_face(2)) continue;
        std::array<Vec2, 3> X, V, previous_X, previous_V;
        std::array<Vec3, 3> x, v, previous_x, previous_v;
        for (int i = 0; i < 3; ++i) {
            const Carried corner = all.at(face.vertices[i]);
            X[i] = corner.X, V[i] = corner.V, x[i] = corner.x, v[i] = corner.v;
            previous_X[i] = corner.previous_X, previous_V[i] = corner.previous_V;
            previous_x[i] = corner.previous_x, previous_v[i] = corner.previous_v;
        }
        const SurfaceSample now = sample(X, x, v, V, made.X);
        made.v += now.v;
        count += 1.0;
        if (!is_near(previous_X, made.X)) continue;
        const SurfaceSample then = sample(previous_X, previous_x, previous_v, previous_V, made.X);
        made.previous_x += then.x;
        made.previous_v += then.v;
        previous_count += 1.0;
    }
    made.v /= count;
    made.previous_x =
        previous_count > 0.0 ? Vec3(made.previous_x / previous_count) : Vec3(made.x - dt * made.v);
    made.previous_v = previous_count > 0.0 ? Vec3(made.previous_v / previous_count) : made.v;
    all.set(change.vertex, made);
}

/// Drops contacts of edges or faces that were split, merged or flipped. Such a contact would hold cloth where
/// none is, as long as its vertices exist.
void drop_contacts_without_element(const ClothStars& stars, State& state)
{
    const auto has_element = [&](const ActiveContact& contact) {
        const auto is_there = [&](std::uint32_t id) {
            return id == ContactVertexIds::kNoVertex || state.index_of(id) >= 0;
        };
        if (contact.obstacle == kClothItself || contact.kind == ContactKind::Vertex)
            return std::all_of(contact.vertex_ids.begin(), contact.vertex_ids.end(), is_there);
        const auto has_corner = [&](const Face& face, std::uint32_t id) {
            return std::any_of(face.begin(), face.end(), [&](int v) { return state.ids[v] == id; });
        };
        const int first = state.index_of(contact.vertex_ids[0]);
        if (first < 0) return false;
        const std::span<const int> around = stars.faces[first];
        return std::any_of(around.begin(), around.end(), [&](int f) {
            return std::all_of(contact.vertex_ids.begin(), contact.vertex_ids.end(), [&](std::uint32_t id) {
                return id == ContactVertexIds::kNoVertex || has_corner(state.mesh.faces[f], id);
            });
        });
    };
    std::erase_if(state.active, [&](const ActiveContact& contact) { return !has_element(contact); });
}

State on_new_mesh(const State& before, const ConformedMesh& conformed, const CarriedById& all)
{
    State after;
    after.time = before.time;
    after.step = before.step;
    after.mesh = conformed.surgery.mesh;
    after.ids = conformed.surgery.ids;
    after.seam_ids = conformed.surgery.seam_ids;
    after.next_id = conformed.surgery.next_id;
    after.previous_dt = before.previous_dt;
    after.eol = conformed.eol;
    after.anchors = before.anchors;
    after.active = before.active;
    if (after.mesh.faces == before.mesh.faces) after.coupled = before.coupled;
    after.sizing_field = before.sizing_field;
    after.refused_edges = before.refused_edges;
    after.seam_pairs = before.seam_pairs;
    after.closing = before.closing;
    after.sewn_at = before.sewn_at;
    after.sewn_energy = before.sewn_energy;
    after.crossings = before.crossings;
    const std::size_t n = after.ids.size();
    after.velocity.resize(n);
    after.material_velocity.resize(after.mesh.material.size());
    after.previous_world.resize(n);
    after.previous_velocity.resize(n);
    after.previous_material.resize(after.mesh.material.size());
    after.previous_material_velocity.resize(after.mesh.material.size());
    const auto write_point = [&](std::size_t p, const Carried& carried) {
        after.material_velocity[p] = carried.V;
        after.previous_material[p] = carried.previous_X;
        after.previous_material_velocity[p] = carried.previous_V;
    };
    const auto write = [&](std::size_t v, const Carried& carried) {
        after.velocity[v] = carried.v;
        after.previous_world[v] = carried.previous_x;
        after.previous_velocity[v] = carried.previous_v;
        write_point(v, carried);
    };
    for (std::size_t v = 0, then = 0; v < n; ++v) {
        while (then < before.ids.size() && before.ids[then] < after.ids[v]) ++then;
        if (then < before.ids.size() && before.ids[then] == after.ids[v])
            write(v, read(before, static_cast<int>(then)));
        else
            assert(all.has_changed(after.ids[v]) && "what is new has been carried over");
    }
    for (const auto& [id, carried] : all.changed())  // any order: each vertex has its own entry
        if (const int v = after.index_of(id); v >= 0) write(static_cast<std::size_t>(v), carried);
    for (std::size_t k = 0; k < after.seam_ids.size(); ++k) write_point(n + k, all.at(after.seam_ids[k]));
    std::erase_if(after.anchors, [&](const PinAnchor& a) { return after.index_of(a.vertex_id) < 0; });
    return after;
}

}  // namespace

State transfer(const Scene& scene, const State& before, const ClothStars& stars,
               const ConformedMesh& conformed, const ClothStars& stars_after, TransferReport& report,
               double most_strain)
{
    CarriedById all(before);
    for (const SurgeryEvent& event : conformed.events)
        for (const VertexChange& change : event.changes)
            if (event.operation != SurgeryOperation::Collapse)
                interpolate(event, change, before.previous_dt, all);
    State after = on_new_mesh(before, conformed, all);
    drop_contacts_without_element(stars_after, after);
    const std::vector<ChangedPatch> patches =
        find_changed_patches({before, after, conformed.events, stars.faces, stars_after.faces});
    report = fit_patches(scene, before, stars, patches, stars_after, most_strain, after);
    if (report.strain > most_strain) return after;  // the caller discards it
    // Whether a vertex can have coordinates depends on its flow, which the fit has changed.
    settle_flow(scene, before, stars_after, after);
    return after;
}

}  // namespace arris
