// SPDX-License-Identifier: GPL-3.0-or-later
// Every scene of data/scenes, coarse.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "app/csv_table.h"
#include "tests/app/program.h"

namespace arris {
namespace {

std::vector<std::string> scene_files()
{
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(ARRIS_SOURCE_DIR "/data/scenes"))
        if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    return files;
}

/// Half the cells that a scene's line "resolution = [u, v]" has, as a setting; empty where it has none.
std::string halved_resolution(const std::string& file)
{
    const std::string text = read_bytes(file);
    std::smatch found;
    if (!std::regex_search(text, found, std::regex("\nresolution = \\[(\\d+), (\\d+)\\]"))) return {};
    return "cloth.resolution=[" + std::to_string((std::stoi(found[1]) + 1) / 2) + "," +
           std::to_string((std::stoi(found[2]) + 1) / 2) + "]";
}

class Scenes : public testing::TestWithParam<std::string> {};

TEST_P(Scenes, FinishFreeOfTheirObstaclesAndKeepTheirMaterial)
{
    const TemporaryDirectory folder;
    const std::string dir = folder / "run";
    Program program(folder, {"run", GetParam(), "-o", dir, "--set", halved_resolution(GetParam()), "--set",
                             "output.formats=[]"});
    ASSERT_EQ(program.wait(), 0) << program.err();
    const nlohmann::json report = nlohmann::json::parse(read_bytes(dir + "/report.json"));
    EXPECT_EQ(report["status"], "finished");
    EXPECT_LE(report["max_kkt_residual"].get<double>(), 1e-9);
    EXPECT_EQ(report["max_penetration"], 0.0);
    EXPECT_EQ(report["crossings"], 0);
    // Of contacts with features; the least is that of needles, .978 to .987 by rounding, most have .99 and
    // more.
    constexpr double kLeastShare = 0.95;
    if (report.contains("feature_contacts") && !report["feature_contacts"]["eol_share"].is_null()) {
        EXPECT_GE(report["feature_contacts"]["eol_share"].get<double>(), kLeastShare);
    }

    const CsvTable steps = read_csv(dir + "/steps.csv");
    const auto size = report["scene"]["cloth"]["size"];
    const double area = size[0].get<double>() * size[1].get<double>();
    for (const double of_step : steps.column("material_area")) EXPECT_NEAR(of_step, area, 1e-12 * area);
    EXPECT_EQ(steps.column("time").back(), report["scene"]["duration"].get<double>());
}

INSTANTIATE_TEST_SUITE_P(All, Scenes, testing::ValuesIn(scene_files()), [](const auto& scene) {
    return std::filesystem::path(scene.param).stem().string();
});

}  // namespace
}  // namespace arris
