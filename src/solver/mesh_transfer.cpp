// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_transfer.h"

#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

#include "physics/energies.h"
#include "physics/velocity_fit.h"
#include "solver/eol_coordinates.h"
#include "solver/held_vertices.h"
#include "solver/patch_relaxation.h"

namespace arris {

namespace {

/// What one vertex carries; of BDF2's history too.
struct Carried {
    Vec2 X, V, previous_X, previous_V;
    Vec3 x, v, previous_x, previous_v;
};
using CarriedById = std::unordered_map<VertexId, Carried>;  // looked up only

Mat32 deformation(const std::array<Vec2, 3>& X, const std::array<Vec3, 3>& x)
{
    Mat2 DX;
    Mat32 Dx;
    DX << X[1] - X[0], X[2] - X[0];
    Dx << x[1] - x[0], x[2] - x[0];
    return Dx * DX.inverse();
}

Vec3 weights_of(const std::array<Vec2, 3>& X, const Vec2& place)
{
    const double area = twice_area(X[0], X[1], X[2]);
    const double second = twice_area(X[0], place, X[2]) / area, third = twice_area(X[0], X[1], place) / area;
    return {1.0 - second - third, second, third};
}

/// Position and material velocity of the surface at a material point of a face.
struct SurfaceSample {
    Vec3 x, v;
};

SurfaceSample sample(const std::array<Vec2, 3>& X, const std::array<Vec3, 3>& x, const std::array<Vec3, 3>& v,
                     const std::array<Vec2, 3>& V, const Vec2& place)
{
    const Mat32 F = deformation(X, x);
    const Vec3 weights = weights_of(X, place);
    SurfaceSample at{Vec3::Zero(), Vec3::Zero()};
    for (int i = 0; i < 3; ++i) {
        at.x += weights[i] * x[i];
        at.v += weights[i] * (v[i] - F * V[i]);
    }
    return at;
}

CarriedById read(const State& state)
{
    CarriedById all;
    for (std::size_t v = 0; v < state.ids.size(); ++v)
        all[state.ids[v]] = {state.mesh.material[v],     state.material_velocity[v],
                             state.previous_material[v], state.previous_material_velocity[v],
                             state.mesh.world[v],        state.velocity[v],
                             state.previous_world[v],    state.previous_velocity[v]};
    return all;
}

/// The vertex is of the material from now on: it has what the surface has there, now and a step ago.
void interpolate(const SurgeryEvent& event, const VertexChange& change, CarriedById& all)
{
    Carried made{};
    made.X = made.previous_X = change.new_material;
    made.x = change.new_world;
    made.V = made.previous_V = Vec2::Zero();
    made.v = made.previous_v = made.previous_x = Vec3::Zero();
    double count = 0.0;
    for (const PatchFace& face : event.before) {
        const auto is_of_face = [&](int i) {
            return change.weights[i] == 0.0 || std::find(face.vertices.begin(), face.vertices.end(),
                                                         change.parents[i]) != face.vertices.end();
        };
        if (!is_of_face(0) || !is_of_face(1) || !is_of_face(2)) continue;
        std::array<Vec2, 3> X, V, previous_X, previous_V;
        std::array<Vec3, 3> x, v, previous_x, previous_v;
        for (int i = 0; i < 3; ++i) {
            const Carried& corner = all.at(face.vertices[i]);
            X[i] = corner.X, V[i] = corner.V, x[i] = corner.x, v[i] = corner.v;
            previous_X[i] = corner.previous_X, previous_V[i] = corner.previous_V;
            previous_x[i] = corner.previous_x, previous_v[i] = corner.previous_v;
        }
        const SurfaceSample now = sample(X, x, v, V, made.X);
        const SurfaceSample then = sample(previous_X, previous_x, previous_v, previous_V, made.X);
        made.v += now.v;
        made.previous_x += then.x;
        made.previous_v += then.v;
        count += 1.0;
    }
    made.v /= count;
    made.previous_x /= count;
    made.previous_v /= count;
    all[change.vertex] = made;
}

/// A contact of an edge or face that was split, merged or flipped goes: it would hold the cloth where there
/// is none, for as long as its vertices are there.
void drop_contacts_without_element(State& state)
{
    constexpr std::uint32_t kNone = ActiveContact::kNoVertex;
    std::vector<char> is_named(state.ids.size(), 0);
    for (const ActiveContact& contact : state.active)
        for (const std::uint32_t id : contact.vertex_ids)
            if (const int v = id == kNone ? -1 : state.index_of(id); v >= 0) is_named[v] = 1;

    std::set<std::array<std::uint32_t, 3>> elements;
    for (std::size_t v = 0; v < state.ids.size(); ++v)
        if (is_named[v]) elements.insert({state.ids[v], kNone, kNone});
    for (const Face& face : state.mesh.faces) {
        if (is_named[face[0]] + is_named[face[1]] + is_named[face[2]] < 2) continue;
        std::array<std::uint32_t, 3> ids = {state.ids[face[0]], state.ids[face[1]], state.ids[face[2]]};
        std::sort(ids.begin(), ids.end());
        elements.insert({ids, {ids[0], ids[1], kNone}, {ids[1], ids[2], kNone}, {ids[0], ids[2], kNone}});
    }
    std::erase_if(state.active,
                  [&](const ActiveContact& contact) { return !elements.contains(contact.vertex_ids); });
}

State on_new_mesh(const State& before, const ConformedMesh& conformed, const CarriedById& all)
{
    State after = before;
    after.mesh = conformed.surgery.mesh;
    after.ids = conformed.surgery.ids;
    after.next_id = conformed.surgery.next_id;
    after.eol = conformed.eol;
    const std::size_t n = after.ids.size();
    after.velocity.resize(n);
    after.material_velocity.resize(n);
    after.previous_world.resize(n);
    after.previous_velocity.resize(n);
    after.previous_material.resize(n);
    after.previous_material_velocity.resize(n);
    for (std::size_t v = 0; v < n; ++v) {
        const Carried& carried = all.at(after.ids[v]);
        after.velocity[v] = carried.v;
        after.material_velocity[v] = carried.V;
        after.previous_world[v] = carried.previous_x;
        after.previous_velocity[v] = carried.previous_v;
        after.previous_material[v] = carried.previous_X;
        after.previous_material_velocity[v] = carried.previous_V;
    }
    std::erase_if(after.anchors, [&](const PinAnchor& a) { return after.index_of(a.vertex_id) < 0; });
    drop_contacts_without_element(after);
    return after;
}

using FaceIds = std::array<VertexId, 3>;

FaceIds ids_of(const State& state, const Face& face)
{
    FaceIds ids = {state.ids[face[0]], state.ids[face[1]], state.ids[face[2]]};
    std::rotate(ids.begin(), std::min_element(ids.begin(), ids.end()), ids.end());
    return ids;
}

/// Fits the velocity where the mesh, or what its vertices are, has changed.
class PatchFitter {
  public:
    PatchFitter(const Scene& scene, const State& before, State& after)
        : scene_(scene), before_(before), after_(after), stars_(make_stars_of(after))
    {
    }

    TransferReport run()
    {
        TransferReport report;
        find_patch();
        for (int p = 0; p < patch_count_; ++p) {
            const std::vector<Face> then = old_faces(p);
            const double gain = relax_patch(p, then);
            frames_.clear();
            const std::optional<VelocityFit> fit = fit_patch(p, then);
            report.is_strained = report.is_strained || gain > 0.01 * ((fit ? fit->energy : 0.0) + weight(p));
            if (!fit) continue;
            ++report.patches;
            report.energy_gain += fit->energy_gain;
        }
        return report;
    }

  private:
    static ClothStars make_stars_of(const State& state)
    {
        const MeshTopology topology = make_topology(state.mesh.vertex_count(), state.mesh.faces);
        return make_stars(state.mesh.vertex_count(), state.mesh.faces, topology.edges);
    }

    bool is_eol_changed(int v) const
    {
        const std::uint32_t id = after_.ids[v];
        const int now = after_.eol_entry(id), then = before_.eol_entry(id);
        if ((now < 0) != (then < 0)) return true;
        return now >= 0 && std::tuple(after_.eol[now].obstacle, after_.eol[now].is_corner) !=
                               std::tuple(before_.eol[then].obstacle, before_.eol[then].is_corner);
    }

    /// Faces that were there before, at the same place in the material, with the same vertices.
    std::vector<char> find_kept() const
    {
        std::map<FaceIds, int> old;
        for (std::size_t f = 0; f < before_.mesh.faces.size(); ++f)
            old[ids_of(before_, before_.mesh.faces[f])] = static_cast<int>(f);
        std::vector<char> is_kept;
        for (const Face& face : after_.mesh.faces) {
            const bool is_same =
                old.contains(ids_of(after_, face)) && std::all_of(face.begin(), face.end(), [&](int v) {
                    const int then = before_.index_of(after_.ids[v]);
                    return !is_eol_changed(v) && before_.mesh.material[then] == after_.mesh.material[v];
                });
            is_kept.push_back(is_same);
        }
        return is_kept;
    }

    /// Labels the faces of each patch: what has changed and two rings around it.
    void find_patch()
    {
        constexpr int kRings = 2;
        const std::vector<char> is_kept = find_kept();
        std::vector<char> is_near(after_.ids.size(), 0);
        for (std::size_t f = 0; f < is_kept.size(); ++f)
            if (!is_kept[f])
                for (const int v : after_.mesh.faces[f]) is_near[v] = 1;
        for (int ring = 0; ring < kRings; ++ring) {
            std::vector<char> grown = is_near;
            for (const Face& face : after_.mesh.faces)
                if (is_near[face[0]] || is_near[face[1]] || is_near[face[2]])
                    for (const int v : face) grown[v] = 1;
            is_near = grown;
        }
        // Faces all of whose vertices are near, joined where they share one.
        patch_.assign(after_.mesh.faces.size(), -1);
        std::vector<char> is_in(patch_.size(), 0);
        for (std::size_t f = 0; f < patch_.size(); ++f) {
            const Face& face = after_.mesh.faces[f];
            is_in[f] = is_near[face[0]] && is_near[face[1]] && is_near[face[2]];
        }
        for (std::size_t f = 0; f < patch_.size(); ++f) {
            if (!is_in[f] || patch_[f] >= 0) continue;
            std::vector<int> open = {static_cast<int>(f)};
            patch_[f] = patch_count_;
            while (!open.empty()) {
                const int g = open.back();
                open.pop_back();
                for (const int v : after_.mesh.faces[g])
                    for (const int h : stars_.faces[v]) {
                        if (!is_in[h] || patch_[h] >= 0) continue;
                        patch_[h] = patch_count_;
                        open.push_back(h);
                    }
            }
            ++patch_count_;
        }
    }

    /// The old faces that cover what patch p covers: those that are not outside.
    std::vector<Face> old_faces(int p) const
    {
        std::map<FaceIds, int> outside;
        for (std::size_t f = 0; f < patch_.size(); ++f)
            if (patch_[f] < 0) outside[ids_of(after_, after_.mesh.faces[f])] = 1;
        const std::vector<Vec2>& X = before_.mesh.material;
        std::vector<Face> faces;
        for (const Face& face : before_.mesh.faces)
            if (!outside.contains(ids_of(before_, face)) &&
                find_patch_of((X[face[0]] + X[face[1]] + X[face[2]]) / 3.0) == p)
                faces.push_back(face);
        return faces;
    }

    VelocityField old_field(const std::vector<Face>& faces) const
    {
        VelocityField field;
        for (const Face& face : faces) {
            std::array<Vec2, 3> X;
            std::array<Vec3, 3> x, w;
            for (int i = 0; i < 3; ++i) {
                X[i] = before_.mesh.material[face[i]];
                x[i] = before_.mesh.world[face[i]];
            }
            const Mat32 F = deformation(X, x);
            for (int i = 0; i < 3; ++i)
                w[i] = before_.velocity[face[i]] - F * before_.material_velocity[face[i]];
            field.triangles.push_back(X);
            field.velocity.push_back(w);
        }
        return field;
    }

    /// -1 where it is in none.
    int find_patch_of(const Vec2& X) const
    {
        if (patch_count_ == 1) return 0;
        for (std::size_t f = 0; f < patch_.size(); ++f) {
            if (patch_[f] < 0) continue;
            const Face& face = after_.mesh.faces[f];
            const Vec3 weights = weights_of(
                {after_.mesh.material[face[0]], after_.mesh.material[face[1]], after_.mesh.material[face[2]]},
                X);
            if (weights.minCoeff() >= -1e-9) return patch_[f];
        }
        return -1;
    }

    /// Elastic energy of those faces of a mesh; hinges between them only.
    double elastic_energy(const ClothMesh& whole, const std::vector<Face>& faces) const
    {
        ClothMesh mesh;
        std::unordered_map<int, int> local;
        for (const Face& face : faces) {
            Face made;
            for (int i = 0; i < 3; ++i) {
                const auto [at, is_new] = local.try_emplace(face[i], mesh.vertex_count());
                if (is_new) {
                    mesh.material.push_back(whole.material[face[i]]);
                    mesh.world.push_back(whole.world[face[i]]);
                }
                made[i] = at->second;
            }
            mesh.faces.push_back(made);
        }
        const MeshTopology topology = make_topology(mesh.vertex_count(), mesh.faces);
        const Terms terms = make_terms(scene_.material, {}, {}, {});
        const Energies energies = compute_energies(make_elements(mesh, topology), terms, mesh.world);
        return energies.stretch + energies.bending;
    }

    /// A mesh that strains the cloth more than the one before gives way.
    /// Returns by how much its elastic energy is above what it was, J.
    double relax_patch(int p, const std::vector<Face>& then)
    {
        RelaxedPatch patch;
        std::vector<Face> now;
        for (std::size_t f = 0; f < patch_.size(); ++f)
            if (patch_[f] == p) {
                patch.faces.push_back(static_cast<int>(f));
                now.push_back(after_.mesh.faces[f]);
            }
        patch.wanted = elastic_energy(before_.mesh, then);
        const double strained = elastic_energy(after_.mesh, now);
        constexpr double kRounding = 1e-9;  // of sums over the patch: a split leaves the energy as it is
        if (strained <= (1.0 + kRounding) * patch.wanted) return 0.0;

        const std::size_t n = after_.ids.size();
        patch.is_free.assign(n, 0);
        patch.normals.assign(n, Vec3::Zero());
        for (std::size_t v = 0; v < n; ++v)
            patch.is_free[v] = after_.eol_entry(after_.ids[v]) < 0 &&
                               std::all_of(stars_.faces[v].begin(), stars_.faces[v].end(),
                                           [&](int f) { return patch_[f] == p; });
        for (const HeldVertex& held : find_held_vertices(scene_, after_, after_.time))
            patch.is_free[held.vertex] = 0;
        for (const ActiveContact& contact : after_.active)
            if (contact.kind == ContactKind::Vertex)
                patch.normals[after_.index_of(contact.vertex_ids[0])] =
                    scene_.obstacles[contact.obstacle].at(after_.time).rotation * contact.normal;
        return relax(scene_, patch, after_) - patch.wanted;
    }

    /// Of a patch, over a cell, J.
    double weight(int p) const
    {
        double area = 0.0, length = 0.0;
        for (std::size_t f = 0; f < patch_.size(); ++f) {
            if (patch_[f] != p) continue;
            const Face& face = after_.mesh.faces[f];
            const Vec2& X = after_.mesh.material[face[0]];
            area += 0.5 * twice_area(X, after_.mesh.material[face[1]], after_.mesh.material[face[2]]);
            length = std::max(length, scene_.eol->length(X));
        }
        return scene_.gravity ? scene_.material.density * area * scene_.gravity->acceleration.norm() * length
                              : 0.0;
    }

    std::optional<VelocityFit> fit_patch(int p, const std::vector<Face>& then)
    {
        std::vector<int> vertices;
        for (std::size_t f = 0; f < patch_.size(); ++f)
            if (patch_[f] == p)
                vertices.insert(vertices.end(), after_.mesh.faces[f].begin(), after_.mesh.faces[f].end());
        std::sort(vertices.begin(), vertices.end());
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());

        FitPatch patch;
        std::unordered_map<int, int> local;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            local[vertices[i]] = static_cast<int>(i);
            add_vertex(vertices[i], p, patch);
        }
        for (std::size_t f = 0; f < patch_.size(); ++f) {
            if (patch_[f] != p) continue;
            const Face& face = after_.mesh.faces[f];
            patch.faces.push_back({local[face[0]], local[face[1]], local[face[2]]});
        }
        const std::optional<VelocityFit> fit = fit_velocity(scene_.material.density, old_field(then), patch);
        if (!fit) return fit;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            after_.velocity[vertices[i]] = fit->velocity[i];
            after_.material_velocity[vertices[i]] = fit->material_velocity[i];
        }
        return fit;
    }

    void add_vertex(int v, int p, FitPatch& patch)
    {
        const bool is_inside = std::all_of(stars_.faces[v].begin(), stars_.faces[v].end(),
                                           [&](int f) { return patch_[f] == p; });
        patch.material.push_back(after_.mesh.material[v]);
        patch.world.push_back(after_.mesh.world[v]);
        patch.is_free.push_back(is_inside);
        Vec3 drift = Vec3::Zero();
        Vec2 material_drift = Vec2::Zero();
        Mat3 basis = Mat3::Identity();
        Mat23 material_basis = Mat23::Zero();
        if (!is_inside) {
            drift = after_.velocity[v];
            material_drift = after_.material_velocity[v];
        } else if (const int entry = after_.eol_entry(after_.ids[v]); entry >= 0) {
            const std::int32_t o = after_.eol[entry].obstacle;
            const Obstacle& obstacle = scene_.obstacles[o];
            const Placement now = obstacle.at(after_.time);
            auto [positions, is_new] = frames_.try_emplace(o);
            if (is_new) positions->second = to_frame(now, after_.mesh.world);
            const EolPlacing placing =
                place_eol_vertex(obstacle, after_, entry, stars_, positions->second, now);
            if (placing.coordinates) {
                basis = placing.coordinates->basis;
                material_basis = placing.coordinates->material_basis;
                drift = obstacle.velocity_after(after_.time, after_.mesh.world[v]);
            }
        }
        patch.drift.push_back(drift);
        patch.material_drift.push_back(material_drift);
        patch.basis.push_back(basis);
        patch.material_basis.push_back(material_basis);
    }

    const Scene& scene_;
    const State& before_;
    State& after_;
    ClothStars stars_;
    std::map<std::int32_t, std::vector<Vec3>> frames_;  ///< positions in the frame of an obstacle
    std::vector<int> patch_;                            ///< of each new face; -1 outside
    int patch_count_ = 0;
};

/// A vertex that is EOL from now on has moved so far as it moves now.
void begin_history(const State& before, State& after)
{
    for (const EolVertex& eol : after.eol) {
        if (before.eol_entry(eol.vertex_id) >= 0) continue;
        const int v = after.index_of(eol.vertex_id);
        after.previous_world[v] = after.mesh.world[v] - after.previous_dt * after.velocity[v];
        after.previous_material[v] = after.mesh.material[v] - after.previous_dt * after.material_velocity[v];
        after.previous_velocity[v] = after.velocity[v];
        after.previous_material_velocity[v] = after.material_velocity[v];
    }
    for (const EolVertex& eol : before.eol) {
        const int v = after.index_of(eol.vertex_id);
        if (v < 0 || after.eol_entry(eol.vertex_id) >= 0) continue;
        after.previous_world[v] = after.mesh.world[v] - after.previous_dt * after.velocity[v];
        after.previous_material[v] = after.mesh.material[v];
        after.previous_velocity[v] = after.velocity[v];
        after.previous_material_velocity[v].setZero();
    }
}

}  // namespace

State transfer(const Scene& scene, const State& before, const ConformedMesh& conformed,
               TransferReport& report)
{
    CarriedById all = read(before);
    for (const SurgeryEvent& event : conformed.events)
        for (const VertexChange& change : event.changes)
            if (event.operation != SurgeryOperation::Collapse) interpolate(event, change, all);
    State after = on_new_mesh(before, conformed, all);
    for (const EolVertex& eol : before.eol)
        if (const int v = after.index_of(eol.vertex_id); v >= 0 && after.eol_entry(eol.vertex_id) < 0)
            after.material_velocity[v].setZero();
    report = PatchFitter(scene, before, after).run();
    begin_history(before, after);
    return after;
}

}  // namespace arris
