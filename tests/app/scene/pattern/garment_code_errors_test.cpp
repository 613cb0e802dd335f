// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/pattern/garment_code.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "geometry/cloth_input/pattern/pattern_mesh.h"
#include "geometry/input_error.h"
#include "tests/app/error_of.h"
#include "tests/app/scene/pattern/tabard.h"

namespace arris {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using Json = nlohmann::json;

GarmentCodePattern parse(const std::string& text, const GarmentCodeOptions& options = {})
{
    return parse_garment_code("tabard.json", text, options);
}

template <class Action>
std::string refusal_of(Action action)
{
    const std::string line = error_of(action);
    return line.empty() ? "accepted" : line;
}

std::string refusal(const std::string& text)
{
    return refusal_of([&] { parse(text); });
}

TEST(GarmentCodeErrors, NameFilesThatAreNotThereOrNoFiles)
{
    const auto refusal_of_file = [](const std::string& path) {
        return refusal_of([&] { read_garment_code(path); });
    };
    const std::string folder = ::testing::TempDir();
    EXPECT_EQ(refusal_of_file(folder + "none.json"), folder + "none.json: No such file or directory");
    EXPECT_EQ(refusal_of_file(folder), folder + ": is a directory; allowed: a GarmentCode pattern (JSON)");
    const std::string path = folder + "garment_code_test.json";
    std::ofstream(path) << kTabard;
    EXPECT_EQ(refusal_of_file(path), "accepted");
    EXPECT_EQ(read_garment_code(path).pattern.panels.size(), 3U);
    std::filesystem::remove(path);
}

TEST(GarmentCodeErrors, NameThePlaceWhereATextIsNoJson)
{
    EXPECT_EQ(refusal(""), "tabard.json:1:1: is not JSON; allowed: a GarmentCode pattern (JSON)");
    EXPECT_EQ(refusal("{\"a\": 1,\n  \"b\" 2}"),
              "tabard.json:2:7: is not JSON; allowed: a GarmentCode pattern (JSON)");
    EXPECT_THAT(refusal(kTabard.substr(0, 300)), HasSubstr("is not JSON"));
    EXPECT_THAT(refusal("{\"a\": 1e999}"),
                AllOf(StartsWith("tabard.json: "), HasSubstr("1e999"), HasSubstr("double precision")));
    EXPECT_THAT(refusal("\xff\xfe{"), StartsWith("tabard.json: "));
}

TEST(GarmentCodeErrors, NamePlaceValueAndWhatIsAllowed)
{
    const std::string front = "/pattern/panels/front", at = "tabard.json: pattern.panels.front";
    struct Case {
        std::string pointer;
        Json value;
        std::string line;
    };
    const std::vector<Case> cases = {
        {"/properties", kNothing,
         "tabard.json: has no \"properties\"; allowed: an object with \"properties\""},
        {"/pattern", 3, "tabard.json: pattern: is 3; allowed: an object"},
        {"/properties/units_in_meter", 0,
         "tabard.json: properties.units_in_meter: is 0; allowed: numbers from 0.001 to 1e+06"},
        {"/properties/units_in_meter", "cm",
         "tabard.json: properties.units_in_meter: is \"cm\"; allowed: numbers from 0.001 to 1e+06"},
        {"/properties/curvature_coords", "absolute",
         "tabard.json: properties.curvature_coords: is \"absolute\"; allowed: \"relative\""},
        {"/pattern/panels", Json::object(),
         "tabard.json: pattern.panels: is an object of 0 members; allowed: an object of one or more panels"},
        {"/pattern/panels",
         {1, 2},
         "tabard.json: pattern.panels: is an array of 2 values; allowed: an object of one or more panels"},
        {front, 7, at + ": is 7; allowed: an object"},
        {front + "/translation", kNothing,
         at + ": has no \"translation\"; allowed: an object with \"translation\""},
        {front + "/translation",
         {1, 2},
         at + ".translation: is an array of 2 values; allowed: three lengths [x, y, z]"},
        {front + "/translation/1", "up",
         at + ".translation[1]: is \"up\"; allowed: numbers from -1e+08 to 1e+08"},
        {front + "/rotation/2", 1e300, at + ".rotation[2]: is 1e+300; allowed: numbers from -1e+06 to 1e+06"},
        {front + "/vertices", kNothing, at + ": has no \"vertices\"; allowed: an object with \"vertices\""},
        {front + "/vertices/2",
         {1, 2, 3},
         at + ".vertices[2]: is an array of 3 values; allowed: two lengths [u, v]"},
        {front + "/vertices/2/0", nullptr,
         at + ".vertices[2][0]: is null; allowed: numbers from -1e+08 to 1e+08"},
        {front + "/edges", Json::array(),
         at + ".edges: is an array of 0 values; allowed: an array of 3 to 6250 edges"},
        {front + "/edges/3/label", true, at + ".edges[3].label: is true; allowed: a text"},
        {front + "/edges/3/endpoints", kNothing,
         at + ".edges[3]: has no \"endpoints\"; allowed: an object with \"endpoints\""},
        {front + "/edges/3/endpoints",
         {3},
         at + ".edges[3].endpoints: is an array of 1 value; allowed: two numbers of vertices"},
        {front + "/edges/3/endpoints/1", 9,
         at + ".edges[3].endpoints[1]: is 9; allowed: numbers from 0 to 8"},
        {front + "/edges/3/endpoints/1", 3.5,
         at + ".edges[3].endpoints[1]: is 3.5; allowed: whole numbers from 0 to 8"},
        {front + "/edges/3/endpoints/0", 2,
         at + ".edges[3].endpoints: begins at vertex 2, but edge 2 ends at vertex 3; allowed: edges in the "
              "order of a "
              "closed loop"},
        {front + "/edges/8/endpoints/1", 1,
         at + ".edges[0].endpoints: begins at vertex 0, but edge 8 ends at vertex 1; allowed: edges in the "
              "order of "
              "a closed loop"},
        {front + "/edges/4/curvature", "round",
         at +
             ".edges[4].curvature: is \"round\"; allowed: {\"type\": \"quadratic\", \"cubic\" or \"circle\", "
             "\"params\": [...]}, or [along, aside] of a quadratic curve"},
        {front + "/edges/4/curvature/type", "spline",
         at + ".edges[4].curvature.type: is \"spline\"; allowed: \"quadratic\", \"cubic\" or \"circle\""},
        {front + "/edges/4/curvature/params", Json::array(),
         at + ".edges[4].curvature.params: is an array of 0 values; allowed: one control point [along, "
              "aside]"},
        {front + "/edges/8/curvature/params",
         {{0.1, 0.2}},
         at + ".edges[8].curvature.params: is an array of 1 value; allowed: two control points [along, "
              "aside]"},
        {front + "/edges/8/curvature/params/1/0", 1e4,
         at + ".edges[8].curvature.params[1][0]: is 10000.0; allowed: numbers from -1000 to 1000"},
        {front + "/edges/6/curvature/params",
         {10, 0},
         at + ".edges[6].curvature.params: is an array of 2 values; allowed: [radius, large, right]"},
        {front + "/edges/6/curvature/params/1", 2,
         at + ".edges[6].curvature.params[1]: is 2; allowed: numbers from 0 to 1"},
        {"/pattern/stitches", "none",
         "tabard.json: pattern.stitches: is \"none\"; allowed: an array of at most 6250 stitches"},
        {"/pattern/stitches/1",
         {1},
         "tabard.json: pattern.stitches[1]: is an array of 1 value; allowed: [side, side] or [side, side, "
         "\"right_wrong\"]"},
        {"/pattern/stitches/1/0/panel", "sleeve",
         "tabard.json: pattern.stitches[1][0].panel: is \"sleeve\"; allowed: the name of a panel"},
        {"/pattern/stitches/1/0/panel", "bag",
         "tabard.json: pattern.stitches[1][0].panel: is \"bag\"; allowed: the name of a panel"},
        {"/pattern/stitches/1/0/panel", 0,
         "tabard.json: pattern.stitches[1][0].panel: is 0; allowed: a text"},
        {"/pattern/stitches/1/1/edge", 6,
         "tabard.json: pattern.stitches[1][1].edge: is 6; allowed: numbers from 0 to 5"},
        {"/pattern/stitches/4/2", "wrong_right",
         "tabard.json: pattern.stitches[4][2]: is \"wrong_right\"; allowed: \"right_wrong\""},
        {"/pattern/stitches/2/0/edge", 7,
         "tabard.json: panel \"front\", edge 7: is sewn twice, in seams 2 and 3; allowed: one seam an edge, or a tie"},
    };
    for (const Case& c : cases) EXPECT_EQ(refusal(with(c.pointer, c.value)), c.line) << c.pointer;
}

TEST(GarmentCodeErrors, NamesFromTheFileArePrintedSafely)
{
    Json json = Json::parse(kTabard);
    json["pattern"]["panels"]["a\x1b[2J\n" + std::string(100, 'b')] = 3;
    const std::string line = refusal(json.dump());
    EXPECT_EQ(line.find('\x1b'), std::string::npos);
    EXPECT_EQ(line.find('\n'), std::string::npos);
    EXPECT_LT(line.size(), 150U);
    json = Json::parse(kTabard);
    json["pattern"]["panels"][std::string(201, 'b')] = json["pattern"]["panels"]["pocket"];
    EXPECT_THAT(refusal(json.dump()),
                HasSubstr("has a name that is empty or too long; allowed: 1 to 200 bytes"));
}

// ---- damage

TEST(GarmentCodeErrors, LargeAndDeepFilesCostLittle)
{
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(refusal(std::string(1000000, '[')), "tabard.json: nests values more than 32 deep; allowed: 32");
    EXPECT_THAT(refusal("[" + std::string(5000000, '1').replace(0, 1, "1,") + "]"), HasSubstr("tabard.json"));
    std::string many = "[0";
    for (int k = 0; k < 3000000; ++k) many += ",0";
    EXPECT_EQ(refusal(many + "]"), "tabard.json: has too many values; allowed: 1000000");
    Json json = Json::parse(kTabard);
    json["pattern"]["panels"]["front"]["vertices"] = Json::array();
    for (int k = 0; k < 300000; ++k) json["pattern"]["panels"]["front"]["vertices"].push_back({k, k});
    EXPECT_EQ(
        refusal(json.dump()),
        "tabard.json: pattern.panels.front.vertices: is an array of 300000 values; allowed: an array of 3 to "
        "6250 vertices [u, v]");
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_LT(seconds.count(), 30.0);
}

// Whatever bytes are changed, the file is read and meshed, or refused in one line.
TEST(GarmentCodeErrors, DamagedFilesAreReadOrRefusedInOneLine)
{
    std::mt19937 random(5);
    const std::string bytes = "0123456789.-e,:[]{}\"xnull";
    int refused = 0;
    constexpr int kTrials = 1000;
    for (int trial = 0; trial < kTrials; ++trial) {
        std::string text = kTabard;
        for (std::size_t changes = 1 + random() % 3; changes > 0; --changes) {
            const std::size_t at = random() % text.size();
            if (random() % 3 == 0)
                text.erase(at, 1 + random() % 20);
            else
                text[at] = bytes[random() % bytes.size()];
        }
        try {
            mesh_pattern(parse(text).pattern, 0.05);
        } catch (const InputError& error) {
            ++refused;
            const std::string line = error.what();
            EXPECT_THAT(line, AllOf(HasSubstr("allowed"), ::testing::Not(HasSubstr("\n")))) << text;
        }
    }
    EXPECT_GT(refused, kTrials / 4);
    EXPECT_LT(refused, kTrials);
}

}  // namespace
}  // namespace arris
