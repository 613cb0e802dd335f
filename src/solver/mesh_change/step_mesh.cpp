// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/step_mesh.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "geometry/self_contact/self_intersection.h"
#include "geometry/sort_unique.h"
#include "physics/forces/make_terms.h"
#include "physics/forces/membrane.h"
#include "solver/eol/creases.h"
#include "solver/eol/stop_flow.h"
#include "solver/mesh_change/conform.h"
#include "solver/mesh_change/mesh_transfer.h"
#include "solver/mesh_change/patch_relaxation.h"
#include "solver/mesh_change/relaxation_memo.h"
#include "solver/mesh_change/strain_allowance.h"
#include "solver/model/stopwatch.h"
#include "solver/model/target_length.h"
#include "solver/sewing/seam_springs.h"

namespace arris {

namespace {

void prepare_stars(const State& state, MeshCache& cache)
{
    if (cache.faces_of_stars == state.mesh.faces) return;
    cache.stars = make_stars(state.mesh);
    cache.faces_of_stars = state.mesh.faces;
}

/// Places by which the solver orders its unknowns: in the material, but for EOL vertices. Material flows
/// through those, and the order is to last as long as the mesh: they have the mean place of their other
/// neighbours. None where the mesh stays: METIS orders it once, and on some meshes fills a fifth less.
void place_for_elimination(const Scene& scene, const State& state, MeshCache& cache)
{
    std::vector<Vec2>& place = cache.elimination_places;
    place.clear();
    if (!scene.eol && !scene.remesh) return;
    place = state.mesh.material;
    place.resize(state.mesh.world.size());  // of a vertex on a seam, that of its first point
    if (state.eol.empty()) return;
    std::vector<char> is_placed(place.size(), 1);
    for (const EolVertex& eol : state.eol) is_placed[state.index_of(eol.vertex_id)] = 0;
    for (const EolVertex& eol : state.eol) {
        const int v = state.index_of(eol.vertex_id);
        Vec2 sum = Vec2::Zero();
        int count = 0;
        for (const int f : cache.stars.faces[v])
            for (const int w : state.mesh.faces[f])
                if (is_placed[w]) {
                    sum += place[w];
                    ++count;
                }
        place[v] = count > 0 ? Vec2(sum / count) : Vec2::Zero();
        is_placed[v] = 1;
    }
}

/// What this scene's effects need hinges for.
HingeUse find_hinge_use(const Scene& scene, const Terms& terms)
{
    if (!terms.hinges.empty()) return HingeUse::Terms;
    return scene.eol ? HingeUse::Flow : HingeUse::None;
}

/// Updates the elements to the state's mesh. True where its faces have changed.
bool prepare_elements(const Scene& scene, const State& state, MeshCache& cache)
{
    prepare_stars(state, cache);
    const bool has_faces = cache.faces_of_elements == state.mesh.faces;
    std::vector<SpringElement> springs = list_springs(scene, state);
    const bool has_springs = std::equal(
        springs.begin(), springs.end(), cache.elements.springs.begin(), cache.elements.springs.end(),
        [](const SpringElement& a, const SpringElement& b) { return a.vertices == b.vertices; });
    cache.elements.springs = springs;
    if (has_faces && (cache.system.coupled() != state.coupled || !has_springs))
        cache.system.make_pattern(cache.elements, state.coupled);
    if (has_faces && cache.material_of_elements == state.mesh.material) return false;
    cache.world_of_stretches.clear();
    if (has_faces) {  // material has flowed
        const std::vector<Vec2>& then = cache.material_of_elements;
        std::vector<char> is_moved(then.size());
        for (std::size_t v = 0; v < then.size(); ++v) is_moved[v] = then[v] != state.mesh.material[v];
        update_elements(state.mesh, is_moved, cache.elements);
        cache.material_of_elements = state.mesh.material;
        return false;
    }
    cache.elements =
        make_elements(state.mesh, cache.stars.topology, find_hinge_use(scene, cache.terms), scene.materials);
    cache.elements.springs = std::move(springs);
    cache.system.make_pattern(cache.elements, state.coupled);
    cache.faces_of_elements = state.mesh.faces;
    cache.material_of_elements = state.mesh.material;
    return true;
}

/// Stretch, bending and gravity energy, J. From the state alone, so that a resumed run has the same bits.
double find_potential_energy(const Scene& scene, const State& state, const ClothStars& stars)
{
    return find_patch_energy(scene, find_creases(scene, state, stars), state.mesh);
}

// Times that a strained mesh is made anew: after one try, the strained patches are mostly others. Raising it
// costs a mesh each.
constexpr int kMostTries = 2;

/// A candidate mesh, and the state on it once that has been transferred.
struct TriedMesh {
    ConformOutcome outcome;
    std::optional<State> state;
    ClothStars stars;
    TransferReport transferred;
    double most_strain = 0.0;  ///< limit of that transfer

    double strain() const { return transferred.strain; }
    bool is_remeshed() const { return outcome.mesh && outcome.mesh->report.remeshed > 0; }
    bool is_carried_over() const { return state && strain() <= most_strain; }
};

/// Makes candidate meshes for a step and chooses one. docs/research-notes.md, "Strained patches", has the
/// order and the measurements; strain_allowance.h has the limits.
class MeshTries {
  public:
    MeshTries(const Scene& scene, const PlannedStep& planned, double dt, const State& state,
              const MeshCache& cache, const FailedFlow& failed, Stopwatch& watch, PhaseSeconds& seconds)
        : scene_(scene),
          dt_(dt),
          state_(state),
          cache_(cache),
          failed_(failed),
          changes_(find_mesh_changes(scene, state, cache.stars)),
          watch_(watch),
          seconds_(seconds)
    {
        if (!planned.begins_at(state.time)) changes_.misfits.clear();
        misfits_ = changes_.misfits;
        if (!failed.remeshes) changes_.misfits.clear();
    }

    /// Edges to split or merge that this step may try.
    const std::vector<std::array<VertexId, 2>>& misfits() const { return misfits_; }

    /// The best candidate. No mesh where the best one strains a patch by more than kMostStrain, or, unless it
    /// has mended edges, the whole cloth by more than kMostClothStrain: the step then keeps the mesh it has.
    /// This no longer holds once attempts at the step have given vertices up.
    TriedMesh find_best()
    {
        TriedMesh best = choose();
        if (best.is_remeshed() && crosses_itself(best)) {
            changes_.misfits.clear();
            best = choose();
        }
        const bool is_crossing = crosses_itself(best);
        const bool is_strained = best.strain() > kMostStrain ||
                                 (!best.is_remeshed() && best.transferred.cloth_strain > kMostClothStrain);
        if (!is_crossing && (!is_strained || !failed_.given_up.empty() || !failed_.made_at.empty()))
            return best;
        TriedMesh none;
        none.outcome.refused = std::move(best.outcome.refused);
        for (const FeatureSite& site : changes_.sites) {
            if (site.contact < 0) continue;
            const ActiveContact& contact = state_.active[site.contact];
            none.outcome.refused.push_back({contact.vertex_ids, contact.kind, contact.obstacle,
                                            contact.element, ConstraintCause::Guard});
        }
        return none;
    }

  private:
    /// Whether new faces, or faces at vertices that have moved, cross the cloth.
    bool crosses_itself(const TriedMesh& tried) const
    {
        if (!scene_.self_contact || !tried.state) return false;
        const State& made = *tried.state;
        std::vector<int> changed;
        std::set<IdFace> known;
        for (const Face& face : state_.mesh.faces)
            known.insert({state_.ids[face[0]], state_.ids[face[1]], state_.ids[face[2]]});
        for (int f = 0; f < made.mesh.face_count(); ++f) {
            const Face& face = made.mesh.faces[f];
            const IdFace ids = {made.ids[face[0]], made.ids[face[1]], made.ids[face[2]]};
            const bool has_moved = std::any_of(face.begin(), face.end(), [&](int v) {
                const int before = state_.index_of(made.ids[v]);
                return before < 0 || state_.mesh.world[before] != made.mesh.world[v];
            });
            if (has_moved || !known.contains(ids)) changed.push_back(f);
        }
        return !find_self_intersections(made.mesh.world, made.mesh.faces, changed).empty();
    }

    /// First tries a mesh that relies on cloth that gives way; then one with care, where patches stay
    /// strained.
    TriedMesh choose()
    {
        TriedMesh giving = make_without_strain();
        carry_over(giving, kTraceStrain);
        TriedMesh careful = more_careful(std::move(giving));
        carry_over(careful);
        return careful;
    }

    /// Makes a mesh in which no edge is mended where that strains the cloth: such edges wait.
    TriedMesh make_without_strain()
    {
        TriedMesh made = make({});
        for (int k = 0; !changes_.misfits.empty(); ++k) {
            carry_over(made);
            if (made.strain() <= kPatchStrain) break;
            if (k == kMostTries || !drop_strained_misfits(made)) changes_.misfits.clear();
            made = make({});
        }
        return made;
    }

    /// Drops the misfits in strained patches; false where there are none.
    bool drop_strained_misfits(const TriedMesh& made)
    {
        std::vector<VertexId> strained;
        for (const std::vector<VertexId>& patch : made.transferred.strained)
            strained.insert(strained.end(), patch.begin(), patch.end());
        sort_unique(strained);
        return std::erase_if(changes_.misfits, [&](const std::array<VertexId, 2>& edge) {
                   return std::binary_search(strained.begin(), strained.end(), edge[0]) ||
                          std::binary_search(strained.begin(), strained.end(), edge[1]);
               }) > 0;
    }

    /// Makes a strained mesh again, with care at the strained patches known so far (a transfer stops at the
    /// first patch over its limit). After kMostTries, care applies everywhere. Returns `mesh` itself where no
    /// strained patch relies on cloth that gives way. Returns it also where care would lose more EOL vertices
    /// and its strain is at most kTraceStrain.
    TriedMesh more_careful(TriedMesh mesh)
    {
        ConformLimits limits;
        for (int k = 0; k <= kMostTries && mesh.strain() > kPatchStrain; ++k) {
            if (!add_strained(mesh, limits.careful_at)) break;
            if (k == kMostTries) limits = {.strain = StrainLimit::AsMade};
            limits.lost = mesh.strain() <= kTraceStrain ? mesh.outcome.lost : ConformLimits().lost;
            TriedMesh next = make(limits);
            if (next.outcome.lost > limits.lost) break;
            if (k < kMostTries) carry_over(next, kTraceStrain);
            mesh = std::move(next);
        }
        return mesh;
    }

    /// Adds the vertices of strained patches that rely on cloth that gives way. True where there are new
    /// ones.
    static bool add_strained(const TriedMesh& mesh, std::vector<VertexId>& careful_at)
    {
        const std::vector<VertexId>& relies_at = mesh.outcome.relies_at;
        const std::size_t known = careful_at.size();
        for (const std::vector<VertexId>& patch : mesh.transferred.strained)
            if (std::any_of(patch.begin(), patch.end(), [&](VertexId v) {
                    return std::binary_search(relies_at.begin(), relies_at.end(), v);
                }))
                careful_at.insert(careful_at.end(), patch.begin(), patch.end());
        sort_unique(careful_at);
        return careful_at.size() > known;
    }

    TriedMesh make(const ConformLimits& limits)
    {
        TriedMesh made;
        made.outcome =
            conform_mesh(scene_, dt_, state_, cache_.stars, changes_, failed_, limits, relaxations_);
        seconds_.conform += watch_.lap();
        return made;
    }

    /// Transfers the state to the mesh, unless that is done. Left unfinished where a patch is strained by
    /// more than `most_strain`.
    void carry_over(TriedMesh& made, double most_strain = std::numeric_limits<double>::infinity())
    {
        if (!made.outcome.mesh || made.is_carried_over()) return;
        const ClothMesh& mesh = made.outcome.mesh->surgery.mesh;
        made.stars = make_stars(mesh);
        seconds_.move += watch_.lap();
        made.state = transfer(scene_, state_, cache_.stars, *made.outcome.mesh, made.stars, made.transferred,
                              most_strain);
        made.most_strain = most_strain;
        seconds_.transfer += watch_.lap();
    }

    const Scene& scene_;
    double dt_;  ///< s
    const State& state_;
    const MeshCache& cache_;
    const FailedFlow& failed_;
    MeshChanges changes_;
    std::vector<std::array<VertexId, 2>> misfits_;  ///< as found
    RelaxationMemo relaxations_;
    Stopwatch& watch_;
    PhaseSeconds& seconds_;
};

}  // namespace

StepMesh choose_step_mesh(const Scene& scene, const PlannedStep& planned, double end,
                          const FailedFlow& failed, State& state, MeshCache& cache, StepReport& report)
{
    Stopwatch watch;
    prepare_stars(state, cache);
    report.seconds.move += watch.lap();
    TriedMesh best;
    cache.misfits.clear();
    if (changes_mesh(scene)) {
        MeshTries tries(scene, planned, end - state.time, state, cache, failed, watch, report.seconds);
        cache.misfits = tries.misfits();
        best = tries.find_best();
    }
    cache.refused = std::move(best.outcome.refused);
    State* start = &state;
    if (best.outcome.mesh) {
        report.inserted = best.outcome.mesh->report.inserted;
        report.released = best.outcome.mesh->report.released;
        report.remeshed = best.outcome.mesh->report.remeshed;
        cache.conformed = std::move(*best.state);
        if (scene.remesh)
            report.remesh_energy = find_potential_energy(scene, cache.conformed, best.stars) -
                                   find_potential_energy(scene, state, cache.stars);
        cache.stars = std::move(best.stars);
        cache.faces_of_stars = cache.conformed.mesh.faces;
        start = &cache.conformed;
    } else if (has_lost_flow(scene, state, cache.stars)) {
        cache.conformed = state;
        settle_flow(scene, state, cache.stars, cache.conformed);
        start = &cache.conformed;
    }
    const bool is_changed = update_mesh_cache(scene, *start, cache);
    report.seconds.move += watch.lap();
    return {*start, is_changed};
}

const std::vector<Vec2>& find_stretches(const State& state, MeshCache& cache)
{
    if (cache.world_of_stretches != state.mesh.world) {
        cache.stretches = compute_stretches(cache.elements, state.mesh.world);
        cache.world_of_stretches = state.mesh.world;
    }
    return cache.stretches;
}

bool update_mesh_cache(const Scene& scene, const State& state, MeshCache& cache)
{
    if (cache.terms.faces.empty())
        cache.terms =
            make_terms(scene.materials, scene.gravity, scene.wind, scene.pulls, scene.sewing.has_value());
    const bool has_new_elements = prepare_elements(scene, state, cache);
    place_for_elimination(scene, state, cache);
    if (scene.self_contact && cache.self_surface.faces != state.mesh.faces)
        cache.self_surface = SelfSurface(state.mesh.vertex_count(), state.mesh.faces, cache.stars.topology);
    if (scene.sewing) cache.self_surface.joined = number_joined(state);
    if (!scene.eol) return has_new_elements;  // without folds on features there are no creases
    const Creases creases = find_creases(scene, state, cache.stars);
    const bool has_new_creases = mark_creases(creases, state.mesh, cache.elements);
    return has_new_elements || has_new_creases;
}

}  // namespace arris
