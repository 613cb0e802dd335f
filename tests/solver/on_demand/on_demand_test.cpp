// SPDX-License-Identifier: GPL-3.0-or-later
// An effect that a scene does not have costs nothing: no term, no memory, no pass over the cloth or the
// obstacles. Counters decide, not timings. docs/effects.md lists the effects.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "physics/elements/momentum_flux.h"
#include "physics/forces/energies.h"
#include "solver/buckling_seed.h"
#include "solver/contact/audit.h"
#include "solver/contact/proposal.h"
#include "solver/mesh_change/step_mesh.h"
#include "solver/remesh/sizing_field.h"
#include "solver/step.h"
#include "tests/solver/on_demand/allocations.h"

namespace arris {
namespace {

using testing::Allocations;
using testing::allocations_of;

constexpr double kStep = 0.005;  // s
constexpr int kSteps = 12;       // until the cloth's first EOL vertices are on the table's edge
constexpr int kCells = 8;
constexpr double kSide = 0.4;       // m, of the square sheet
constexpr double kAbove = 1.05e-3;  // m, of the sheet above the table: a thickness and a little

/// A sheet that hangs by half over x = 0, with no effect at all.
Scene plain_scene()
{
    Scene scene;
    scene.materials[0] = {0.15, 500.0, 0.3, 0.0, 0.0, 1e-3};  // neither bending nor damping
    return scene;
}

ClothMesh make_sheet()
{
    ClothGrid grid;
    grid.size = {kSide, kSide};
    grid.resolution = {kCells, kCells};
    ClothMesh mesh = make_cloth_grid(grid);
    for (Vec3& x : mesh.world) x += Vec3(-0.53 * kSide, -0.5 * kSide, kAbove);
    return mesh;
}

void add_table(Scene& scene)
{
    scene.obstacles.push_back(MovingObstacle("table", make_box({1.0, 2.0, 0.5}),
                                             {Mat3::Identity(), Vec3(-0.5, 0, -0.25)}, {}, 30.0));
}

struct SheetRun {
    Scene scene;
    Settings settings;
    State state;
    Workspace work;
    PhaseSeconds seconds;
    std::size_t most_eol = 0;

    explicit SheetRun(Scene made) : scene(std::move(made))
    {
        state = make_state(scene, make_sheet(), Vec3(0.0, 0.1, 0.0));
        prepare(scene, state, work);
    }

    void advance()
    {
        for (int k = 0; k < kSteps; ++k) {
            const StepReport report = step(scene, settings, state.time + kStep, state, work);
            ASSERT_EQ(report.status, StepStatus::Done) << "step " << k;
            seconds += report.seconds;
            most_eol = std::max(most_eol, state.eol.size());
        }
    }
};

/// Everything that an effect may leave in a run, by name.
std::map<std::string, double> count(const SheetRun& run)
{
    const MeshCache& mesh = run.work.mesh;
    const auto& faces = mesh.terms.faces;
    const auto count_terms = [&](const auto& is_one) {
        return static_cast<double>(std::count_if(faces.begin(), faces.end(), is_one));
    };
    // Blocks of vertices, and of mesh edges, which the pattern has in any scene.
    const auto& edges = mesh.stars.topology.edges;
    const auto blocks = run.state.mesh.world.size() + edges.size();
    return {
        {"terms of faces beyond inertia and membrane", static_cast<double>(faces.size()) - 2.0},
        {"gravity terms", count_terms([](const auto& t) { return t->energy_kind() == EnergyKind::Gravity; })},
        {"driving terms", count_terms([](const auto& t) { return t->is_drive(); })},
        {"loads", mesh.terms.loads.size()},
        {"hinge terms", mesh.terms.hinges.size()},
        {"hinges", mesh.elements.hinges.size()},
        {"colours of hinges", mesh.elements.hinge_colors.order.size()},
        {"entries of hinges in the matrix",
         static_cast<double>(mesh.system.matrix().nonZeros()) - 9.0 * static_cast<double>(blocks)},
        {"damping", run.work.linearization.damping[0]},
        {"targets of pins", run.work.pin_targets.size()},
        {"anchors of pins", run.state.anchors.size()},
        {"moved obstacles", run.work.carriers.obstacles.size()},
        {"contacts", run.work.contacts.size()},
        {"seconds of contacts", run.seconds.contacts},
        {"slip contacts", run.work.slip_contacts.size()},
        {"faces to search for contact with itself", mesh.self_surface.faces.size()},
        {"mobility of vertices", run.work.mobility.size()},
        {"target edge lengths", run.state.sizing_field.size()},
        {"EOL vertices", run.most_eol},
        {"conformed meshes", run.work.mesh.conformed.mesh.faces.size()},
        {"flow of material", run.work.linearization.flow.has_value() ? 1.0 : 0.0},
        {"seconds of conform", run.seconds.conform},
        {"seconds of transfer", run.seconds.transfer},
    };
}

std::set<std::string> traces_of(const SheetRun& run)
{
    std::set<std::string> traces;
    for (const auto& [name, value] : count(run))
        if (value > 0.0 || value < 0.0) traces.insert(name);
    return traces;
}

struct Effect {
    const char* name;
    std::function<void(Scene&)> switch_on;
    std::set<std::string> traces;
};

const std::set<std::string> kObstacle = {"moved obstacles", "contacts", "mobility of vertices",
                                         "seconds of contacts"};

std::set<std::string> with_obstacle(std::set<std::string> traces)
{
    traces.insert(kObstacle.begin(), kObstacle.end());
    return traces;
}

Pin pin_at_border()
{
    Pin pin;
    pin.material = {Vec2(0, 0), Vec2(0, kSide)};
    return pin;
}

const Effect kEffects[] = {
    {"none", [](Scene&) {}, {}},
    {"bending",
     [](Scene& s) { s.materials[0].bending_stiffness = 1e-5; },
     {"hinge terms", "hinges", "colours of hinges", "entries of hinges in the matrix"}},
    {"damping", [](Scene& s) { s.materials[0].damping = 0.01; }, {"damping"}},
    {"gravity",
     [](Scene& s) { s.gravity = Gravity{}; },
     {"terms of faces beyond inertia and membrane", "gravity terms"}},
    {"wind",
     [](Scene& s) { s.wind.emplace().velocity = Vec3(0, 0, 1); },
     {"terms of faces beyond inertia and membrane", "driving terms"}},
    {"pull",
     [](Scene& s) {
         s.pulls.push_back({{Vec2(0, 0), Vec2(0, kSide)}, Vec3(-0.1, 0, 0)});
     },
     {"loads"}},
    {"pin", [](Scene& s) { s.pins.push_back(pin_at_border()); }, {"targets of pins", "anchors of pins"}},
    {"obstacle", add_table, kObstacle},
    {"friction",
     [](Scene& s) {
         add_table(s);
         s.friction.emplace().of_pieces = {0.5};
     },
     with_obstacle({"slip contacts"})},
    {"self_contact",
     [](Scene& s) { s.self_contact = ClothContact{1e-3}; },
     {"faces to search for contact with itself", "mobility of vertices"}},
    {"remesh",
     [](Scene& s) {
         Remeshing remesh;
         remesh.shortest = remesh.longest = 0.5 * kSide / kCells;  // finer at once
         measure_first_mesh(make_sheet(), remesh);
         s.remesh = remesh;
     },
     {"target edge lengths", "conformed meshes", "seconds of conform", "seconds of transfer"}},
    {"eol",
     [](Scene& s) {
         add_table(s);
         s.gravity = Gravity{};
         s.eol = uniform_target(kSide / kCells, 10.0);
     },
     with_obstacle({"terms of faces beyond inertia and membrane", "gravity terms", "hinges", "EOL vertices",
                    "conformed meshes", "flow of material", "seconds of conform", "seconds of transfer"})},
};

TEST(OnDemand, AnEffectLeavesItsOwnTracesAndThoseOfNoOther)
{
    for (const Effect& effect : kEffects) {
        SCOPED_TRACE(effect.name);
        Scene scene = plain_scene();
        effect.switch_on(scene);
        SheetRun run(std::move(scene));
        ASSERT_NO_FATAL_FAILURE(run.advance());
        EXPECT_EQ(traces_of(run), effect.traces);
    }
}

/// All that a run with this effect allocates.
std::int64_t bytes_of_run(const std::function<void(Scene&)>& switch_on)
{
    Scene scene = plain_scene();
    switch_on(scene);
    return allocations_of([&] {
               SheetRun run(std::move(scene));
               run.advance();
           })
        .bytes;
}

TEST(OnDemand, SwitchingAnEffectOnIsWhatAllocates)
{
    const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
    bytes_of_run([](Scene&) {});  // what a library allocates at its first use
    const std::int64_t plain = bytes_of_run([](Scene&) {});
    EXPECT_EQ(bytes_of_run([](Scene&) {}), plain) << "a run allocates the same each time";
    for (const Effect& effect : kEffects) {
        const std::string name = effect.name;
        if (name == "none" || name == "damping")
            EXPECT_EQ(bytes_of_run(effect.switch_on), plain) << name;  // damping only weighs stiffness
        else
            EXPECT_GT(bytes_of_run(effect.switch_on), plain) << name;
    }
}

/// A stage of the step, and the effect without which it allocates nothing.
struct Stage {
    const char* name;
    const char* effect;
    std::function<void(SheetRun&)> run;
};

const Stage kStages[] = {
    {"choose_step_mesh", "eol",
     [](SheetRun& r) {
         StepReport report;
         choose_step_mesh(r.scene, {r.state.time, r.state.time + kStep}, r.state.time + kStep, {}, r.state,
                          r.work.mesh, report);
     }},
    {"find_momentum_flux", "eol",
     [](SheetRun& r) { find_momentum_flux(r.scene.materials, r.work.mesh.elements, r.work.linearization); }},
    {"find_pin_targets", "pin",
     [](SheetRun& r) { find_pin_targets(r.scene, r.state, r.state.time + kStep); }},
    {"move_obstacles", "obstacle",
     [](SheetRun& r) {
         move_obstacles(r.scene, r.state, r.work.mesh.stars.topology.edges, r.work.prediction, {},
                        r.state.time + kStep);
     }},
    {"find_contacts_with_obstacles", "obstacle",
     [](SheetRun& r) { find_contacts_with_obstacles(r.scene, r.state, r.work.prediction, r.work.carriers); }},
    {"check_proposal", "obstacle",
     [](SheetRun& r) {
         check_proposal(r.scene, r.state, r.work.mesh.self_surface, r.work.proposal, r.work.prediction,
                        r.work.carriers);
     }},
    {"follow_wanted_lengths", "remesh",
     [](SheetRun& r) { follow_wanted_lengths(r.scene, r.work.mesh.stars, kStep, r.state); }},
    {"find_contacts_with_itself", "self_contact",
     [](SheetRun& r) {
         find_contacts_with_itself(r.scene, r.state, r.work.prediction, r.work.pin_targets,
                                   r.work.mesh.self_surface, r.work.carriers);
     }},
    {"audit", "obstacle", [](SheetRun& r) { audit(r.scene, r.state); }},
    {"compute_load_work", "pull",
     [](SheetRun& r) {
         compute_load_work(r.state.mesh, r.work.mesh.elements, r.work.mesh.terms, r.work.linearization,
                           r.state.velocity, r.state.velocity);
     }},
};

TEST(OnDemand, AStageAllocatesNothingWithoutItsEffect)
{
    SheetRun plain(plain_scene());
    ASSERT_NO_FATAL_FAILURE(plain.advance());
    plain.work.proposal.world = plain.state.mesh.world;
    for (const Stage& stage : kStages) {
        SCOPED_TRACE(stage.name);
        EXPECT_EQ(allocations_of([&] { stage.run(plain); }).count, 0);

        const auto effect = std::find_if(std::begin(kEffects), std::end(kEffects), [&](const Effect& e) {
            return e.name == std::string(stage.effect);
        });
        ASSERT_NE(effect, std::end(kEffects));
        Scene scene = plain_scene();
        effect->switch_on(scene);
        SheetRun with(std::move(scene));
        ASSERT_NO_FATAL_FAILURE(with.advance());
        with.work.proposal.world = with.state.mesh.world;
        EXPECT_GT(allocations_of([&] { stage.run(with); }).count, 0);
    }
}

TEST(OnDemand, TheBucklingSeedAllocatesNothingWhereNoClothIsCompressed)
{
    Scene scene = plain_scene();
    SheetRun run(std::move(scene));
    const auto seed = [&] {
        Prediction prediction = predict(run.state, Integrator::Bdf2, kStep);
        return allocations_of(
                   [&] { seed_buckling(run.scene, run.state, run.work.mesh, run.work.contacts, prediction); })
            .count;
    };
    find_stretches(run.state, run.work.mesh);  // as `max_strain` of the last row has
    EXPECT_EQ(seed(), 0);
    for (Vec3& x : run.state.mesh.world) x.x() *= 0.99;
    find_stretches(run.state, run.work.mesh);
    EXPECT_GT(seed(), 0);
}

}  // namespace
}  // namespace arris
