// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/patch_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/sort_unique.h"
#include "physics/elements/deformation_gradient.h"
#include "physics/system/velocity_fit.h"
#include "solver/eol/eol_coordinates.h"
#include "solver/mesh_change/patch_relaxation.h"
#include "solver/mesh_change/strain_allowance.h"
#include "solver/model/pin_targets.h"
#include "solver/model/target_length.h"

namespace arris {

namespace {

class PatchFitter {
  public:
    PatchFitter(const Scene& scene, const State& before, const ClothStars& stars_before,
                const ClothStars& stars, State& after)
        : scene_(scene),
          before_(before),
          stars_(stars),
          after_(after),
          placer_(scene.obstacles, scene.materials.thickness(), after, stars),
          held_(find_pin_targets(scene, after, after.time)),
          creases_before_(find_creases(scene, before, stars_before)),
          creases_(find_creases(scene, after, stars))
    {
    }

    TransferReport run(const std::vector<ChangedPatch>& patches, double most_strain)
    {
        TransferReport report;
        std::vector<VelocityField> fields;
        for (const ChangedPatch& patch : patches)
            fields.push_back(old_field(patch.faces_before, before_.velocity, before_.material_velocity));
        double gained = 0.0;
        for (const StrainedPatch& strained : find_strained(patches, fields)) {
            const ChangedPatch& patch = patches[strained.index];
            const double gain = relax_patch(patch, strained.energy_before);
            if (!(gain > 0.0)) continue;
            gained += gain;
            const double small = std::min(report.strain, kPatchStrain);
            const double strain = strain_of(patch, gain, strained, small);
            if (strain > kPatchStrain) report.strained.push_back(vertices_before(patch));
            report.strain = std::max(report.strain, strain);
            if (report.strain > most_strain) return report;
        }
        if (gained > 0.0) report.cloth_strain = gained / moving_energy_of_cloth();
        for (std::size_t i = 0; i < patches.size(); ++i) fit_patch(patches[i], fields[i]);
        return report;
    }

  private:
    /// A patch with more energy than before; energies in J.
    struct StrainedPatch {
        std::size_t index;
        double energy_before, kinetic;
        double strain_bound;  ///< upper bound of its strain, without looking up target lengths
    };

    /// Strained patches, the most strained first, so that an unusable mesh is found early.
    std::vector<StrainedPatch> find_strained(const std::vector<ChangedPatch>& patches,
                                             const std::vector<VelocityField>& fields) const
    {
        std::vector<StrainedPatch> strained;
        for (std::size_t i = 0; i < patches.size(); ++i) {
            const ChangedPatch& patch = patches[i];
            const double before =
                find_patch_energy(scene_, creases_before_, before_.mesh, patch.faces_before);
            const double gain = find_patch_energy(scene_, creases_, after_.mesh, patch.faces) - before;
            if (!(gain > 0.0)) continue;
            const double kinetic = compute_kinetic_energy(scene_.materials, fields[i]);
            const double bound = gain / moving_energy(before, kinetic, heft_of(after_.mesh, patch.faces),
                                                      shortest_cell(scene_));
            strained.push_back({i, before, kinetic, bound});
        }
        std::stable_sort(
            strained.begin(), strained.end(),
            [](const StrainedPatch& a, const StrainedPatch& b) { return a.strain_bound > b.strain_bound; });
        return strained;
    }

    VelocityField old_field(const std::vector<int>& faces, const std::vector<Vec3>& velocity,
                            const std::vector<Vec2>& flow) const
    {
        VelocityField field;
        for (const int f : faces) {
            const Face& face = before_.mesh.faces[f];
            const std::array<Vec2, 3> X = before_.mesh.corners(f);
            std::array<Vec3, 3> x, w;
            for (int i = 0; i < 3; ++i) x[i] = before_.mesh.world[face[i]];
            const Mat32 F = deformation_gradient(X, x);
            const Face& points = before_.mesh.points_of(f);
            for (int i = 0; i < 3; ++i) w[i] = velocity[face[i]] - F * flow[points[i]];
            field.triangles.push_back(X);
            field.velocity.push_back(w);
        }
        return field;
    }

    /// Lets a patch give way where its new mesh strains the cloth. `before`: its energy on the old mesh, J.
    /// Returns the energy above `before`, J.
    double relax_patch(const ChangedPatch& patch, double before)
    {
        relaxed_.faces = patch.faces;
        relaxed_.is_free.resize(after_.ids.size());
        relaxed_.normals.resize(after_.ids.size());
        relaxed_.wanted = before;
        for (std::size_t i = 0; i < patch.vertices.size(); ++i) {
            const int v = patch.vertices[i];
            const std::uint32_t id = after_.ids[v];
            relaxed_.is_free[v] = after_.eol_entry(id) < 0 && patch.is_inside[i] && !is_stuck(after_, id);
        }
        for (const PinTarget& held : held_) relaxed_.is_free[held.vertex] = 0;
        for (const int v : patch.vertices)
            relaxed_.normals[v] =
                relaxed_.is_free[v] ? find_kept_normal(scene_, after_, after_.ids[v]) : Vec3(Vec3::Zero());
        return relax(scene_, creases_, relaxed_, after_) - before;
    }

    Heft heft_of(const ClothMesh& mesh, const std::vector<int>& faces) const
    {
        Heft heft;
        for (const int f : faces) {
            const std::array<Vec2, 3> X = mesh.corners(f);
            heft.add(scene_.materials.at(X[0]), 0.5 * twice_area(X));
        }
        return heft;
    }

    /// Energy that moves a patch, J: its kinetic energy plus the work of its weight when it falls by one
    /// cell's length, or plus its elastic energy (`before`) where nothing has weight. At least what is
    /// invisible.
    double moving_energy(double before, double kinetic, const Heft& heft, double cell) const
    {
        const double potential = scene_.gravity ? weight_over(scene_, heft, cell) : before;
        return kinetic + potential + unseen_energy(heft) / kAllowedStrain;
    }

    /// Energy that moves the whole cloth, J: its kinetic energy, plus the work of its weight over its mean
    /// cell or its elastic energy, whichever is greater. A change that is small beside the energy of taut
    /// cloth is not seen, however slowly the cloth moves.
    double moving_energy_of_cloth() const
    {
        std::vector<int> faces(before_.mesh.faces.size());
        std::iota(faces.begin(), faces.end(), 0);
        const VelocityField field = old_field(faces, before_.velocity, before_.material_velocity);
        const double elastic = find_energies(scene_, creases_before_, before_.mesh).elastic();
        double area = 0.0, length = 0.0;  // length: weighted by area
        for (const int f : faces) {
            const std::array<Vec2, 3> X = before_.mesh.corners(f);
            const double part = 0.5 * twice_area(X);
            area += part;
            length += part * target_length(scene_, before_, X[0]);
        }
        const double kinetic = compute_kinetic_energy(scene_.materials, field);
        return std::max(moving_energy(elastic, kinetic, heft_of(before_.mesh, faces), length / area),
                        kinetic + elastic);
    }

    std::vector<VertexId> vertices_before(const ChangedPatch& patch) const
    {
        std::vector<VertexId> ids;
        for (const int f : patch.faces_before)
            for (const int v : before_.mesh.faces[f]) ids.push_back(before_.ids[v]);
        sort_unique(ids);
        return ids;
    }

    /// Strain: `gain` relative to the patch's moving energy, over its longest cell. Returns only an upper
    /// bound where that is at most `small`.
    double strain_of(const ChangedPatch& patch, double gain, const StrainedPatch& strained,
                     double small) const
    {
        const Heft heft = heft_of(after_.mesh, patch.faces);
        const auto strain = [&](double cell) {
            return gain / moving_energy(strained.energy_before, strained.kinetic, heft, cell);
        };
        const double bound = strain(shortest_cell(scene_));
        if (!(bound > small)) return bound;
        double cell = 0.0;
        int last = -1;
        for (const int f : patch.faces)
            if (const int v = after_.mesh.faces[f][0]; v != last)
                cell = std::max(cell, target_length(scene_, after_, after_.mesh.material[last = v]));
        return strain(cell);
    }

    void fit_patch(const ChangedPatch& changed, const VelocityField& old)
    {
        FitPatch patch;
        local_.resize(after_.mesh.material.size());
        for (std::size_t i = 0; i < changed.vertices.size(); ++i) {
            local_[changed.vertices[i]] = static_cast<int>(i);
            add_vertex(changed.vertices[i], changed.is_inside[i], patch);
        }
        for (const int v : changed.vertices)
            for (int p = stars_.next_point(v); p >= 0; p = stars_.next_point(p)) add_point(v, p, patch);
        for (const int f : changed.faces) {
            const Face& face = after_.mesh.faces[f];
            patch.faces.push_back({local_[face[0]], local_[face[1]], local_[face[2]]});
            patch.triangles.push_back(after_.mesh.corners(f));
            if (patch.seam_vertices.empty()) continue;
            const auto& [p, q, r] = after_.mesh.points_of(f);
            patch.points.push_back({local_[p], local_[q], local_[r]});
        }
        if (const std::optional<VelocityFit> fit = fit_velocity(scene_.materials, old, patch))
            for (std::size_t i = 0; i < changed.vertices.size(); ++i) {
                const int v = changed.vertices[i];
                after_.velocity[v] = fit->velocity[i];
                for (int p = v; p >= 0; p = stars_.next_point(p))
                    after_.material_velocity[p] = fit->material_velocity[local_[p]];
            }
        if (is_free_of_eol(changed)) fit_history(changed, std::move(patch));
    }

    /// Whether no material has flowed through the patch lately.
    bool is_free_of_eol(const ChangedPatch& changed) const
    {
        const auto is_still = [](const State& state, int v) {
            return state.eol_entry(state.ids[v]) < 0 && state.previous_material_velocity[v].isZero(0.0);
        };
        return std::all_of(changed.vertices.begin(), changed.vertices.end(),
                           [&](int v) { return is_still(after_, v); }) &&
               std::all_of(changed.faces_before.begin(), changed.faces_before.end(), [&](int f) {
                   const Face& face = before_.mesh.faces[f];
                   return std::all_of(face.begin(), face.end(), [&](int v) { return is_still(before_, v); });
               });
    }

    /// Fits BDF2's velocity of one step ago, too: its momentum enters the step's. Beside EOL vertices, whose
    /// features give and take momentum, the surface's velocity there stands.
    void fit_history(const ChangedPatch& changed, FitPatch patch)
    {
        if (!(before_.previous_dt > 0.0)) return;
        for (std::size_t i = 0; i < changed.vertices.size(); ++i)
            patch.drift[i] =
                patch.is_free[i] ? Vec3(Vec3::Zero()) : after_.previous_velocity[changed.vertices[i]];
        const VelocityField old =
            old_field(changed.faces_before, before_.previous_velocity, before_.previous_material_velocity);
        const std::optional<VelocityFit> fit = fit_velocity(scene_.materials, old, patch);
        if (!fit) return;
        for (std::size_t i = 0; i < changed.vertices.size(); ++i)
            after_.previous_velocity[changed.vertices[i]] = fit->velocity[i];
    }

    void add_vertex(int v, bool is_inside, FitPatch& patch)
    {
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
            if (const EolPlacing placing = placer_.place(entry); placing.coordinates) {
                const MovingObstacle& obstacle = scene_.obstacles[after_.eol[entry].on.obstacle];
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

    /// Adds a further point of a vertex that is in the patch.
    void add_point(int v, int point, FitPatch& patch)
    {
        const int i = local_[v];
        local_[point] = static_cast<int>(patch.material_drift.size());
        patch.seam_vertices.push_back(i);
        const Mat2 turn = find_turn(after_.mesh, stars_, point);
        patch.material_drift.push_back(turn * patch.material_drift[i]);
        patch.material_basis.push_back(turn * patch.material_basis[i]);
    }

    const Scene& scene_;
    const State& before_;
    const ClothStars& stars_;  ///< of `after_`
    State& after_;
    EolPlacer placer_;
    std::vector<PinTarget> held_;
    Creases creases_before_, creases_;
    // Entries of vertices outside the current patch are meaningless.
    RelaxedPatch relaxed_;
    std::vector<int> local_;  ///< place in the patch of each vertex, and of further points
};

}  // namespace

TransferReport fit_patches(const Scene& scene, const State& before, const ClothStars& stars_before,
                           const std::vector<ChangedPatch>& patches, const ClothStars& stars,
                           double most_strain, State& after)
{
    return PatchFitter(scene, before, stars_before, stars, after).run(patches, most_strain);
}

}  // namespace arris
