// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/strain_warnings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/files/csv_table.h"
#include "app/scene/scene_load.h"
#include "tests/app/program.h"

namespace arris {
namespace {

/// A face of one triangle, at `time`.
State make_triangle(double time)
{
    State state;
    state.time = time;
    state.mesh.material = {Vec2(0, 0), Vec2(3, 0), Vec2(0, 3)};
    state.mesh.world = {Vec3(0, 0, 1), Vec3(6, 0, 1), Vec3(0, 3, 1)};
    state.mesh.faces = {{0, 1, 2}};
    return state;
}

/// A scene that strains nothing.
RunConfig still_cloth()
{
    return load_scene(
        SceneSource{"s.toml", "duration = 1\n[cloth]\nsize = [3, 3]\nresolution = [3, 3]\n", {}});
}

struct PeakCase {
    const char* name;
    std::vector<ClothStrain> rows;
    std::vector<std::string> parts;  ///< one a line, in order
};

constexpr VertexStrain kNone = {};

/// Plane cloth that is compressed more and more, and then less: two rows later the peak is over.
std::vector<ClothStrain> rise_and_fall()
{
    std::vector<ClothStrain> rows(20, {kNone, {-0.3, 0}, {-0.3, 0}});
    rows.push_back({kNone, {-0.4, 0}, {-0.4, 0}});
    rows.push_back({kNone, {-0.35, 0}, {-0.35, 0}});
    return rows;
}

const std::vector<PeakCase>& peak_cases()
{
    static const std::vector<PeakCase> kCases = {
        {"no strain", {{}, {}}, {}},
        {"just below", std::vector<ClothStrain>(2, {{0.199, 0}, {-0.199, 0}, kNone}), {}},
        {"stretch", std::vector<ClothStrain>(2, {{0.25, 0}, kNone, kNone}), {"stretched by 25 % at t = 1 s"}},
        {"in a single row", {{}, {{4.0, 0}, {-0.9, 0}, kNone}, {}}, {}},
        {"as far as two rows have it",
         {{{0.25, 0}, kNone, kNone}, {{0.5, 0}, kNone, kNone}, {{0.3, 0}, kNone, kNone}},
         {"stretched by 30 % at t = 2 s, at [0, 0, 1] (m, material [0, 0])"}},
        {"the place is where the lasting strain was",
         {{{0.25, 0}, kNone, kNone}, {{4.0, 1}, kNone, kNone}, {{0.25, 0}, kNone, kNone}},
         {"stretched by 25 % at t = 0 s, at [0, 0, 1] (m, material [0, 0])"}},
        {"compression",
         std::vector<ClothStrain>(2, {kNone, {-0.3, 0}, kNone}),
         {"compressed by 30 % at t = 1 s"}},
        {"both", std::vector<ClothStrain>(2, {{0.25, 0}, {-0.3, 0}, kNone}), {"stretched", "compressed"}},
        {"plane for a moment", std::vector<ClothStrain>(19, {kNone, {-0.1, 0}, {-0.1, 0}}), {}},
        {"stays plane",
         std::vector<ClothStrain>(20, {kNone, {-0.1, 0}, {-0.1, 0}}),
         {"compressed by 10 % at t = 19 s, at [0, 0, 1] (m, material [0, 0]) and stayed plane"}},
        {"as much in the plane, a row earlier", rise_and_fall(), {"compressed by 40 % at t = 20 s"}},
        {"below 5 % in the plane", std::vector<ClothStrain>(40, {kNone, {-0.04, 0}, {-0.04, 0}}), {}},
    };
    return kCases;
}

TEST(StrainWarnings, AreOneLineForEachPeakThatClothDoesNotBear)
{
    for (const PeakCase& one : peak_cases()) {
        SCOPED_TRACE(one.name);
        StrainPeaks peaks;
        for (std::size_t row = 0; row < one.rows.size(); ++row)
            note_strain(make_triangle(static_cast<double>(row)), one.rows[row], peaks);
        const std::vector<std::string> lines = warn_of_strain(peaks, still_cloth());
        ASSERT_EQ(lines.size(), one.parts.size());
        for (std::size_t k = 0; k < lines.size(); ++k)
            EXPECT_NE(lines[k].find(one.parts[k]), std::string::npos) << lines[k];
    }
}

TEST(StrainWarnings, CountRowsOfPlaneClothAnewAfterItHasFolded)
{
    StrainPeaks peaks;
    for (int row = 0; row < 60; ++row)
        note_strain(make_triangle(row), {kNone, {-0.1, 0}, row % 15 == 14 ? kNone : VertexStrain{-0.1, 0}},
                    peaks);
    EXPECT_TRUE(warn_of_strain(peaks, still_cloth()).empty());
}

// --- Whole runs.

constexpr const char* kSheet = R"(duration = 0.3
[cloth]
size = [0.4, 0.4]
resolution = [4, 4]
translate = [0, 0, 0.001]
[cloth.material]
damping = 0.002
[[pin]]
material = [[0, 0], [0, 0.4]]
)";

struct RunCase {
    const char* name;
    std::string more;
    std::vector<std::string> parts;  ///< of the lines about strain, in order
    double least, greatest;          ///< bounds of the greatest `max_strain`
};

const std::string kPulled = "[[pin]]\nmaterial = [[0.4, 0], [0.4, 0.4]]\nvelocity = ";
const std::string kFloor = "[gravity]\n[[obstacle]]\nbox = [4, 4, 1]\ntranslate = [0, 0, -0.5]\n";

const RunCase kRuns[] = {
    {"hangs", "[gravity]\n", {}, 1e-4, 0.2},
    {"pulled a little", kPulled + "[0.1, 0, 0]\n", {}, 0.05, 0.1},
    {"pulled by a third", kPulled + "[0.4, 0, 0]\n", {"stretched by 3"}, 0.25, 0.45},
    {"pushed without a floor", kPulled + "[-0.1, 0, 0]\n", {}, 0.0, 0.1},
    {"pushed on a floor", kFloor + kPulled + "[-0.15, 0, 0]\n", {"compressed by 1"}, 0.1, 0.2},
    {"pushed far on a floor",
     kFloor + kPulled + "[-0.4, 0, 0]\n",
     {"and stayed plane: real cloth folds before 5 %; pin.0 and pin.1"},
     0.25,
     0.5},
};

TEST(StrainWarnings, AreInTheReportAndPrintedOnceWhereARunHasThem)
{
    for (const RunCase& one : kRuns) {
        SCOPED_TRACE(one.name);
        const TemporaryDirectory folder;
        write_bytes(folder / "scene.toml", kSheet + one.more);
        Program program(folder, {"run", folder / "scene.toml", "-o", folder / "out", "--quiet"});
        ASSERT_EQ(program.wait(), 0) << program.err();
        const nlohmann::json report = nlohmann::json::parse(read_bytes(folder / "out/report.json"));
        std::vector<std::string> lines;
        for (const std::string line : report["warnings"])
            if (line.find("the cloth was") == 0) lines.push_back(line);
        ASSERT_EQ(lines.size(), one.parts.size()) << report["warnings"];
        const std::string err = program.err();
        for (std::size_t k = 0; k < lines.size(); ++k) {
            EXPECT_NE(lines[k].find(one.parts[k]), std::string::npos) << lines[k];
            const std::size_t at = err.find("warning: " + lines[k] + "\n");
            ASSERT_NE(at, std::string::npos) << err;
            EXPECT_EQ(err.find(lines[k], at + 10), std::string::npos) << err;
        }
        const std::vector<double> strains = read_csv(folder / "out/steps.csv").column("max_strain");
        const double greatest = *std::max_element(strains.begin(), strains.end());
        EXPECT_GE(greatest, one.least);
        EXPECT_LE(greatest, one.greatest);
        EXPECT_LT(strains.front(), 1e-12);
    }
}

TEST(StrainWarnings, SurviveAResumeInAnyPart)
{
    // The greatest strain is in the first half of the run: the pin goes and comes back.
    const TemporaryDirectory folder;
    write_bytes(folder / "scene.toml",
                std::string(kSheet) +
                    "[[pin]]\nmaterial = [[0.4, 0], [0.4, 0.4]]\nkeyframes = [{time = 0}, "
                    "{time = 0.1, translate = [0.12, 0, 0]}, {time = 0.2}]\n");
    for (const auto& [name, end] : {std::pair("through", "0.3"), std::pair("stopped", "0.2")}) {
        Program program(folder, {"run", folder / "scene.toml", "-o", folder / name, "--set",
                                 std::string("duration=") + end});
        ASSERT_EQ(program.wait(), 0) << program.err();
    }
    Program resumed(folder, {"resume", folder / "stopped", "--until", "0.3"});
    ASSERT_EQ(resumed.wait(), 0) << resumed.err();
    const auto warnings = [&](const char* name) {
        return nlohmann::json::parse(read_bytes(folder / (std::string(name) + "/report.json")))["warnings"];
    };
    ASSERT_FALSE(warnings("through").empty());
    EXPECT_EQ(warnings("through"), warnings("stopped"));
}

}  // namespace
}  // namespace arris
