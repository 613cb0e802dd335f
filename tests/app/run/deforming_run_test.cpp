// SPDX-License-Identifier: GPL-3.0-or-later
// A whole run with an obstacle that deforms under cloth with friction: the same bytes for any number of
// threads, and after a kill and a resume.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "app/files/csv_table.h"
#include "tests/app/program.h"
#include "tests/app/same_run.h"

namespace arris {
namespace {

/// The book of data/scenes opens under its cloth from 0.3 s on.
class DeformingRun : public testing::Test {
  protected:
    std::vector<std::string> arguments(const std::string& name, const std::string& threads) const
    {
        return {"run",       ARRIS_SOURCE_DIR "/data/scenes/book.toml",
                "-o",        folder / name,
                "--threads", threads,
                "--set",     "duration=0.7",
                "--set",     "cloth.resolution=[10, 6]",
                "--set",     "output.formats=[]"};
    }

    std::string run_through(const std::string& name, const std::string& threads) const
    {
        Program program(folder, arguments(name, threads));
        EXPECT_EQ(program.wait(), 0) << program.err();
        return folder / name;
    }

    TemporaryDirectory folder;
};

TEST_F(DeformingRun, IsTheSameForAnyNumberOfThreadsAndAfterAKillUnderContact)
{
    const std::string one = run_through("one", "1");
    const CsvTable steps = read_csv(one + "/steps.csv");
    const std::vector<double> time = steps.column("time"), sticking = steps.column("sticking"),
                              sliding = steps.column("sliding"), eol = steps.column("eol_vertices");
    constexpr double kKilled = 0.5;  // s, the book is opening
    const auto after = [&](std::size_t k) { return time[k] > kKilled; };
    bool has_friction = true, has_eol = true;
    for (std::size_t k = 0; k < time.size(); ++k) {
        has_friction = has_friction && (!after(k) || sticking[k] + sliding[k] > 0.0);
        has_eol = has_eol && (!after(k) || eol[k] > 0.0);
    }
    EXPECT_TRUE(has_friction);
    EXPECT_TRUE(has_eol);

    expect_same_run(one, run_through("two", "2"));
    expect_same_run(one, run_through("sixteen", "16"));

    const std::string killed = folder / "killed";
    Program program(folder, arguments("killed", "2"));
    for (int k = 0; k < 60000 && !std::filesystem::exists(killed + "/frames/cloth_00012.ply"); ++k)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_EQ(program.stop_after(std::chrono::milliseconds(0), SIGKILL), -SIGKILL) << program.err();
    Program resumed(folder, {"resume", killed, "--threads", "1"});
    EXPECT_EQ(resumed.wait(), 0) << resumed.err();
    expect_same_run(one, killed);
}

}  // namespace
}  // namespace arris
