// SPDX-License-Identifier: GPL-3.0-or-later
// Runs whose cloth is sewn, as the program makes them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

#include "app/files/csv_table.h"
#include "app/scene/scene_load.h"
#include "geometry/cloth/euler_characteristic.h"
#include "tests/app/program.h"
#include "tests/app/run/sewn_tube.h"
#include "tests/app/same_run.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

using ::testing::HasSubstr;

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

TEST_F(AssemblyRun, UnsewnStaysUnsewnWhenResumed)
{
    const std::string scene = write(kTube + "[[obstacle]]\nname = \"wall\"\nbox = [0.4, 0.02, 1.0]\n");
    Program program(folder, {"run", scene, "-o", folder / "no"});
    EXPECT_EQ(program.wait(), 1);
    Program resumed(folder, {"resume", folder / "no"});
    EXPECT_EQ(resumed.wait(), 1);
    EXPECT_THAT(resumed.err(), HasSubstr("unsewn: 2 seams did not close"));
    EXPECT_FALSE(std::filesystem::exists(folder / "no" + "/frames/cloth_00000.ply"));
    Program kept(folder, {"run", scene, "-o", folder / "kept", "--assemble-only", "--set",
                          "cloth.assembly.unsewn=keep"});
    kept.wait();
    Program worn(folder, {"resume", folder / "kept"});
    worn.wait();
    EXPECT_THAT(worn.err(), HasSubstr("these seams stay as they are"));
}

TEST_F(AssemblyRun, ResumesToALaterEndAndLeavesNothingToAnotherRun)
{
    const std::string scene = write(kTube);
    Program program(folder, {"run", scene, "-o", folder / "a", "--assemble-only"});
    ASSERT_EQ(program.wait(), 0) << program.err();
    Program resumed(folder, {"resume", folder / "a", "--until", "0.15"});
    ASSERT_EQ(resumed.wait(), 0) << resumed.err();
    EXPECT_NEAR(read_csv(folder / "a" + "/steps.csv").column("time").back(), 0.15, 1e-12);

    std::ofstream(folder / "plain.toml")
        << "duration = 0.01\n[cloth]\nsize = [1, 1]\nresolution = [2, 2]\n[gravity]\n";
    Program alone(folder,
                  {"run", folder / "plain.toml", "-o", folder / "a", "--overwrite", "--assemble-only"});
    EXPECT_EQ(alone.wait(), 2);
    EXPECT_TRUE(std::filesystem::exists(folder / "a" + "/checkpoint")) << "a refusal removes nothing";
    Program other(folder, {"run", folder / "plain.toml", "-o", folder / "a", "--overwrite"});
    EXPECT_EQ(other.wait(), 0) << other.err();
    EXPECT_FALSE(std::filesystem::exists(folder / "a" + "/assembly/checkpoint"));
    EXPECT_FALSE(std::filesystem::exists(folder / "a" + "/assembly/cloth.obj"));
}

TEST_F(AssemblyRun, InterruptedTellsHowToGoOn)
{
    const std::string scene = write(with(kTube, "settle = 0.05", "settle = 5.0"));
    Program program(folder, {"run", scene, "-o", folder / "cut"});
    ASSERT_NE(program.stop_after(std::chrono::milliseconds(400), SIGINT), 0);
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
