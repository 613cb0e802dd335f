// SPDX-License-Identifier: GPL-3.0-or-later
// Whole runs with the program itself.
#include "app/run/run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <sstream>

#include "app/files/csv_table.h"
#include "app/files/frame.h"
#include "app/run/checkpoint.h"
#include "solver/velocity_solve/blas_kernel.h"
#include "tests/app/program.h"
#include "tests/app/same_run.h"

namespace arris {
namespace {

namespace fs = std::filesystem;

constexpr const char* kScene = R"(
title = "Flag"
duration = 0.5
[cloth]
size = [1.0, 0.6]
resolution = [8, 5]
rotate = { axis = [1, 0, 0], degrees = 90 }
[cloth.material]
damping = 0.001
[[pin]]
material = [[0, 0], [0, 0.6]]
angular_velocity = [0, 0, 1]
release = 0.4
[[pull]]
material = [[1, 0.6], [1, 0.6]]
force = [0, 0, -0.1]
start = 0.1
stop = 0.21
[gravity]
[wind]
velocity = [2, 1, 0]
gust = { amplitude = 0.5, frequency = 2, seed = 3 }
[[probe]]
name = "tip"
material = [1, 0]
[output]
formats = ["obj", "usd", "viewer"]
)";

class Run : public testing::Test {
  protected:
    Run() { write_bytes(scene, kScene); }

    std::string run_through(const std::string& name, const std::vector<std::string>& more = {})
    {
        std::vector<std::string> arguments = {"run", scene, "-o", folder / name};
        arguments.insert(arguments.end(), more.begin(), more.end());
        Program program(folder, arguments);
        EXPECT_EQ(program.wait(), 0) << program.err();
        return folder / name;
    }

    TemporaryDirectory folder;
    std::string scene = folder / "scene.toml";
};

TEST_F(Run, LeavesEveryFileOfTheContract)
{
    const std::string dir = run_through("through");
    for (const char* name :
         {"steps.csv", "probes.csv", "report.json", "report.html", "viewer.html", "cloth.usda", "checkpoint",
          "frames/cloth_00000.ply", "frames/cloth_00012.ply", "frames/cloth_00012.obj"})
        EXPECT_TRUE(fs::is_regular_file(fs::path(dir) / name)) << name;
    EXPECT_FALSE(fs::exists(fs::path(dir) / "frames/cloth_00013.ply"));

    const nlohmann::json report = nlohmann::json::parse(read_bytes(dir + "/report.json"));
    EXPECT_EQ(report["status"], "finished");
    EXPECT_EQ(report["effects"], nlohmann::json({"bending", "damping", "gravity", "wind", "pull", "pin"}));
    const CsvTable steps = read_csv(dir + "/steps.csv");
    EXPECT_EQ(report["steps"].get<std::size_t>() + 1, steps.row_count());
    EXPECT_EQ(steps.column("time").back(), 0.5);
    // A row for each planned step, also where it starts with a third of itself: at first, and after jumps.
    EXPECT_EQ(report["halved_steps"], 0);
    for (std::size_t k = 1; k < steps.row_count(); ++k) {
        EXPECT_EQ(steps.column("step")[k], static_cast<double>(k));
        EXPECT_NEAR(steps.column("time")[k] - steps.column("time")[k - 1], steps.column("dt")[k], 1e-12);
        EXPECT_GT(steps.column("dt")[k], 0.0016);  // the shortest interval; a third of a step is less
    }
    EXPECT_LE(report["max_kkt_residual"].get<double>(), 1e-9);
    for (const double area : steps.column("material_area")) EXPECT_NEAR(area, 0.6, 0.6e-12);

    // The probe sits on a vertex: the last frame has it where probes.csv says.
    const CsvTable probes = read_csv(dir + "/probes.csv");
    EXPECT_EQ(probes.row_count(), steps.row_count());
    const Frame last = read_frame(dir + "/frames/cloth_00012.ply");
    for (std::size_t v = 0; v < last.world.size(); ++v)
        if (last.material[v] == Vec2(1, 0)) {
            EXPECT_DOUBLE_EQ(last.world[v].x(), probes.column("tip_x").back());
            EXPECT_DOUBLE_EQ(last.vertex_velocity[v].z(), probes.column("tip_vz").back());
        }
}

TEST_F(Run, AnAbsentEffectHasEmptyColumns)
{
    write_bytes(
        scene,
        "duration = 0.02\n[cloth]\nsize=[1,1]\nresolution=[2,2]\n[cloth.material]\nbending_stiffness=0\n");
    const CsvTable steps = read_csv(run_through("bare") + "/steps.csv");
    for (const char* column : {"gravity_energy", "bending_energy", "eol_vertices", "feature_rows"})
        for (const double cell : steps.column(column)) EXPECT_TRUE(std::isnan(cell)) << column;
    for (const double cell : steps.column("kinetic_energy")) EXPECT_EQ(cell, 0.0);
}

TEST_F(Run, ResumedAtItsEndSaysThatNothingIsLeftAndHowToGoOn)
{
    const std::string dir = run_through("through", {"--quiet"});
    const std::string steps = read_bytes(dir + "/steps.csv");
    Program resumed(folder, {"resume", dir});
    EXPECT_EQ(resumed.wait(), 0) << resumed.err();
    EXPECT_EQ(resumed.out().rfind("nothing to do: the run has reached its end, t = 0.5 s\n", 0), 0U)
        << resumed.out();
    EXPECT_NE(resumed.out().find("arris resume " + dir + " --until T"), std::string::npos) << resumed.out();
    EXPECT_NE(resumed.out().find("another rate needs a new run: " ARRIS_PROGRAM
                                 " run SCENE --set output.frames_per_second=N"),
              std::string::npos)
        << resumed.out();
    EXPECT_TRUE(read_bytes(dir + "/steps.csv") == steps);
    Program further(folder, {"resume", dir, "--until", "0.51"});
    EXPECT_EQ(further.wait(), 0) << further.err();
    EXPECT_EQ(further.out().find("nothing to do"), std::string::npos) << further.out();
    Program quiet(folder, {"resume", dir, "--quiet"});
    EXPECT_EQ(quiet.wait(), 0);
    EXPECT_EQ(quiet.out() + quiet.err(), "");
}

TEST_F(Run, IsBitIdenticalForAnyNumberOfThreads)
{
    const std::string one = run_through("one", {"--threads", "1"});
    expect_same_run(one, run_through("two", {"--threads", "2"}));
    expect_same_run(one, run_through("four", {"--threads", "4"}));
}

TEST_F(Run, KilledAtRandomMomentsAndResumedItIsTheSameRun)
{
    const std::string through = run_through("through");
    std::mt19937 random(5);
    int kills = 0;
    for (int trial = 0; trial < 3; ++trial) {
        const std::string dir = folder / ("killed" + std::to_string(trial));
        std::vector<std::string> arguments = {"run", scene, "-o", dir};
        for (int part = 0; part < 100; ++part) {
            Program program(folder, arguments);
            const int delay = std::uniform_int_distribution<int>(20, 60 + 40 * part)(random);
            const int status = program.stop_after(std::chrono::milliseconds(delay), SIGKILL);
            if (status == 0) break;
            ASSERT_EQ(status, -SIGKILL) << program.err();
            ++kills;
            arguments = fs::exists(dir + "/checkpoint")
                            ? std::vector<std::string>{"resume", dir}
                            : std::vector<std::string>{"run", scene, "-o", dir, "--overwrite"};
        }
        expect_same_run(through, dir);
    }
    EXPECT_GT(kills, 3);
}

TEST_F(Run, CtrlCLeavesACheckpointToGoOnFrom)
{
    const std::string through = run_through("through", {"--set", "duration=2"});
    const std::string dir = folder / "stopped";
    Program program(folder, {"run", scene, "-o", dir, "--set", "duration=2"});
    for (int k = 0; k < 20000 && !fs::exists(dir + "/frames/cloth_00002.ply"); ++k)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_EQ(program.stop_after(std::chrono::milliseconds(0), SIGINT), 130);
    EXPECT_NE(program.err().find("interrupted"), std::string::npos);
    EXPECT_EQ(nlohmann::json::parse(read_bytes(dir + "/report.json"))["status"], "interrupted");
    EXPECT_TRUE(fs::exists(dir + "/viewer.html"));

    Program resumed(folder, {"resume", dir});
    EXPECT_EQ(resumed.wait(), 0) << resumed.err();
    expect_same_run(through, dir);
}

TEST_F(Run, ResumedWithAnotherBlasKernelItSaysSoOnce)
{
    const std::string dir = run_through("through");
    EXPECT_EQ(nlohmann::json::parse(read_bytes(dir + "/report.json"))["blas_kernel"], blas_kernel());
    Checkpoint checkpoint = read_checkpoint(dir + "/checkpoint");
    EXPECT_EQ(checkpoint.kernel, blas_kernel());
    checkpoint.kernel = "Another";
    write_checkpoint(dir + "/checkpoint", checkpoint);
    const std::string line =
        "from t = 0.5 s on computed with the BLAS kernel " + blas_kernel() +
        ", before with Another: the result may differ from that of a run without a stop; "
        "OPENBLAS_CORETYPE=Another in the environment keeps the kernel";
    for (const char* until : {"0.51", "0.52"}) {
        Program resumed(folder, {"resume", dir, "--until", until});
        ASSERT_EQ(resumed.wait(), 0) << resumed.err();
        EXPECT_NE(resumed.err().find("warning: " + line + "\n"), std::string::npos) << resumed.err();
        const nlohmann::json report = nlohmann::json::parse(read_bytes(dir + "/report.json"));
        EXPECT_EQ(report["blas_kernel"], blas_kernel());
        EXPECT_EQ(std::count(report["warnings"].begin(), report["warnings"].end(), line), 1);
    }
}

TEST_F(Run, RemeshedItIsTheSameRunResumedAndOnAnyNumberOfThreads)
{
    const std::vector<std::string> remeshed = {"--set", "remesh.edge_length=[0.02, 0.3]", "--set",
                                               "remesh.angle=10"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.end(), remeshed.begin(), remeshed.end());
        return more;
    };
    const std::string through = run_through("through", with({"--threads", "1"}));
    double operations = 0.0;
    const CsvTable steps = read_csv(through + "/steps.csv");
    for (const double n : steps.column("remeshed")) operations += n;
    EXPECT_GT(operations, 20.0);
    expect_same_run(through, run_through("two", with({"--threads", "2"})));
    const std::string dir = run_through("parts", with({"--set", "duration=0.25"}));
    Program resumed(folder, {"resume", dir, "--until", "0.5"});
    EXPECT_EQ(resumed.wait(), 0) << resumed.err();
    for (const char* file : {"frames/cloth_00007.ply", "frames/cloth_00012.ply"})
        EXPECT_TRUE(read_bytes(through + "/" + file) == read_bytes(dir + "/" + file)) << file;
    EXPECT_EQ(read_csv(through + "/steps.csv").column("remesh_energy"),
              read_csv(dir + "/steps.csv").column("remesh_energy"));
}

TEST_F(Run, WithSeveralPiecesItIsTheSameRunResumedAndOnAnyNumberOfThreads)
{
    write_bytes(scene, R"(
duration = 0.3
[[cloth]]
name = "below"
size = [0.4, 0.4]
resolution = [8, 8]
translate = [-0.2, -0.2, 0.02]
[[cloth]]
name = "above"
size = [0.3, 0.3]
resolution = [5, 5]
translate = [-0.15, -0.1, 0.05]
material = { preset = "denim", friction = 0.6 }
[gravity]
[friction]
[self_contact]
[[pin]]
piece = "above"
material = [[0.0, 0.0], [0.0, 0.0]]
release = 0.2
[[obstacle]]
box = [0.25, 0.25, 0.1]
translate = [0.0, 0.0, -0.05]
[output]
formats = ["obj", "usd", "vtk", "gltf"]
)");
    const std::string through = run_through("through", {"--threads", "1"});
    expect_same_run(through, run_through("two", {"--threads", "2"}));
    const std::string dir = run_through("parts", {"--set", "duration=0.25"});
    Program resumed(folder, {"resume", dir, "--until", "0.3"});
    EXPECT_EQ(resumed.wait(), 0) << resumed.err();
    for (const char* file : {"frames/cloth_00003.ply", "frames/cloth_00007.ply"})
        EXPECT_TRUE(read_bytes(through + "/" + file) == read_bytes(dir + "/" + file)) << file;
    const std::string obj = read_bytes(through + "/frames/cloth_00000.obj");
    EXPECT_NE(obj.find("\ng below\nf "), std::string::npos);
    EXPECT_NE(obj.find("\ng above\nf "), std::string::npos);
    const std::string usd = read_bytes(through + "/cloth.usda");
    EXPECT_NE(usd.find("def GeomSubset \"above\""), std::string::npos);
}

TEST_F(Run, OfSewnClothItIsTheSameRunResumed)
{
    fs::copy(fs::path(ARRIS_SOURCE_DIR) / "data/meshes/sleeve.obj", fs::path(folder / "sleeve.obj"));
    write_bytes(scene, R"(
duration = 0.3
[cloth]
file = "sleeve.obj"
translate = [-0.25, 0.0, 0.2]
[gravity]
[friction]
[self_contact]
[[obstacle]]
box = [0.3, 0.3, 0.1]
[output]
formats = ["obj", "usd", "vtk", "gltf", "pc2"]
)");
    const std::string through = run_through("through", {"--threads", "1"});
    expect_same_run(through, run_through("two", {"--threads", "2"}));
    const std::string dir = run_through("parts", {"--set", "duration=0.25"});
    fs::remove(folder / "sleeve.obj");
    Program resumed(folder, {"resume", dir, "--until", "0.3"});
    EXPECT_EQ(resumed.wait(), 0) << resumed.err();
    for (const char* file : {"frames/cloth_00003.ply", "frames/cloth_00007.ply"})
        EXPECT_TRUE(read_bytes(through + "/" + file) == read_bytes(dir + "/" + file)) << file;
    const std::string obj = read_bytes(through + "/frames/cloth_00007.obj");
    const auto count = [&](const std::string& word) {
        std::size_t n = 0;
        for (std::size_t at = obj.find(word); at != std::string::npos; at = obj.find(word, at + 1)) ++n;
        return n;
    };
    // One vertex at each place and two points at those of the seam, which have changed a little at the box's
    // edges.
    const auto vertices = static_cast<int>(count("\nv ")), points = static_cast<int>(count("\nvt "));
    EXPECT_NEAR(vertices, 26 * 21, 26);
    EXPECT_NEAR(points - vertices, 21, 5);
}

TEST_F(Run, AStepThatCtrlCCutsOffCountsInTheSeconds)
{
    const std::string dir = folder / "stopped";
    Program program(folder, {"run", scene, "-o", dir, "--set", "cloth.resolution=[160, 100]"});  // slow steps
    for (int k = 0; k < 60000 && !fs::exists(dir + "/checkpoint"); ++k)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    constexpr double kWithin = 0.15;  // s, of the first step
    ASSERT_EQ(program.stop_after(std::chrono::milliseconds(static_cast<int>(1e3 * kWithin)), SIGINT), 130);
    const nlohmann::json report = nlohmann::json::parse(read_bytes(dir + "/report.json"));
    const CsvTable steps = read_csv(dir + "/steps.csv");
    double of_rows = 0.0;
    for (const double seconds : steps.column("advance_s")) of_rows += seconds;
    EXPECT_EQ(steps.row_count(), 1u) << "the first step was cut off";
    EXPECT_GT(report["phases"]["advance"].get<double>() - of_rows, 0.5 * kWithin);
    double sum = 0.0;
    for (const auto& phase : report["phases"]) sum += phase.get<double>();
    EXPECT_NEAR(report["wall_seconds"].get<double>(), sum, 1e-9 * sum);
}

TEST_F(Run, UntilGoesOnPastTheEnd)
{
    const std::string dir = run_through("through");
    Program program(folder, {"resume", dir, "--until", "0.75"});
    EXPECT_EQ(program.wait(), 0) << program.err();
    EXPECT_EQ(read_csv(dir + "/steps.csv").column("time").back(), 0.75);
    EXPECT_TRUE(fs::exists(dir + "/frames/cloth_00018.ply"));
    Program back(folder, {"resume", dir, "--until", "0.6"});
    EXPECT_EQ(back.wait(), 2);
    EXPECT_NE(back.err().find("--until 0.6"), std::string::npos) << back.err();
}

TEST_F(Run, UntilInTheMiddleOfAnIntervalIsTheRunOfThatDuration)
{
    const std::string through = run_through("through", {"--set", "duration=0.75"});
    const std::string dir = folder / "stopped";
    Program program(folder, {"run", scene, "-o", dir, "--set", "duration=5"});
    for (int k = 0; k < 20000 && !fs::exists(dir + "/frames/cloth_00002.ply"); ++k)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_EQ(program.stop_after(std::chrono::milliseconds(7), SIGINT), 130);
    Program resumed(folder, {"resume", dir, "--until", "0.75"});
    ASSERT_EQ(resumed.wait(), 0) << resumed.err();
    for (const char* file :
         {"probes.csv", "frames/cloth_00003.ply", "frames/cloth_00010.ply", "frames/cloth_00018.ply"})
        EXPECT_TRUE(read_bytes(through + "/" + file) == read_bytes(dir + "/" + file)) << file;
}

TEST_F(Run, AConstantForceThatStartsAndStopsMovesFreeClothAsNewtonSays)
{
    // Each jump restarts the integrator: implicit Euler is ahead by a h^2 / 2 in the step after it, and BDF2
    // exact from there for constant force. Without the restart the jump would be smeared over both steps.
    write_bytes(scene,
                "duration = 1\n[time]\nstep = 0.01\n[cloth]\nsize = [1, 1]\nresolution = [1, 1]\n"
                "[cloth.material]\ndensity = 0.5\n[[pull]]\nmaterial = [[0, 0], [1, 1]]\nforce = [0, 0, 2]\n"
                "start = 0.2\nstop = 0.6\n[[probe]]\nname = \"p\"\nmaterial = [0.5, 0.5]\n"
                "[output]\nframes_per_second = 0\nformats = []\n");
    const CsvTable probes = read_csv(run_through("pulled") + "/probes.csv");
    const std::vector<double>& time = probes.column("time");
    const double a = 4.0, h = 0.01;
    for (std::size_t k = 0; k < time.size(); ++k) {
        const double acting = std::clamp(time[k] - 0.2, 0.0, 0.4), after = std::max(time[k] - 0.6, 0.0);
        const double exact = 0.5 * a * acting * acting + a * 0.4 * after;
        EXPECT_NEAR(probes.column("p_vz")[k], a * acting, 1e-12) << time[k];
        EXPECT_NEAR(probes.column("p_z")[k], exact, 0.76 * a * h * h) << time[k];
    }
}

TEST_F(Run, TwoProcessesDoNotWriteOneRun)
{
    const std::string dir = folder / "shared";
    Program first(folder, {"run", scene, "-o", dir, "--set", "duration=20"});
    for (int k = 0; k < 20000 && !fs::exists(dir + "/frames/cloth_00001.ply"); ++k)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    Program second(folder, {"resume", dir}, "second");
    EXPECT_EQ(second.wait(), 2);
    EXPECT_NE(second.err().find("another arris"), std::string::npos) << second.err();
    EXPECT_EQ(first.stop_after(std::chrono::milliseconds(0), SIGTERM), 130) << first.err();
}

TEST_F(Run, FilesOfTheUserStayInTheFramesFolder)
{
    const std::string dir = run_through("through");
    write_bytes(dir + "/frames/render_0007.png", "mine");
    write_bytes(dir + "/frames/photo_2024.jpg", "mine");
    Program over(folder, {"run", scene, "-o", dir, "--overwrite", "--set", "duration=0.1"});
    EXPECT_EQ(over.wait(), 0) << over.err();
    EXPECT_EQ(read_bytes(dir + "/frames/render_0007.png"), "mine");
    EXPECT_EQ(read_bytes(dir + "/frames/photo_2024.jpg"), "mine");
}

TEST_F(Run, AFolderWithARunIsRefusedWithoutOverwrite)
{
    const std::string dir = run_through("through");
    write_bytes(dir + "/notes.txt", "mine");
    Program again(folder, {"run", scene, "-o", dir});
    EXPECT_EQ(again.wait(), 2);
    EXPECT_NE(again.err().find("--overwrite"), std::string::npos) << again.err();
    Program over(folder, {"run", scene, "-o", dir, "--overwrite", "--set", "duration=0.1"});
    EXPECT_EQ(over.wait(), 0) << over.err();
    EXPECT_FALSE(fs::exists(dir + "/frames/cloth_00005.ply")) << "frames of the earlier run";
    EXPECT_EQ(read_bytes(dir + "/notes.txt"), "mine");
}

TEST_F(Run, ThatObstaclesCrushNamesAVertexByItsPlace)
{
    write_bytes(
        scene,
        "duration = 1\n[cloth]\nsize = [0.5, 0.5]\nresolution = [4, 4]\ntranslate = [-0.25, -0.25, 0.11]\n"
        "[gravity]\n[[obstacle]]\nbox = [0.3, 0.3, 0.2]\n[[obstacle]]\nbox = [0.3, 0.3, 0.1]\n"
        "translate = [0, 0, 0.3]\nmotion = {velocity = [0, 0, -1]}\n");
    Program program(folder, {"run", scene, "-o", folder / "overconstrained"});
    EXPECT_NE(program.wait(), 0);
    const nlohmann::json report = nlohmann::json::parse(read_bytes(folder / "overconstrained/report.json"));
    EXPECT_EQ(report["status"], "infeasible");
    const std::string message = report["message"];
    EXPECT_TRUE(std::regex_search(
        message,
        std::regex(
            "keeps vertex \\d+, at \\[.*\\] \\(m, material \\[.*\\]\\), out of obstacle0 and obstacle1 in "
            "the step after t = 0.1")))
        << message;
}

TEST_F(Run, ThatFailsAfterTheOpeningOfItsFirstStepTellsThat)
{
    // The pin presses the cloth to its least thickness on the floor after a third of the step.
    write_bytes(
        scene,
        "duration = 0.1\n[cloth]\nsize = [0.2, 0.2]\nresolution = [2, 2]\ntranslate = [-0.1, -0.1, 0.05]\n"
        "[gravity]\n[[pin]]\nmaterial = [[0.1, 0.1], [0.1, 0.1]]\nvelocity = [0, 0, -1]\n"
        "[[obstacle]]\nbox = [2, 2, 0.1]\ntranslate = [0, 0, -0.00157]\n");
    const std::string dir = folder / "fails";
    Program program(folder, {"run", scene, "-o", dir});
    EXPECT_NE(program.wait(), 0);
    const nlohmann::json report = nlohmann::json::parse(read_bytes(dir + "/report.json"));
    EXPECT_EQ(report["status"], "infeasible");
    EXPECT_EQ(report["steps"], 1);
    const CsvTable steps = read_csv(dir + "/steps.csv");
    ASSERT_EQ(steps.row_count(), 2u);
    EXPECT_NEAR(steps.column("time")[1], 0.0046296 / 3.0, 1e-6);
    EXPECT_EQ(steps.column("halved")[1], 1.0);
}

TEST_F(Run, NumbersThatOverflowEndItWithItsStateKept)
{
    const std::string dir = folder / "wild";
    Program program(folder, {"run", scene, "-o", dir, "--set", "cloth.material.density=1e-300", "--set",
                             "cloth.material.youngs_modulus=1e-300", "--set", "pull.0.force=[0,0,1e9]"});
    EXPECT_EQ(program.wait(), 1) << program.err();
    const nlohmann::json report = nlohmann::json::parse(read_bytes(dir + "/report.json"));
    EXPECT_EQ(report["status"], "not_converged") << report["message"];
    EXPECT_NE(report["message"].get<std::string>().find("step"), std::string::npos);
    EXPECT_TRUE(fs::exists(dir + "/checkpoint"));
    EXPECT_TRUE(fs::exists(dir + "/viewer.html"));
}

constexpr const char* kTableScene = R"(
duration = 0.4
[cloth]
size = [1, 1]
resolution = [6, 6]
translate = [-0.5, -0.5, 0.16]
[gravity]
[[pin]]
material = [[0, 0], [0, 1]]
follow = "table"
[[obstacle]]
name = "table"
file = "table.obj"
motion = { velocity = [0.1, 0, 0.05], angular_velocity = [0, 0, 0.3], start = 0.05, stop = 0.3 }
[[obstacle]]
name = "nail"
points = [[0.4, 0.4, 0]]
[[obstacle]]
name = "rope"
wire = [[-1, -0.45, 0.1], [1, -0.45, 0.1]]
[output]
formats = ["obj", "usd", "viewer"]
)";

/// A box of 0.6 x 0.6 x 0.3 m as twelve triangles.
constexpr const char* kTable =
    "v -0.3 -0.3 -0.15\nv 0.3 -0.3 -0.15\nv 0.3 0.3 -0.15\nv -0.3 0.3 -0.15\n"
    "v -0.3 -0.3 0.15\nv 0.3 -0.3 0.15\nv 0.3 0.3 0.15\nv -0.3 0.3 0.15\n"
    "f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 "
    "5 8\n";

class RunWithObstacles : public Run {
  protected:
    RunWithObstacles()
    {
        write_bytes(scene, kTableScene);
        write_bytes(folder / "table.obj", kTable);
    }
};

/// The `v` lines of an OBJ file.
std::vector<Vec3> obj_points(const std::string& path)
{
    std::ifstream in(path);
    std::vector<Vec3> points;
    std::string word;
    for (std::string line; std::getline(in, line);) {
        std::istringstream cells(line);
        Vec3 p;
        if (cells >> word >> p[0] >> p[1] >> p[2] && word == "v") points.push_back(p);
    }
    return points;
}

TEST_F(RunWithObstacles, LeavesThemInEveryFormatAndInTheReport)
{
    const std::string dir = run_through("through");
    const nlohmann::json report = nlohmann::json::parse(read_bytes(dir + "/report.json"));
    EXPECT_EQ(report["status"], "finished") << report["message"];
    EXPECT_EQ(report["effects"], nlohmann::json({"bending", "gravity", "pin", "obstacle", "eol"}));
    EXPECT_EQ(report["max_penetration"], 0.0);
    EXPECT_EQ(report["crossings"], 0);

    const CsvTable steps = read_csv(dir + "/steps.csv");
    double most_contacts = 0.0, most_feature_rows = 0.0;
    for (std::size_t k = 0; k < steps.row_count(); ++k) {
        EXPECT_EQ(steps.column("max_penetration")[k], 0.0);
        EXPECT_EQ(steps.column("crossings")[k], 0.0);
        EXPECT_LE(steps.column("feature_rows")[k], steps.column("contacts")[k]);
        most_contacts = std::max(most_contacts, steps.column("contacts")[k]);
        most_feature_rows = std::max(most_feature_rows, steps.column("feature_rows")[k]);
        if (k > 0) {
            EXPECT_GE(steps.column("solves")[k], 1.0);
        }
    }
    EXPECT_GT(most_contacts, 5.0);
    EXPECT_GT(most_feature_rows, 0.0);

    EXPECT_TRUE(fs::exists(dir + "/frames/table_00009.obj"));
    EXPECT_TRUE(fs::exists(dir + "/frames/nail_00000.obj"));
    EXPECT_FALSE(fs::exists(dir + "/frames/nail_00001.obj"));
    EXPECT_FALSE(fs::exists(dir + "/frames/rope_00001.obj"));
    EXPECT_NE(read_bytes(dir + "/cloth.usda").find("def Xform \"table\""), std::string::npos);
    EXPECT_NE(read_bytes(dir + "/viewer.html").find("\"name\":\"rope\""), std::string::npos);
}

TEST_F(RunWithObstacles, TheirFramesAreWhereTheirMotionHasThem)
{
    const std::string dir = run_through("through");
    const std::vector<Vec3> first = obj_points(dir + "/frames/table_00000.obj"),
                            last = obj_points(dir + "/frames/table_00009.obj");
    ASSERT_EQ(last.size(), 8U);
    const double tau = 0.25;  // start to stop
    for (std::size_t i = 0; i < 8; ++i) {
        const double c = std::cos(0.3 * tau), s = std::sin(0.3 * tau);
        const Vec3 turned(c * first[i].x() - s * first[i].y(), s * first[i].x() + c * first[i].y(),
                          first[i].z());
        EXPECT_NEAR((last[i] - turned - tau * Vec3(0.1, 0.0, 0.05)).norm(), 0.0, 1e-14);
    }
    EXPECT_EQ(obj_points(dir + "/frames/nail_00000.obj"), std::vector<Vec3>{Vec3(0.4, 0.4, 0.0)});

    // The pin rides along: distances between what it holds and the table do not change.
    const Frame begin = read_frame(dir + "/frames/cloth_00000.ply"),
                end = read_frame(dir + "/frames/cloth_00009.ply");
    for (std::size_t v = 0; v < begin.world.size(); ++v) {
        if (begin.material[v].x() > 0.0) continue;
        const auto same = std::find(end.material.begin(), end.material.end(), begin.material[v]);
        ASSERT_NE(same, end.material.end()) << "what a pin holds stays a vertex";
        const Vec3& held = end.world[same - end.material.begin()];
        for (std::size_t i = 0; i < 8; ++i)
            EXPECT_NEAR((held - last[i]).norm(), (begin.world[v] - first[i]).norm(), 1e-14);
    }
}

TEST_F(RunWithObstacles, KilledAndResumedWithoutTheMeshFileItIsTheSameRun)
{
    const std::string through = run_through("through", {"--threads", "2"});
    const std::string dir = folder / "killed";
    for (int trial = 0; trial < 3 && !fs::exists(dir + "/report.json"); ++trial) {
        Program program(folder, {"run", scene, "-o", dir, "--overwrite"});
        for (int k = 0; k < 20000 && !fs::exists(dir + "/frames/cloth_00003.ply"); ++k)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        program.stop_after(std::chrono::milliseconds(0), SIGKILL);
    }
    write_bytes(folder / "table.obj", "v 0 0 0\n");  // another file by now
    Program resumed(folder, {"resume", dir, "--threads", "1"});
    EXPECT_EQ(resumed.wait(), 0) << resumed.err();
    expect_same_run(through, dir);
}

// A napkin falls over the rim of a table. At 0.35 s a part of it that lies across the rim is picked up.
constexpr const char* kPickedUp = R"(
duration = 0.6
[cloth]
size = [0.5, 0.5]
resolution = [12, 12]
translate = [-0.25, -0.25, 0.01]
[cloth.material]
damping = 0.005
[gravity]
[[obstacle]]
box = [0.3, 0.3, 0.1]
translate = [0, 0, -0.055]
[[pin]]
material = [[0.3, 0.15], [0.46, 0.35]]
start = 0.35
velocity = [0, 0, 0.5]
[output]
frames_per_second = 20
formats = []
)";

TEST_F(Run, ClothOnARimIsPickedUpWhereItLies)
{
    write_bytes(scene, kPickedUp);
    const std::string dir = run_through("through");
    const auto in_box = [](const Frame& frame, std::size_t v) {
        const Vec2& X = frame.material[v];
        return X.x() >= 0.3 && X.x() <= 0.46 && X.y() >= 0.15 && X.y() <= 0.35;
    };
    const auto count_eol = [&](const Frame& frame) {
        int count = 0;
        for (std::size_t v = 0; v < frame.eol.size(); ++v)
            count += frame.eol[v] > 0 && in_box(frame, v) ? 1 : 0;
        return count;
    };
    const auto read = [&](int k) {
        return read_frame(dir + "/frames/cloth_0000" + std::to_string(k) + ".ply");
    };
    EXPECT_GT(count_eol(read(6)), 1) << "before, the cloth there slides over the rim";
    const Frame start = read(7);
    for (const int k : {8, 9}) {
        const Frame later = read(k);
        EXPECT_EQ(count_eol(later), 0);
        int held = 0;
        for (std::size_t v = 0; v < start.ids.size(); ++v) {
            if (!in_box(start, v)) continue;
            const auto same = std::find(later.ids.begin(), later.ids.end(), start.ids[v]);
            ASSERT_NE(same, later.ids.end()) << "what a pin holds stays a vertex";
            const Vec3 exact = start.world[v] + Vec3(0, 0, 0.5 * 0.05 * (k - 7));
            EXPECT_LT((later.world[same - later.ids.begin()] - exact).norm(), 1e-14);
            ++held;
        }
        EXPECT_GT(held, 8);
    }
}

TEST_F(Run, APinThatStartsLaterIsTheSameAfterAResume)
{
    write_bytes(scene, kPickedUp);
    const std::string through = run_through("through");
    for (const std::string stop : {"0.2", "0.35", "0.45"}) {  // before the start, at it and after it
        const std::string dir = run_through("until " + stop, {"--set", "duration=" + stop});
        Program resumed(folder, {"resume", dir, "--until", "0.6", "--threads", "1"});
        ASSERT_EQ(resumed.wait(), 0) << resumed.err();
        EXPECT_EQ(timeless(through + "/steps.csv"), timeless(dir + "/steps.csv")) << stop;
        for (int k = 0; k <= 12; ++k) {
            const std::string frame =
                "/frames/cloth_000" + std::string(k < 10 ? "0" : "") + std::to_string(k) + ".ply";
            EXPECT_TRUE(read_bytes(through + frame) == read_bytes(dir + frame)) << stop << frame;
        }
    }
}

TEST_F(RunWithObstacles, WithoutItsStoredObstaclesARunIsNotResumed)
{
    const std::string dir = run_through("through");
    fs::remove(dir + "/obstacles");
    Program resumed(folder, {"resume", dir, "--until", "0.5"});
    EXPECT_EQ(resumed.wait(), 2);
    const std::string message = dir + "/obstacles is missing, in which the run stored its obstacles";
    EXPECT_NE(resumed.err().find(message), std::string::npos) << resumed.err();
    Program exported(folder, {"export", dir, "--formats", "usd"});
    EXPECT_EQ(exported.wait(), 0);
    EXPECT_NE(exported.err().find(dir + "/obstacles: is missing"), std::string::npos) << exported.err();
}

TEST_F(RunWithObstacles, FramesPastTheCheckpointAreCutBack)
{
    const std::string dir = run_through("through");
    write_bytes(dir + "/frames/table_00044.obj", "stale");
    write_bytes(dir + "/frames/chair_00044.obj", "mine");
    Program resumed(folder, {"resume", dir, "--until", "0.45"});
    EXPECT_EQ(resumed.wait(), 0) << resumed.err();
    EXPECT_FALSE(fs::exists(dir + "/frames/table_00044.obj"));
    EXPECT_TRUE(fs::exists(dir + "/frames/table_00010.obj"));
    EXPECT_EQ(read_bytes(dir + "/frames/chair_00044.obj"), "mine");
}

TEST_F(RunWithObstacles, OverwritingRemovesThoseOfTheEarlierRun)
{
    const std::string dir = run_through("through");
    write_bytes(
        scene,
        "duration = 0.05\n[cloth]\nsize = [1, 1]\nresolution = [2, 2]\n[output]\nformats = [\"obj\"]\n");
    run_through("through", {"--overwrite"});
    for (const auto& entry : fs::recursive_directory_iterator(dir))
        EXPECT_EQ(entry.path().filename().string().find("table"), std::string::npos) << entry.path();
    EXPECT_FALSE(fs::exists(dir + "/obstacles"));
}

TEST_F(RunWithObstacles, ExportMakesTheSameFilesWithoutSceneOrMesh)
{
    const std::string dir = run_through("through");
    const std::string frame = read_bytes(dir + "/frames/table_00007.obj"),
                      usd = read_bytes(dir + "/cloth.usda"), viewer = read_bytes(dir + "/viewer.html");
    fs::remove(dir + "/frames/table_00007.obj");
    fs::remove(dir + "/cloth.usda");
    fs::remove(scene);
    fs::remove(folder / "table.obj");
    fs::remove(dir + "/checkpoint");
    Program program(folder, {"export", dir, "--formats", "obj,usd,viewer"});
    EXPECT_EQ(program.wait(), 0) << program.err();
    EXPECT_TRUE(read_bytes(dir + "/frames/table_00007.obj") == frame);
    EXPECT_TRUE(read_bytes(dir + "/cloth.usda") == usd);
    EXPECT_TRUE(read_bytes(dir + "/viewer.html") == viewer);
}

TEST_F(RunWithObstacles, CheckAnswersWhatIntersectsAndRefuses)
{
    Program clear(folder, {"check", scene});
    EXPECT_EQ(clear.wait(), 0) << clear.err();
    EXPECT_NE(clear.out().find("the cloth is clear of all obstacles"), std::string::npos) << clear.out();

    Program program(folder, {"check", scene, "--set", "cloth.translate=[-0.5,-0.5,0.1]"});
    EXPECT_EQ(program.wait(), 2);
    EXPECT_NE(program.out().find("intersection: "), std::string::npos) << program.out();
    EXPECT_NE(program.out().find("expected: about"), std::string::npos) << "all else is said too";
    EXPECT_NE(program.err().find("m deep into table, at ["), std::string::npos) << program.err();
    EXPECT_EQ(program.out().find("m deep into table"), std::string::npos) << "it is said once";
    Program refused(folder,
                    {"run", scene, "-o", folder / "none", "--set", "cloth.translate=[-0.5,-0.5,0.1]"});
    EXPECT_EQ(refused.wait(), 2);
    EXPECT_FALSE(fs::exists(folder / "none"));
}

}  // namespace
}  // namespace arris
