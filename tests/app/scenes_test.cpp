// SPDX-License-Identifier: GPL-3.0-or-later
// Every scene of data/scenes, coarse.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "app/files/csv_table.h"
#include "app/scene/scene_load.h"
#include "solver/mesh_change/strain_allowance.h"
#include "tests/app/program.h"
#include "tests/scatter.h"

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

/// Settings for a short test: half the cells that a scene's lines "resolution = [u, v]" have, or twice its
/// edge_length.
std::vector<std::string> halved_resolution(const std::string& file)
{
    const std::string text = read_bytes(file);
    std::smatch found;
    // Seams need their cells: sewn cloth is simulated for a shorter time instead.
    if (text.find("[[cloth.panel]]") != std::string::npos) return {"duration=0.3"};
    if (std::regex_search(text, found, std::regex("\nedge_length = ([0-9.]+)")))
        return {"cloth.edge_length=" + std::to_string(2.0 * std::stod(found[1]))};
    const bool has_pieces = text.find("\n[[cloth]]") != std::string::npos;
    const std::regex line("\nresolution = \\[(\\d+), (\\d+)\\]");
    std::vector<std::string> settings;
    for (std::sregex_iterator at(text.begin(), text.end(), line), end; at != end; ++at)
        settings.push_back(fmt::format("cloth{}.resolution=[{},{}]",
                                       has_pieces ? fmt::format(".{}", settings.size()) : "",
                                       (std::stoi((*at)[1]) + 1) / 2, (std::stoi((*at)[2]) + 1) / 2));
    return settings;
}

/// Whether anything does work on the cloth but gravity.
bool is_driven(const Scene& scene)
{
    const auto is_moving = [](const auto& of) { return of.is_moving(); };
    return scene.wind || !scene.pulls.empty() ||
           std::any_of(scene.obstacles.begin(), scene.obstacles.end(), is_moving) ||
           std::any_of(scene.pins.begin(), scene.pins.end(),
                       [&](const Pin& pin) { return is_moving(pin.motion); });
}

/// By how much the cloth's energy comes above the least that it has had, as a share of all that it has
/// exchanged: its greatest kinetic energy, and what it has lost in all.
double greatest_rise(const CsvTable& steps)
{
    std::vector<double> total(steps.column("time").size(), 0.0);
    for (const char* part : {"kinetic_energy", "gravity_energy", "stretch_energy", "bending_energy"}) {
        const std::vector<double> energy = steps.column(part);
        for (std::size_t k = 0; k < total.size(); ++k)
            if (std::isfinite(energy[k])) total[k] += energy[k];  // absent effects have none
    }
    double least = total[0], rise = 0.0, most = total[0];
    for (const double energy : total) {
        least = std::min(least, energy);
        most = std::max(most, energy);
        rise = std::max(rise, energy - least);
    }
    const std::vector<double> kinetic = steps.column("kinetic_energy");
    return rise / (*std::max_element(kinetic.begin(), kinetic.end()) + most - least);
}

/// Runs the scene, coarse, into the directory `name` of `folder`, and returns its report.
nlohmann::json run_coarse(const std::string& scene, const TemporaryDirectory& folder, const std::string& name,
                          const std::vector<std::string>& more = {})
{
    const std::string dir = folder / name;
    std::vector<std::string> arguments = {"run", scene, "-o", dir, "--set", "output.formats=[]"};
    for (const std::string& halved : halved_resolution(scene))
        arguments.insert(arguments.end(), {"--set", halved});
    arguments.insert(arguments.end(), more.begin(), more.end());
    Program program(folder, arguments);
    EXPECT_EQ(program.wait(), 0) << program.err();
    return nlohmann::json::parse(read_bytes(dir + "/report.json"));
}

/// The share of contacts with features that EOL vertices take. 1 where nothing touches a feature.
double eol_share(const nlohmann::json& report)
{
    if (!report.contains("feature_contacts") || report["feature_contacts"]["eol_share"].is_null()) return 1.0;
    return report["feature_contacts"]["eol_share"].get<double>();
}

/// The share of eleven runs of a scene, whose gravity differs by round-off. `report`: of one of them.
Scatter scatter_of_eol_share(const std::string& scene, const nlohmann::json& report,
                             const TemporaryDirectory& folder)
{
    const std::vector<double> g = report["scene"]["gravity"]["acceleration"];
    return measure_scatter(11, [&](double shift) {
        const std::string gravity = fmt::format("gravity.acceleration=[{},{},{}]", g[0], g[1], g[2] - shift);
        return eol_share(run_coarse(scene, folder, fmt::format("start_{}", shift), {"--set", gravity}));
    });
}

class Scenes : public testing::TestWithParam<std::string> {};

TEST_P(Scenes, FinishFreeOfTheirObstaclesAndKeepTheirMaterial)
{
    const TemporaryDirectory folder;
    const std::string dir = folder / "run";
    const nlohmann::json report = run_coarse(GetParam(), folder, "run");
    EXPECT_EQ(report["status"], "finished");
    EXPECT_LE(report["max_kkt_residual"].get<double>(), 1e-9);
    EXPECT_EQ(report["max_penetration"], 0.0);
    EXPECT_EQ(report["crossings"], 0);
    // A regression bound, as no closed form gives the share: a coarse trace has about seven vertices, and
    // snags where one of them is a row in its stead (6/7 = .86). Most scenes have .99 and more. The share
    // scatters where few contacts decide, as where a tip or a corner comes late: by .02 on three needles
    // (median .90) and by .03 on a parasol (.93). One run tells only if it is far above the bound.
    constexpr double kLeastShare = 0.85, kSurely = 0.05;
    if (!(eol_share(report) > kLeastShare + kSurely)) {
        EXPECT_TRUE(median_is_above(scatter_of_eol_share(GetParam(), report, folder), kLeastShare));
    }

    const CsvTable steps = read_csv(dir + "/steps.csv");
    const auto cloth = report["scene"]["cloth"];  // a file's cloth has no size of its own
    const double area = cloth.contains("size")
                            ? cloth["size"][0].get<double>() * cloth["size"][1].get<double>()
                            : steps.column("material_area").front();
    for (const double of_step : steps.column("material_area")) EXPECT_NEAR(of_step, area, 1e-12 * area);
    EXPECT_EQ(steps.column("time").back(), report["scene"]["duration"].get<double>());

    // In truth the energy never rises. A mesh change may add kMostClothStrain of the cloth's energy. Where
    // mesh changes may strain cloth without limit, energy rises by 8 to 77 % in 11 of these scenes.
    if (!is_driven(load_scene(GetParam(), {}, with_program()).scene)) {
        EXPECT_LE(greatest_rise(steps), kMostClothStrain);
    }
}

INSTANTIATE_TEST_SUITE_P(All, Scenes, testing::ValuesIn(scene_files()), [](const auto& scene) {
    return std::filesystem::path(scene.param).stem().string();
});

/// Height (m) at which the middle of the tablecloth ends.
double tablecloth_height(const std::string& has_eol)
{
    const TemporaryDirectory folder;
    const std::string dir = folder / "run";
    Program program(folder, {"run", ARRIS_SOURCE_DIR "/data/scenes/tablecloth.toml", "-o", dir, "--set",
                             "eol.enabled=" + has_eol, "--set", "probe.0.name=middle", "--set",
                             "probe.0.material=[0.55, 0.55]", "--set", "output.formats=[]"});
    EXPECT_EQ(program.wait(), 0) << program.err();
    return read_csv(dir + "/probes.csv").column("middle_z").back();
}

TEST(Tablecloth, ComesOffTheTableWithEolVerticesAndHangsThereWithout)
{
    constexpr double kTableTop = 0.973;  // m
    EXPECT_LT(tablecloth_height("true"), 0.5 * kTableTop);
    EXPECT_GT(tablecloth_height("false"), kTableTop);
}

}  // namespace
}  // namespace arris
