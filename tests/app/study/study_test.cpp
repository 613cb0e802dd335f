// SPDX-License-Identifier: GPL-3.0-or-later
// Whole studies, made with the program.
#include "app/study/study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "app/run/run_directory.h"
#include "tests/app/program.h"

namespace arris {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// A sheet in free fall. Implicit Euler is behind the parabola by g h t / 2.
constexpr const char* kFall =
    "duration = 0.2\n[cloth]\nsize = [1, 1]\nresolution = [2, 2]\n[gravity]\n"
    "[[probe]]\nname = 'p'\nmaterial = [0.5, 0.5]\n[output]\nframes_per_second = 10\nformats = []\n";
constexpr double kGravity = 9.81;

/// Rows of a CSV file by name. Splits at commas outside quotes, and drops the quotes.
std::vector<std::map<std::string, std::string>> read_rows(const std::string& path)
{
    const auto split = [](const std::string& line) {
        std::vector<std::string> cells(1);
        bool is_quoted = false;
        for (const char c : line)
            if (c == '"')
                is_quoted = !is_quoted;
            else if (c == ',' && !is_quoted)
                cells.emplace_back();
            else
                cells.back() += c;
        return cells;
    };
    std::ifstream in(path);
    std::string line;
    std::getline(in, line);
    const std::vector<std::string> names = split(line);
    std::vector<std::map<std::string, std::string>> rows;
    while (std::getline(in, line)) {
        const std::vector<std::string> cells = split(line);
        EXPECT_EQ(cells.size(), names.size()) << line;
        rows.emplace_back();
        for (std::size_t i = 0; i < std::min(cells.size(), names.size()); ++i)
            rows.back()[names[i]] = cells[i];
    }
    return rows;
}

class StudyCommand : public ::testing::Test {
  protected:
    void write(const std::string& study, const std::string& scene = kFall)
    {
        write_bytes(folder_ / "scene.toml", scene);
        write_bytes(folder_ / "study.toml", "scene = 'scene.toml'\n" + study);
    }
    int run(const std::vector<std::string>& more = {})
    {
        Program program(folder_, arguments(more));
        const int status = program.wait();
        out_ = program.out();
        err_ = program.err();
        return status;
    }
    std::vector<std::string> arguments(const std::vector<std::string>& more) const
    {
        std::vector<std::string> words = {"study", folder_ / "study.toml", "-o", folder_ / "out", "--jobs",
                                          "2"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    std::vector<std::map<std::string, std::string>> rows() const
    {
        return read_rows(folder_ / "out/study.csv");
    }

    TemporaryDirectory folder_;
    std::string out_, err_;
};

TEST_F(StudyCommand, MeasuresTheErrorAndTheOrderOfImplicitEuler)
{
    write(
        "vary = { \"time.step\" = [0.02, 0.01, 0.005], \"time.integrator\" = ['implicit_euler'] }\n"
        "error = { probe = 'p', axis = 'z', reference = '-9.81*t^2/2' }\nrepeats = 2\n");
    ASSERT_EQ(run(), 0) << err_;
    const auto found = rows();
    ASSERT_EQ(found.size(), 3u);
    for (const auto& row : found) {
        const double step = std::stod(row.at("time.step"));
        EXPECT_NEAR(std::stod(row.at("error")), kGravity * step * 0.2 / 2, 1e-6)
            << step;  // stiff rows, round-off
        EXPECT_NEAR(std::stod(row.at("error_scale")), kGravity * 0.04 / 2, 1e-9) << step;
        EXPECT_EQ(row.at("status"), "finished");
        EXPECT_GT(std::stod(row.at("cpu_s_min")), 0.0);
        EXPECT_LE(std::stod(row.at("cpu_s_min")), std::stod(row.at("cpu_s_median")));
        EXPECT_LE(std::stod(row.at("cpu_s_median")), std::stod(row.at("cpu_s_max")));
        EXPECT_GT(std::stod(row.at("peak_memory_bytes")), 1e6);
    }
    EXPECT_THAT(read_bytes(folder_ / "out/study.csv"),
                ::testing::StartsWith("time.step,time.integrator,error,cpu_s_median,cpu_s_min,cpu_s_max,"
                                      "wall_s_median,peak_memory_bytes,status,"));
    const auto json = nlohmann::json::parse(read_bytes(folder_ / "out/study.json"));
    EXPECT_NEAR(json["slopes"][0]["slope"].get<double>(), 1.0, 1e-3);
    EXPECT_THAT(out_, HasSubstr("; 1 and 0.1 %: no run of the study."));  // 2.5 % with the least step
    const std::string html = read_bytes(folder_ / "out/study.html"),
                      svg = read_bytes(folder_ / "out/study.svg");
    EXPECT_THAT(html,
                AllOf(HasSubstr("<svg"), HasSubstr("(order 1.00)"), HasSubstr("CPU times are medians of 2")));
    EXPECT_THAT(html, Not(HasSubstr("src=")));
    EXPECT_EQ(svg.rfind("<svg xmlns=\"http://www.w3.org/2000/svg\"", 0), 0u);
}

TEST_F(StudyCommand, RunsOnlyWhatHasChanged)
{
    write("vary = { \"time.step\" = [0.02, 0.01] }\n");
    ASSERT_EQ(run(), 0) << err_;
    EXPECT_THAT(out_, HasSubstr("   2/2  finished"));
    ASSERT_EQ(run({"--engine", "local"}), 0) << err_;
    EXPECT_THAT(out_, HasSubstr("2 of 2 runs are done already"));
    write("vary = { \"time.step\" = [0.02, 0.01, 0.04] }\n");
    ASSERT_EQ(run(), 0) << err_;
    EXPECT_THAT(out_, AllOf(HasSubstr("2 of 3 runs are done already"),
                            HasSubstr("1/1  finished      time.step=0.04")));
    ASSERT_EQ(run({"--overwrite"}), 0) << err_;
    EXPECT_THAT(out_, HasSubstr("   3/3  finished"));
    write("vary = { \"time.step\" = [0.02, 0.01] }\n", std::string(kFall) + "# changed\n");
    ASSERT_EQ(run(), 0) << err_;
    EXPECT_THAT(out_, Not(HasSubstr("done already")));
}

TEST_F(StudyCommand, FailedRunsAreRowsWithTheirReason)
{
    write(
        "vary = { \"cloth.translate\" = [[0, 0, 0.5], [0, 0, 0.05]] }\n"
        "error = { column = 'kinetic_energy', norm = 'final' }\n",
        std::string(kFall) +
            "[[obstacle]]\nname = 'block'\nbox = [0.2, 0.2, 0.2]\ntranslate = [0.5, 0.5, 0]\n");
    ASSERT_EQ(run(), 0) << err_;
    const auto found = rows();
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].at("status"), "finished");
    EXPECT_GT(std::stod(found[0].at("error")), 0.0) << "without a reference the value is the error";
    EXPECT_EQ(found[1].at("status"), "bad_input");
    EXPECT_EQ(found[1].at("error"), "");
    EXPECT_THAT(found[1].at("message"), HasSubstr("block"));
    EXPECT_THAT(err_, HasSubstr("bad_input"));
    EXPECT_THAT(read_bytes(folder_ / "out/study.html"), HasSubstr("<tr class=\"failed\">"));
}

TEST_F(StudyCommand, ComparesShapesWithTheFinestRunOfTheSameProblem)
{
    // Two problems: with g, and with 2 g. A step of 0.02 s lags behind one of 0.01 s by g 0.01 t / 2.
    write(
        "vary = { \"gravity.acceleration\" = [[0, 0, -9.81], [0, 0, -19.62]], \"time.step\" = [0.02, 0.01] "
        "}\n"
        "set = { \"time.integrator\" = 'implicit_euler' }\n"
        "error = { shape = 'last', reference = 'finest' }\n");
    ASSERT_EQ(run(), 0) << err_;
    const auto found = rows();
    ASSERT_EQ(found.size(), 4u);
    for (const std::size_t problem : {0u, 1u}) {
        const auto &coarse = found[2 * problem], &fine = found[2 * problem + 1];
        const double lag = static_cast<double>(problem + 1) * kGravity * 0.01 * 0.2 / 2;
        EXPECT_NEAR(std::stod(coarse.at("error")), lag, 1e-6);
        EXPECT_NEAR(std::stod(coarse.at("greatest_distance")), lag, 1e-6);
        EXPECT_EQ(coarse.at("role"), "");
        EXPECT_EQ(fine.at("role"), "finest");
        EXPECT_EQ(fine.at("error"), "0");
    }
    EXPECT_THAT(out_, HasSubstr("Per cent are of the diagonal of the reference cloth's box"));
}

TEST_F(StudyCommand, AFurtherRunIsAReferenceAndARow)
{
    write(
        "vary = { \"time.step\" = [0.02] }\nset = { \"time.integrator\" = 'implicit_euler' }\n"
        "error = { probe = 'p', reference = { \"time.step\" = 0.005 }, norm = 'final' }\n");
    ASSERT_EQ(run(), 0) << err_;
    const auto found = rows();
    ASSERT_EQ(found.size(), 2u);
    EXPECT_NEAR(std::stod(found[0].at("error")), kGravity * 0.015 * 0.2 / 2, 1e-6);
    EXPECT_EQ(found[1].at("role"), "reference");
}

TEST_F(StudyCommand, GoesOnAfterAnInterruptAndLeavesNoProcess)
{
    std::string scene = kFall;
    scene.replace(scene.find("[2, 2]"), 6, "[16, 16]");
    write("vary = { \"time.step\" = [0.02, 0.00001] }\n", scene);
    Program program(folder_, arguments({}));
    const std::string long_run = folder_ / "out/runs/time.step=1e-05";
    const auto is_under_way = [&] {
        return std::filesystem::exists(long_run + "/steps.csv") &&
               std::filesystem::exists(folder_ / "out/tasks/time.step=0.02.exit");
    };
    for (int i = 0; i < 1000 && !is_under_way(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ASSERT_TRUE(is_under_way());
    EXPECT_EQ(program.stop_after(std::chrono::milliseconds(0), SIGINT), 130);
    EXPECT_THAT(program.err(), HasSubstr("the same command goes on with the study"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out/study.csv"));
    // The folder's lock is free: the child has ended.
    EXPECT_NO_THROW(FolderLock{long_run});
    write("vary = { \"time.step\" = [0.02, 0.01] }\n", scene);
    ASSERT_EQ(run(), 0) << err_;
    EXPECT_THAT(out_, HasSubstr("1 of 2 runs are done already"));
}

TEST_F(StudyCommand, BadInputIsOneLineBeforeAnythingRuns)
{
    const std::string vary = "vary = { \"time.step\" = [0.02] }\n";
    const std::vector<std::pair<std::string, std::string>> wrong = {
        {"vary = { \"time.stap\" = [0.02] }\n", "unknown key stap, did you mean step?"},
        {"vary = { \"time.step\" = [-1] }\n", "time.step"},
        {vary + "error = { probe = 'q', reference = 't' }\n",
         "error.probe = \"q\": is not in the scene; allowed: p"},
        {vary + "error = { probe = 'p', reference = 'no.csv' }\n", "no.csv: cannot be opened"},
        {vary + "error = { column = 'kinetic', reference = 't' }\n", "allowed: a column of steps.csv"},
        {vary +
             "set = { \"output.frames_per_second\" = 0 }\nerror = { shape = 'last', reference = 'finest' }\n",
         "error.shape"},
        {"vary = { \"time.step\" = [0.02] }\nerror = { probe = 'p', reference = { \"time.step\" = 0.02 } }\n",
         "is a run of the study already"},
    };
    for (const auto& [study, line] : wrong) {
        write(study);
        EXPECT_EQ(run(), 2) << study;
        EXPECT_THAT(err_, HasSubstr(line)) << study;
        EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "out")) << study;
    }
    write(vary);
    EXPECT_EQ(run({"--engine", "pbs"}), 2);
    EXPECT_EQ(run({"--jobs", "0"}), 2);
}

}  // namespace
}  // namespace arris
