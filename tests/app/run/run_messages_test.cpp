// SPDX-License-Identifier: GPL-3.0-or-later
// What a run, a resume and a refusal print, by the program itself.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "tests/app/program.h"

namespace arris {
namespace {

namespace fs = std::filesystem;

const std::string kFalling =
    "duration = 0.3\n[cloth]\nsize = [0.4, 0.4]\nresolution = [3, 3]\n[gravity]\n[[pin]]\nmaterial = [[0, "
    "0], [0, "
    "0.4]]\n";
const std::string kTable = "[[obstacle]]\nname = \"table\"\nbox = [2, 2, 0.2]\ntranslate = ";
const std::string kRod = "[[obstacle]]\nname = \"rod\"\nwire = [[0, -1, 1], [0, 1, 1]]\n";

struct Touch {
    std::string name, obstacles, told;  ///< told: names; "" without a warning
};

const Touch kTouches[] = {
    {"no obstacle", "", ""},
    {"lands on it", kTable + "[0, 0, -0.15]\n", ""},
    {"far from it", kTable + "[0, 0, -5]\n", "table; if it should have"},
    {"far from both", kTable + "[0, 0, -5]\n" + kRod, "table, rod; if it"},
    {"touches one", kTable + "[0, 0, -0.15]\n" + kRod, ""},
    {"a pin follows it", kRod + "[[pin]]\nmaterial = [[0.4, 0], [0.4, 0]]\nfollow = \"rod\"\n", ""},
};

TEST(RunMessages, NameObstaclesThatTheClothNeverTouched)
{
    for (const Touch& touch : kTouches) {
        SCOPED_TRACE(touch.name);
        const TemporaryDirectory folder;
        write_bytes(folder / "scene.toml", kFalling + touch.obstacles);
        Program program(folder, {"run", folder / "scene.toml", "-o", folder / "out", "--quiet"});
        ASSERT_EQ(program.wait(), 0) << program.err();
        const std::string line = "the cloth touched none of: " + touch.told;
        const auto report = nlohmann::json::parse(read_bytes(folder / "out/report.json"));
        EXPECT_EQ(program.err().find(line) != std::string::npos, !touch.told.empty()) << program.err();
        EXPECT_EQ(report["warnings"].dump().find(line) != std::string::npos, !touch.told.empty());
    }
}

/// Runs the scene in `folder` until its third frame and interrupts it.
void interrupt_run(const TemporaryDirectory& folder, const std::string& dir)
{
    write_bytes(folder / "scene.toml", kFalling);
    Program program(folder, {"run", folder / "scene.toml", "-o", dir, "--set", "duration=1", "--set",
                             "cloth.resolution=[20,20]", "--threads", "1"});
    for (int k = 0; k < 20000 && !fs::exists(dir + "/frames/cloth_00003.ply"); ++k)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_EQ(program.stop_after(std::chrono::milliseconds(0), SIGINT), 130);
    EXPECT_NE(program.out().find("resume  " ARRIS_PROGRAM " resume '" + dir + "'\n"), std::string::npos)
        << program.out();
}

TEST(RunMessages, LeadOnFromAnUnfinishedRun)
{
    const TemporaryDirectory folder;
    const std::string dir = folder / "my run";
    interrupt_run(folder, dir);
    const double time = nlohmann::json::parse(read_bytes(dir + "/report.json"))["simulated_seconds"];

    Program again(folder, {"run", folder / "scene.toml", "-o", dir});
    EXPECT_EQ(again.wait(), 2);
    EXPECT_EQ(again.err().find("arris: -o " + dir + ": holds a run already, unfinished at t = 0."), 0u)
        << again.err();
    EXPECT_NE(
        again.err().find(" s: " ARRIS_PROGRAM " resume '" + dir + "' continues it; allowed: --overwrite"),
        std::string::npos)
        << again.err();

    // The first line of progress counts what the run had done before.
    Program resumed(folder, {"resume", dir, "--threads", "1"});
    ASSERT_EQ(resumed.wait(), 0) << resumed.err();
    EXPECT_GE(std::stod(resumed.out()), 100.0 * time) << resumed.out();
    EXPECT_EQ(resumed.out().find(" \n"), std::string::npos) << "blanks at a line's end: " << resumed.out();

    Program over(folder, {"run", folder / "scene.toml", "-o", dir});
    EXPECT_EQ(over.wait(), 2);
    EXPECT_NE(over.err().find(": holds a run already; allowed: "), std::string::npos) << over.err();
}

TEST(RunMessages, RefuseAFolderWithOtherFilesOfARunsNames)
{
    for (const char* name : {"report.html", "report.json", "viewer.html", "probes.csv", "obstacles",
                             "cloth.usda", "frames/cloth_00000.ply", "frames/cloth_00003.obj"}) {
        SCOPED_TRACE(name);
        const TemporaryDirectory folder;
        write_bytes(folder / "scene.toml", kFalling);
        fs::create_directories(folder / "out/frames");
        write_bytes(folder / (std::string("out/") + name), "mine");
        const std::vector<std::string> call = {"run",   folder / "scene.toml", "-o", folder / "out",
                                               "--set", "duration=0.01"};
        Program refused(folder, call);
        EXPECT_EQ(refused.wait(), 2);
        EXPECT_EQ(refused.err(),
                  "arris: -o " + (folder / "out") + ": holds " + name +
                      ", which a run would replace; allowed: --overwrite, or another folder\n");
        EXPECT_TRUE(read_bytes(folder / (std::string("out/") + name)) == "mine");
        std::vector<std::string> over = call;
        over.push_back("--overwrite");
        Program replaced(folder, over);
        EXPECT_EQ(replaced.wait(), 0) << replaced.err();
        EXPECT_NE(read_bytes(folder / (std::string("out/") + name)), "mine");
    }
}

TEST(RunMessages, OfAnEmptyCheckpointSayAWayOn)
{
    const TemporaryDirectory folder;
    write_bytes(folder / "checkpoint", "");
    Program program(folder, {"resume", folder.path()});
    EXPECT_EQ(program.wait(), 2);
    EXPECT_EQ(program.err(),
              "arris: " + (folder / "checkpoint") +
                  ": is empty: it is not a checkpoint of arris; arris run with --overwrite starts the "
                  "run again\n");
}

TEST(RunMessages, OfCheckWarnOnStandardError)
{
    const TemporaryDirectory folder;
    write_bytes(folder / "scene.toml", kFalling);
    Program program(folder, {"check", folder / "scene.toml", "--set", "cloth.units=cm"});
    EXPECT_EQ(program.wait(), 0);
    EXPECT_EQ(program.err(), "warning: --set cloth.units=cm: has no effect: the cloth is not from a file\n");
    EXPECT_EQ(program.out().find("warning"), std::string::npos);
}

}  // namespace
}  // namespace arris
