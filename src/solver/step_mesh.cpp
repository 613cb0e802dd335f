// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/step_mesh.h"

#include <limits>
#include <optional>
#include <utility>

#include "solver/conform.h"
#include "solver/creases.h"
#include "solver/mesh_transfer.h"
#include "solver/stopwatch.h"
#include "solver/strain_allowance.h"

namespace arris {

namespace {

void prepare_stars(const State& state, Workspace& work)
{
    if (work.faces_of_stars == state.mesh.faces) return;
    work.stars = make_stars(state.mesh.vertex_count(), state.mesh.faces);
    work.faces_of_stars = state.mesh.faces;
}

/// The elements of the state's mesh.
void prepare_elements(const State& state, Workspace& work)
{
    prepare_stars(state, work);
    const bool has_faces = work.faces_of_elements == state.mesh.faces;
    if (has_faces && work.material_of_elements == state.mesh.material) return;
    if (has_faces) {  // material has flowed
        const std::vector<Vec2>& then = work.material_of_elements;
        std::vector<char> is_moved(then.size());
        for (std::size_t v = 0; v < then.size(); ++v) is_moved[v] = then[v] != state.mesh.material[v];
        update_elements(state.mesh, is_moved, work.elements);
        work.material_of_elements = state.mesh.material;
        return;
    }
    work.elements = make_elements(state.mesh, work.stars.topology);
    work.system.make_pattern(work.elements);
    work.known.world.clear();
    work.faces_of_elements = state.mesh.faces;
    work.material_of_elements = state.mesh.material;
}

}  // namespace

State& conform(const Scene& scene, double end, State& state, Workspace& work, StepReport& report)
{
    Stopwatch watch;
    prepare_stars(state, work);
    report.seconds.move += watch.lap();
    // More carefully where the cloth could not give way as it should have; by force where that would cost a
    // trace its vertices, unless that is felt.
    constexpr double kAny = std::numeric_limits<double>::infinity();
    constexpr struct {
        StrainLimit limit;
        double most_lost, most_strain;
    } kTries[] = {{StrainLimit::GivesWay, kAny, kPatchStrain},
                  {StrainLimit::AsMade, 0, kAny},
                  {StrainLimit::Forced, kAny, kPatchStrain},
                  {StrainLimit::AsMade, kAny, kAny}};
    const FeatureChanges changes = find_feature_changes(scene, state, work.stars);
    std::optional<ConformOutcome> careful;  // as made: it may yet be the best there is
    std::optional<ConformedMesh> conformed;
    for (const auto& [limit, most_lost, most_strain] : kTries) {
        ConformOutcome outcome = careful && limit == StrainLimit::AsMade
                                     ? *std::move(careful)
                                     : conform_mesh(scene, end - state.time, state, work.stars, changes,
                                                    work.failed.flow(), limit);
        report.seconds.conform += watch.lap();
        if (outcome.mesh && outcome.mesh->report.lost > most_lost) {
            careful = std::move(outcome);
            continue;
        }
        conformed = std::move(outcome.mesh);
        work.refused = std::move(outcome.refused);
        if (!conformed) break;
        TransferReport transferred;
        work.conformed = transfer(scene, state, work.stars, *conformed, transferred, most_strain);
        report.seconds.transfer += watch.lap();
        if (transferred.strain <= most_strain) break;
    }
    if (conformed) {
        report.inserted = conformed->report.inserted;
        report.released = conformed->report.released;
    }
    State& start = conformed ? work.conformed : state;
    prepare(scene, start, work);
    report.seconds.move += watch.lap();
    return start;
}

void prepare(const Scene& scene, const State& state, Workspace& work)
{
    if (work.terms.faces.empty())
        work.terms = make_terms(scene.material, scene.gravity, scene.wind, scene.pulls);
    prepare_elements(state, work);
    const Creases creases = find_creases(scene, state, work.stars);
    if (mark_creases(creases, state.mesh, work.elements)) work.known.world.clear();
}

}  // namespace arris
