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
#include "solver/step.h"
#include "tests/app/error_of.h"
#include "tests/app/program.h"
#include "tests/app/same_run.h"

namespace arris {
namespace {

using ::testing::HasSubstr;

/// A tube of two panels around a post.
const std::string kTube = R"(
duration = 0.1
[cloth]
edge_length = 0.05
[cloth.assembly]
settle = 0.05
[[cloth.panel]]
name = "front"
outline = [[0, 0], [0.3, 0], [0.3, 0.3], [0, 0.3]]
edges = [{ edge = 2, label = "top" }]
translate = [-0.15, 0.12, 0.0]
rotate = { axis = [1, 0, 0], degrees = 90 }
[[cloth.panel]]
name = "back"
fabric = "heavy"
outline = [[0, 0], [0.3, 0], [0.3, 0.3], [0, 0.3]]
translate = [-0.15, -0.12, 0.0]
rotate = { axis = [1, 0, 0], degrees = 90 }
[[cloth.seam]]
join = [["front", 0, 3], ["back", 0, 3]]
[[cloth.seam]]
join = [["front", 1, 2], ["back", 1, 2]]
[[fabric]]
name = "heavy"
density = 0.4
[self_contact]
[gravity]
[[obstacle]]
name = "post"
box = [0.05, 0.05, 1.0]
[output]
formats = []
)";

const std::string kHeld = kTube + "[[pin]]\nlabel = \"top\"\n";

RunConfig load(const std::string& text)
{
    return load_scene({"s.toml", text, {}}, with_program());
}

std::string refusal(const std::string& text)
{
    return error_of([&] { load(text); });
}

std::string with(std::string text, const std::string& what, const std::string& instead)
{
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), instead);
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

TEST(Assembly, RefusesWhatCannotBeMeant)
{
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

class AssemblyRun : public testing::Test {
  protected:
    std::string write(const std::string& text)
    {
        std::ofstream(folder / "tube.toml") << text;
        return folder / "tube.toml";
    }

    TemporaryDirectory folder;
};

TEST_F(AssemblyRun, IsARunOfItsOwnBeforeTimeZeroAndGoesOnAfterAKill)
{
    const std::string scene = write(kTube);
    Program whole(folder, {"run", scene, "-o", folder / "one", "--threads", "1"});
    ASSERT_EQ(whole.wait(), 0) << whole.err();
    EXPECT_THAT(whole.out(), HasSubstr("sewn    "));
    for (const char* file : {"assembly/steps.csv", "assembly/report.json", "assembly/cloth.obj", "steps.csv",
                             "frames/cloth_00000.ply"})
        EXPECT_TRUE(std::filesystem::exists(folder / "one" + "/" + file)) << file;
    const CsvTable steps = read_csv(folder / "one" + "/assembly/steps.csv");
    EXPECT_GT(steps.column("open_pairs").front(), 0.0);
    EXPECT_EQ(steps.column("open_pairs").back(), 0.0);

    Program killed(folder, {"run", scene, "-o", folder / "two", "--threads", "8"});
    int restarts = 0;
    for (int status = killed.stop_after(std::chrono::milliseconds(250), SIGKILL); status != 0; ++restarts) {
        ASSERT_LT(restarts, 50);
        if (!std::filesystem::exists(folder / "two" + "/assembly/checkpoint")) break;
        Program resumed(folder, {"resume", folder / "two"});
        status = resumed.stop_after(std::chrono::milliseconds(restarts < 4 ? 400 : 20000), SIGKILL);
    }
    expect_same_run(folder / "one", folder / "two");
}

TEST_F(AssemblyRun, InterruptedTellsHowToGoOn)
{
    const std::string scene = write(kTube);
    Program program(folder, {"run", scene, "-o", folder / "cut"});
    if (program.stop_after(std::chrono::milliseconds(400), SIGINT) == 0) GTEST_SKIP() << "too fast to stop";
    EXPECT_THAT(program.out(), testing::HasSubstr("/cut\n"));
    EXPECT_THAT(program.out(), testing::Not(HasSubstr("cut/assembly\n")));
    Program within(folder, {"resume", folder / "cut" + "/assembly"});
    EXPECT_EQ(within.wait(), 2);
    EXPECT_THAT(within.err(), HasSubstr("is the sewing of a run's cloth; allowed: "));
    Program further(folder, {"resume", folder / "cut"});
    EXPECT_EQ(further.wait(), 0) << further.err();
}

TEST_F(AssemblyRun, AloneLeavesAFileThatIsAClothOfItsOwn)
{
    const std::string scene = write(kTube);
    Program program(folder, {"run", scene, "-o", folder / "sewn", "--assemble-only"});
    ASSERT_EQ(program.wait(), 0) << program.err();
    EXPECT_FALSE(std::filesystem::exists(folder / "sewn" + "/frames/cloth_00000.ply"));
    std::ofstream(folder / "worn.toml") << "duration = 0.01\n[cloth]\nfile = \"sewn/assembly/cloth.obj\"\n"
                                           "[gravity]\n[self_contact]\n[output]\nformats = []\n";
    const RunConfig worn = load_scene(read_scene_source(folder / "worn.toml", {}), with_program());
    EXPECT_TRUE(worn.cloth.has_seams());
    EXPECT_EQ(euler_characteristic(worn.cloth), 0);
    Program further(folder, {"resume", folder / "sewn"});
    EXPECT_EQ(further.wait(), 0) << further.err();
    EXPECT_TRUE(std::filesystem::exists(folder / "sewn" + "/frames/cloth_00000.ply"));
    Program none(folder, {"run", folder / "worn.toml", "-o", folder / "none", "--assemble-only"});
    EXPECT_EQ(none.wait(), 2);
    EXPECT_THAT(none.err(), HasSubstr("has no seams that are open"));
}

TEST_F(AssemblyRun, StitchesOfAFileAreTies)
{
    // Two squares, 5 cm apart; the left one has a vertex in the middle of its side.
    std::ofstream(folder / "two.obj")
        << "v 0 0 1\nv .1 0 1\nv .1 .1 1\nv 0 .1 1\nv .15 0 1\nv .25 0 1\nv .25 .1 1\nv .15 .1 1\nv .1 .05 "
           "1\n"
           "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 2 0\nvt 3 0\nvt 3 1\nvt 2 1\nvt 1 .5\n"
           "f 1/1 2/2 9/9\nf 1/1 9/9 4/4\nf 9/9 3/3 4/4\nf 5/5 6/6 7/7\nf 5/5 7/7 8/8\n"
           "seam 3\nstitch 1 4 7 0\nstitch 8 4 7 0.5\nstitch 2 4 7 1\n";
    std::ofstream(folder / "two.toml") << "duration = 0.05\n[cloth]\nfile = \"two.obj\"\nuv_scale = 0.1\n"
                                          "[cloth.material]\nthickness = 0.001\n[self_contact]\n[gravity]\n"
                                          "[output]\nformats = []\n";
    Program program(folder, {"run", folder / "two.toml", "-o", folder / "two"});
    ASSERT_EQ(program.wait(), 0) << program.err();
    const CsvTable steps = read_csv(folder / "two" + "/assembly/steps.csv");
    EXPECT_EQ(steps.column("open_pairs").front(), 3.0);
    EXPECT_EQ(steps.column("open_pairs").back(), 0.0);
    EXPECT_EQ(steps.column("vertices").back(), 10.0) << "one edge is divided";
    EXPECT_EQ(read_csv(folder / "two" + "/steps.csv").column("open_pairs").back(), 0.0);
}

TEST_F(AssemblyRun, UnsewnIsTheStatusOfTheRun)
{
    const std::string scene = write(kTube + "[[obstacle]]\nname = \"wall\"\nbox = [0.4, 0.02, 1.0]\n");
    Program program(folder, {"run", scene, "-o", folder / "open"});
    EXPECT_EQ(program.wait(), 1);
    EXPECT_THAT(program.err(), HasSubstr("arris: unsewn: 2 seams did not close"));
    EXPECT_EQ(nlohmann::json::parse(read_bytes(folder / "open" + "/report.json"))["status"], "unsewn");
    // Kept as ties, the cloth goes on as it is.
    Program keeping(folder, {"run", scene, "-o", folder / "kept", "--set", "cloth.assembly.unsewn=keep"});
    EXPECT_EQ(keeping.wait(), 0) << keeping.err();
    EXPECT_THAT(keeping.err(), HasSubstr("did not close"));
}

}  // namespace
}  // namespace arris
