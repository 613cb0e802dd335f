// SPDX-License-Identifier: GPL-3.0-or-later
// Cloth that is sewn from panels before time 0.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

#include "app/files/csv_table.h"
#include "app/run/resumed_scene.h"
#include "app/run/simulation.h"
#include "app/scene/parts/assembly.h"
#include "app/scene/scene_load.h"
#include "geometry/cloth/euler_characteristic.h"
#include "geometry/cloth/mesh_topology.h"
#include "solver/contact/audit.h"
#include "solver/sewing/closing.h"
#include "solver/step.h"
#include "tests/app/error_of.h"
#include "tests/app/program.h"
#include "tests/app/run/sewn_tube.h"

namespace arris {
namespace {

using ::testing::HasSubstr;

RunConfig load(const std::string& text)
{
    return load_scene({"s.toml", text, {}}, with_program());
}

std::string refusal(const std::string& text)
{
    return error_of([&] { load(text); });
}

/// Runs an assembly to its end.
Simulation sew(const RunConfig& config)
{
    RunConfig assembly = make_assembly(config);
    Checkpoint start = start_checkpoint(assembly, {"s.toml", kTube, {}});
    Simulation simulation(std::move(assembly), std::move(start));
    while (!simulation.is_over()) {
        const auto ending = simulation.step([](StepRow&) {});
        EXPECT_FALSE(ending) << ending->message;
        if (ending) break;
    }
    return simulation;
}

TEST(Assembly, PanelsArePiecesWithTheirOwnFabricAndMaterial)
{
    const RunConfig config =
        load(kHeld + "[[probe]]\nname = \"p\"\npanel = \"back\"\nmaterial = [0.1, 0.2]\n");
    ASSERT_EQ(config.pieces.size(), 2U);
    EXPECT_EQ(config.pieces[0].name, "front");
    EXPECT_EQ(config.pieces[1].name, "back");
    EXPECT_EQ(config.scene.materials[0].density, 0.15);
    EXPECT_EQ(config.scene.materials[1].density, 0.4);
    EXPECT_EQ(config.pieces[1].material_key, "fabric.0");
    EXPECT_NE(config.pieces[0].is_mirrored, config.pieces[1].is_mirrored) << "right sides look outward";
    const ClothPiece& back = config.pieces[1];
    EXPECT_LT((back.from_plane(config.probes[0].material) - Vec2(0.1, 0.2)).norm(), 1e-12);
    EXPECT_EQ(config.seams.size(), 2U);
    EXPECT_TRUE(needs_assembly(config));
    // The pin of the label holds the front's top edge alone.
    const State state = make_state(config.scene, config.cloth, config.cloth_velocity);
    EXPECT_EQ(state.anchors.size(), 7U);
    for (const PinAnchor& anchor : state.anchors) {
        EXPECT_NEAR(state.mesh.world[state.index_of(anchor.vertex_id)].y(), 0.12, 1e-12);
        EXPECT_NEAR(state.mesh.world[state.index_of(anchor.vertex_id)].z(), 0.3, 1e-12);
    }
}

TEST(Assembly, ClosesSeamsAroundAnObstacle)
{
    const RunConfig config = load(kTube);
    const Simulation sewn = sew(config);
    const ClothMesh& mesh = sewn.state().mesh;
    EXPECT_EQ(validate(mesh), "");
    EXPECT_EQ(euler_characteristic(mesh), 0) << "a tube";
    EXPECT_TRUE(sewn.state().seam_pairs.empty());
    EXPECT_EQ(find_self_crossings(config.scene, mesh).count, 0);
    EXPECT_EQ(audit(config.scene, mesh, 0.0).obstacle, -1);
    double least = 1.0, greatest = -1.0;
    for (const Vec3& x : mesh.world) {
        least = std::min(least, x.y());
        greatest = std::max(greatest, x.y());
    }
    EXPECT_LT(least, -0.025) << "the post is inside";
    EXPECT_GT(greatest, 0.025);
    const RunConfig main = load_sewn({"s.toml", kTube, {}}, sewn.at(), config);
    EXPECT_FALSE(needs_assembly(main));
    EXPECT_FALSE(main.scene.sewing);
    EXPECT_EQ(main.cloth.world, mesh.world);
    // A label names the same material after that.
    const RunConfig held = load_sewn({"s.toml", kHeld, {}}, sewn.at(), load(kHeld));
    EXPECT_EQ(make_state(held.scene, held.cloth, held.cloth_velocity).anchors.size(), 7U);
}

/// Ways, m, of the rear corner (u = 0, v = 0.2) of a sheet that slides from a table, at times 0, 0.05, ...
/// 0.2 s.
std::vector<Vec3> slide(const std::string& panels)
{
    const std::string text = R"(
duration = 0.2
[cloth]
edge_length = 0.05
)" + panels + R"(
[[probe]]
name = "rear"
panel = "left"
material = [0.0, 0.1]
[self_contact]
[gravity]
[[obstacle]]
name = "table"
box = [1, 1, 0.1]
translate = [-0.5, 0, -0.0505]
[output]
frames_per_second = 20
formats = []
)";
    const RunConfig unsewn = load(text);
    RunConfig config =
        needs_assembly(unsewn) ? load_sewn({"s.toml", text, {}}, sew(unsewn).at(), unsewn) : load(text);
    Checkpoint start = start_checkpoint(config, {"s.toml", text, {}});
    Simulation simulation(std::move(config), std::move(start));
    std::vector<Vec3> way;
    const auto note = [&] {
        if (simulation.timeline().frame_at(simulation.state().time) >= 0)
            way.push_back(simulation.probes().front().position);
    };
    note();
    while (!simulation.is_over()) {
        const auto ending = simulation.step([](StepRow&) {});
        EXPECT_FALSE(ending) << ending->message;
        if (ending) break;
        note();
    }
    return way;
}

TEST(Assembly, SewnSheetSlidesFromATableAsOneOfOnePanel)
{
    const std::vector<Vec3> one = slide(R"([[cloth.panel]]
name = "left"
outline = [[0, -0.2], [1, -0.2], [1, 0.2], [0, 0.2]]
translate = [-0.4, 0, 0.001])");
    const std::vector<Vec3> along = slide(R"([[cloth.panel]]
name = "left"
outline = [[0, 0], [1, 0], [1, 0.2], [0, 0.2]]
translate = [-0.4, 0.01, 0.001]
[[cloth.panel]]
name = "right"
outline = [[0, -0.2], [1, -0.2], [1, 0], [0, 0]]
translate = [-0.4, -0.01, 0.001]
[[cloth.seam]]
join = [["left", 0, 1], ["right", 3, 2]])");
    const std::vector<Vec3> across = slide(R"([[cloth.panel]]
name = "left"
outline = [[0, -0.2], [0.5, -0.2], [0.5, 0.2], [0, 0.2]]
translate = [-0.41, 0, 0.001]
[[cloth.panel]]
name = "right"
outline = [[0, -0.2], [0.5, -0.2], [0.5, 0.2], [0, 0.2]]
translate = [0.11, 0, 0.001]
[[cloth.seam]]
join = [["left", 1, 2], ["right", 0, 3]])");
    ASSERT_EQ(one.size(), 5U);
    ASSERT_EQ(along.size(), one.size());
    ASSERT_EQ(across.size(), one.size());
    const double way = (one.back() - one.front()).norm();
    EXPECT_GT(way, 0.05);
    for (std::size_t k = 1; k < one.size(); ++k)  // sewing ends a little off the middle, as it rounds
        for (const std::vector<Vec3>& sewn : {along, across})
            EXPECT_LT(((sewn[k] - sewn[0]) - (one[k] - one[0])).norm(), 0.01 * way) << k;
}

TEST(Assembly, IsTheSameFromACheckpointOfEveryTenthStep)
{
    const RunConfig config = load(kTube);
    const std::string whole = to_bytes(sew(config).at());
    RunConfig assembly = make_assembly(config);
    Checkpoint start = start_checkpoint(assembly, {"s.toml", kTube, {}});
    Simulation simulation(std::move(assembly), std::move(start));
    int restarts = 0;
    for (int k = 1; !simulation.is_over(); ++k) {
        ASSERT_FALSE(simulation.step([](StepRow&) {}));
        if (k % 10 != 0) continue;
        ASSERT_GT(simulation.at().rows, 0);
        Checkpoint again = parse_checkpoint(to_bytes(simulation.at()), "again");
        EXPECT_EQ(again.assembly_duration, make_assembly(config).duration);
        simulation = Simulation(make_assembly(config, again.assembly_duration), std::move(again));
        ++restarts;
    }
    EXPECT_GT(restarts, 10);
    EXPECT_TRUE(to_bytes(simulation.at()) == whole);
}

TEST(Assembly, DamagedCheckpointsAreRefused)
{
    const RunConfig config = load(kTube);
    RunConfig assembly = make_assembly(config);
    Checkpoint start = start_checkpoint(assembly, {"s.toml", kTube, {}});
    start.rows = 1;
    const auto refused = [](const Checkpoint& checkpoint) {
        return error_of([&] { parse_checkpoint(to_bytes(checkpoint), "c"); });
    };
    EXPECT_EQ(refused(start), "");
    for (const auto damage : {+[](Checkpoint& c) { c.state.seam_pairs[3].vertex_ids[1] = 100000; },
                              +[](Checkpoint& c) { c.state.seam_pairs[3].seam = 2; },
                              +[](Checkpoint& c) { c.state.seam_pairs[3].seam = -1; },
                              +[](Checkpoint& c) { c.state.seam_pairs[0].gap = -1.0; },
                              +[](Checkpoint& c) { c.state.closing.end = -1e300; },
                              +[](Checkpoint& c) { c.state.sewn_at = std::nan(""); },
                              +[](Checkpoint& c) { c.assembly_duration = -1.0; }}) {
        Checkpoint damaged = start;
        damage(damaged);
        EXPECT_THAT(refused(damaged), HasSubstr("is damaged: "));
    }
}

TEST(Assembly, WhatCannotCloseEndsUnsewnAndNamesWhatPresses)
{
    // The seam on one side meets a wall between the panels.
    const RunConfig config = load(kTube + "[[obstacle]]\nname = \"wall\"\nbox = [0.4, 0.02, 1.0]\n");
    RunConfig assembly = make_assembly(config);
    Checkpoint start = start_checkpoint(assembly, {"s.toml", kTube, {}});
    Simulation simulation(std::move(assembly), std::move(start));
    std::optional<RunEnding> ending;
    while (!ending && !simulation.is_over()) ending = simulation.step([](StepRow&) {});
    ASSERT_TRUE(ending);
    EXPECT_EQ(ending->status, RunStatus::Unsewn);
    EXPECT_THAT(ending->message, HasSubstr("2 seams did not close in "));
    EXPECT_THAT(ending->message, HasSubstr("panel \"front\""));
    EXPECT_THAT(ending->message, HasSubstr("where wall presses"));
    EXPECT_EQ(audit(config.scene, simulation.state()).obstacle, -1);
}

TEST(Assembly, EndsInAnyCaseWithAStepOfTheSewnCloth)
{
    for (const char* settle : {"settle = 0.0", "settle = 0.004"}) {
        Simulation sewn = sew(load(with(kTube, "settle = 0.05", settle)));
        EXPECT_GT(sewn.state().time, sewn.state().sewn_at);
        EXPECT_EQ(sewn.frame().faces.size(), sewn.state().mesh.faces.size());
    }
}

TEST(Assembly, PinsHoldOtherClothByItsOwnNumbers)
{
    // Corner 2 of a sheet beside the tube, which has fewer vertices once its seams are sewn.
    const std::string sheet = R"(
[[cloth]]
name = "sheet"
size = [0.2, 0.1]
resolution = [2, 1]
translate = [1, 0, 0]
)";
    std::string text = with(kTube, "[cloth]\n", "[[cloth]]\nname = \"tube\"\n");
    text = with(text, "[[fabric]]", sheet + "[[fabric]]") + "[[pin]]\npiece = \"sheet\"\nvertices = [2]\n";
    const RunConfig config = load(text);
    const auto held = [](const RunConfig& of) {
        const State state = make_state(of.scene, of.cloth, of.cloth_velocity);
        EXPECT_EQ(state.anchors.size(), 1U);
        return state.mesh.world[state.index_of(state.anchors.front().vertex_id)];
    };
    EXPECT_EQ(held(config), Vec3(1.2, 0.0, 0.0));
    const Simulation sewn = sew(config);
    EXPECT_LT(sewn.state().mesh.vertex_count(), config.cloth.vertex_count());
    EXPECT_LT((held(load_sewn({"s.toml", text, {}}, sewn.at(), config)) - Vec3(1.2, 0.0, 0.0)).norm(), 1e-9);
}

TEST(Assembly, PinsThatMoveTheSewnClothThroughSomethingAreRefused)
{
    const std::string text =
        kHeld +
        "keyframes = [{ time = 0.0, translate = [0.0, 0.0, -0.6] }]\n"
        "[[obstacle]]\nname = \"knob\"\nbox = [0.5, 0.5, 0.05]\ntranslate = [0, 0, -0.2]\n";
    const RunConfig config = load(kTube);
    const Simulation sewn = sew(config);
    EXPECT_THAT(error_of([&] {
                    load_sewn({"s.toml", text, {}}, sewn.at(), load(text));
                }),
                HasSubstr("allowed: cloth that starts clear"));
}

TEST(Assembly, RefusesWhatCannotBeMeant)
{
    EXPECT_THAT(refusal(with(kTube, R"(["back", 1, 2]])", R"(["back", 1, 2]]
[[cloth.seam]]
join = [["front", 1, 2], ["back", 1, 2]]
as = "tie")")),
                HasSubstr("has other seams on both sides"));
    EXPECT_THAT(refusal(with(kTube, "label = \"top\" }", "label = \"top\" }, { edge = 2 }")),
                HasSubstr("cloth.panel.0.edges.1.edge = 2: is there twice"));
    EXPECT_THAT(refusal(with(kTube, "settle = 0.05", "speed = 1e-9")), HasSubstr("is out of range"));
    EXPECT_THAT(refusal(with(kTube, "[self_contact]\n", "")),
                HasSubstr("self_contact: is required and missing, as seams are to be closed"));
    EXPECT_THAT(refusal(with(kTube, R"(["back", 1, 2])", R"(["bakc", 1, 2])")),
                HasSubstr("\"bakc\" is not a panel; allowed: the name of a panel: front, back"));
    EXPECT_THAT(refusal(with(kTube, R"(["back", 1, 2])", R"(["back", 1, 9])")),
                HasSubstr("has corner 9; allowed: corners 0 to 3 of the panel"));
    EXPECT_THAT(refusal(with(kTube, R"(["back", 1, 2])", R"(["back", 1, 1])")),
                HasSubstr("begins and ends at one corner"));
    EXPECT_THAT(refusal(with(kTube, R"(["back", 1, 2])", R"(["back", 0, 2])")),
                HasSubstr("has two ways of one length along the outline"));
    EXPECT_THAT(refusal(with(kTube, R"(["back", 1, 2])", R"(["back", 0, 3])")), HasSubstr("is sewn twice"));
    EXPECT_THAT(refusal(kTube + "[[pin]]\nlabel = \"hem\"\n"),
                HasSubstr("is not a label of an edge; allowed: one of top"));
    EXPECT_THAT(refusal(kTube + "[[pin]]\nmaterial = [[0, 0], [0, 1]]\n"),
                HasSubstr("pin.0.panel: is required and missing, as this cloth has several panels; allowed: "
                          "the name of a panel: front, back"));
    EXPECT_THAT(refusal(kTube + "[[pin]]\nvertices = [0]\n"), HasSubstr("is written for a cloth of panels"));
    EXPECT_THAT(
        refusal(with(kTube, "fabric = \"heavy\"", "fabric = \"hevy\"")),
        HasSubstr("cloth.panel.1.fabric = \"hevy\": is not a fabric; allowed: the name of a fabric: heavy"));
    EXPECT_THAT(refusal(with(kTube, "name = \"back\"", "name = \"front\"")),
                HasSubstr("is already the name of a panel"));
    EXPECT_THAT(refusal(with(kTube, "name = \"post\"", "name = \"back\"")), HasSubstr("is taken"));
    EXPECT_THAT(refusal(with(kTube, "edge_length = 0.05\n", "")),
                HasSubstr("cloth.edge_length: is required"));
    EXPECT_THAT(refusal(with(kTube, "edge_length = 0.05\n", "edge_length = 0.05\nsize = [1, 1]\n")),
                HasSubstr("contradicts cloth.panel"));
    EXPECT_THAT(refusal(with(kTube, "edge = 2", "edge = 4")), HasSubstr("is not an edge of the outline"));
    EXPECT_THAT(refusal("duration = 1\n[cloth]\nsize = [1, 1]\nresolution = [2, 2]\n[cloth.assembly]\n"),
                HasSubstr("cloth.assembly: is written without panels"));
    // Panels that lie in each other are named.
    EXPECT_THAT(refusal(with(kTube, "[-0.15, -0.12, 0.0]", "[-0.14, 0.12, 0.0]")),
                HasSubstr("of front with back, at ["));
    EXPECT_THAT(refusal(with(kTube, "[-0.15, -0.12, 0.0]", "[-0.15, 0.01, 0.0]")),
                HasSubstr("at time 0 back "));
}

TEST(Assembly, PocketAndThirdPanelAreTied)
{
    const std::string text = kTube + R"(
[[cloth.panel]]
name = "pocket"
outline = [[0, 0], [0.1, 0], [0.1, 0.1], [0, 0.1]]
translate = [-0.05, 0.15, 0.1]
rotate = { axis = [1, 0, 0], degrees = 90 }
[[cloth.panel]]
name = "fin"
outline = [[0, 0], [0.1, 0], [0.1, 0.3], [0, 0.3]]
translate = [0.16, 0.0, 0.0]
rotate = { axis = [1, 0, 0], degrees = 90 }
[[cloth.seam]]
join = [["pocket", 3, 0], ["front", [0.1, 0.2], [0.1, 0.1]]]
as = "tie"
[[cloth.seam]]
join = [["pocket", 0, 1], ["front", [0.1, 0.1], [0.2, 0.1]]]
as = "tie"
[[cloth.seam]]
join = [["fin", 0, 3], ["back", 1, 2]]
as = "tie"
)";
    const RunConfig config = load(text);
    EXPECT_EQ(config.seams.size(), 5U);
    const Simulation sewn = sew(config);
    EXPECT_TRUE(std::isfinite(sewn.state().sewn_at));
    EXPECT_EQ(sewn.state().seam_pairs.size(), 3U + 3U + 7U);
    EXPECT_TRUE(find_open_seams(sewn.config().scene, sewn.state()).empty());
    EXPECT_EQ(find_self_crossings(config.scene, sewn.state().mesh).count, 0);
    EXPECT_THAT(
        refusal(with(text, "[0.1, 0.1], [0.2, 0.1]", "[0.1, 0.1], [0.298, 0.1]")),
        HasSubstr("it is not within panel \"front\"; allowed: a line at least a quarter of the edge length"));
    EXPECT_THAT(refusal(with(text, R"(["front", [0.1, 0.1], [0.2, 0.1]])", R"(["front", [0.1, 0.1], 2])")),
                HasSubstr("cloth.seam.3.join.1"));
}

TEST(Assembly, TiesHoldWhateverBecomesOfTheMesh)
{
    // One seam is a tie; the tube falls onto a ridge, with EOL vertices and remeshing.
    std::string text = with(kTube, R"(["back", 1, 2]])", R"(["back", 1, 2]]
as = "tie")");
    text = with(text, "duration = 0.1", "duration = 0.2") +
           "[remesh]\nedge_length = [0.01, 0.06]\n[[obstacle]]\nname = \"ridge\"\nbox = [0.4, 0.1, 0.1]\n"
           "translate = [0, 0, -0.12]\n";
    const RunConfig unsewn = load(text);
    const Simulation sewn = sew(unsewn);
    const std::size_t ties = sewn.state().seam_pairs.size();
    EXPECT_EQ(ties, 7U);
    RunConfig config = load_sewn({"s.toml", text, {}}, sewn.at(), unsewn);
    EXPECT_TRUE(config.scene.sewing);
    EXPECT_FALSE(needs_assembly(config));
    Checkpoint start = start_checkpoint(config, {"s.toml", text, {}});
    Simulation simulation(std::move(config), std::move(start));
    std::int64_t remeshed = 0;
    while (!simulation.is_over())
        ASSERT_FALSE(simulation.step([&](StepRow& row) {
            remeshed += row.remeshed.value_or(0);
            EXPECT_EQ(row.open_pairs, 0);
        }));
    EXPECT_GT(remeshed, 0);
    EXPECT_EQ(simulation.state().seam_pairs.size(), ties);
}

}  // namespace
}  // namespace arris
