// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/warnings/missing_effects.h"
#include "app/scene/scene_load.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/check.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

using ::testing::Contains;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kFlat =
    "[cloth]\nsize = [1, 0.5]\nresolution = [8, 4]\ntranslate = [-0.5, -0.25, 0.1]\n";
constexpr const char* kUpright =
    "[cloth]\nsize = [1, 0.5]\nresolution = [8, 4]\ntranslate = [-0.5, 0, 0.1]\nrotate = { axis = [1, 0, 0], "
    "degrees = 90 }\n";
constexpr const char* kTable = "[[obstacle]]\nname = \"table\"\n";
constexpr const char* kHere = "translate = [0, 0, -0.1]\n";
constexpr const char* kBorder = "[[pin]]\nmaterial = [[0, 0], [0, 0.5]]\n";

RunConfig load(const std::string& scene)
{
    return load_scene(SceneSource{"s.toml", "duration = 1\n" + scene, {}});
}

/// "effect: sign" lines.
std::vector<std::string> missing_in(const RunConfig& config)
{
    std::vector<std::string> lines;
    for (const MissingEffect& missing : find_missing_effects(config))
        lines.push_back(missing.name + ": " + missing.sign);
    return lines;
}

struct MissingCase {
    const char* name;
    std::string scene;
    std::vector<std::string> expected;  ///< starts of the lines, all of them
};

const std::string kWide = std::string(kTable) + "box = [3, 3, 0.2]\n" + kHere;
const std::string kSmallBox = std::string(kTable) + "box = [0.6, 0.4, 0.2]\n";
const std::string kSmall = kSmallBox + kHere;
const std::string kOffTheTable = "friction: the cloth reaches beyond table";
const std::string kDrapes = "self_contact: the cloth drapes around corners of table or falls off";

const MissingCase kCases[] = {
    {"held along a border", kUpright + std::string("[gravity]\n") + kBorder, {}},
    {"on a level table that is wider", kFlat + kWide + "[gravity]\n", {}},
    {"beside a table", kFlat + kSmallBox + "translate = [2, 0, -0.1]\n[gravity]\n", {}},
    {"above a lamp", kFlat + kSmallBox + "translate = [0, 0, 3]\n[gravity]\n", {}},
    {"folded by 90 degrees",
     kFlat + std::string("folds = [ { line = [[0.5, 0], [0.5, 0.5]], degrees = 90 } ]\n"),
     {}},

    {"over a small table", kFlat + kSmall + "[gravity]\n", {kOffTheTable, kDrapes}},
    {"over a table's edge",
     kFlat + std::string(kTable) + "box = [1, 3, 0.2]\ntranslate = [0.3, 0, -0.1]\n[gravity]\n",
     {kOffTheTable}},
    {"over a small table, held", kFlat + kSmall + "[gravity]\n" + kBorder, {}},
    {"over a small table, let go",
     kFlat + kSmall + "[gravity]\n" + kBorder + "release = 0.5\n",
     {kOffTheTable, kDrapes}},
    {"on a slope",
     kFlat + kWide + "rotate = { axis = [1, 0, 0], degrees = 3 }\n[gravity]\n",
     {"friction: the cloth is on slopes of table"}},
    {"gravity across the table", kFlat + kWide + "[gravity]\nacceleration = [0, 9.81, 0]\n", {}},
    {"on a moving table",
     kFlat + kWide + "motion = { velocity = [1, 0, 0] }\n[gravity]\n" + kBorder,
     {"friction: table: moving along"}},
    {"on a turning table",
     kFlat + std::string(kTable) +
         "box = [3, 3, 0.2]\nkeyframes = [ { time = 0, translate = [0, 0, -0.1] }, { time = 1, translate = "
         "[0, 0, -0.1], rotate = { axis = [0, 0, 1], degrees = 9 } } ]\n[gravity]\n",
     {"friction: table: moving along"}},
    {"on a rising table", kFlat + kWide + "motion = { velocity = [0, 0, 1] }\n[gravity]\n", {}},
    {"on a table that moves too late",
     kFlat + kWide + "motion = { velocity = [1, 0, 0], start = 2 }\n[gravity]\n",
     {}},

    {"folded back",
     kFlat + std::string("folds = [ { line = [[0.5, 0], [0.5, 0.5]], degrees = 150 } ]\n"),
     {"self_contact: parts of the cloth start turned by 150 degrees"}},
    {"falls edge-on",
     kUpright + kWide + "[gravity]\n",
     {"self_contact: the cloth starts at 90 degrees to the horizontal and falls on table"}},
    {"edge-on, held", kUpright + kWide + "[gravity]\n" + kBorder, {}},
    {"hangs from a corner",
     kFlat + std::string("[gravity]\n[[pin]]\nmaterial = [[0, 0], [0, 0]]\n"),
     {"self_contact: the cloth hangs from one place"}},
    {"over a wire",
     kFlat + std::string("[[obstacle]]\nname = \"line\"\nwire = [[0, -1, 0], [0, 1, 0]]\n[gravity]\n") +
         kBorder,
     {"self_contact: the cloth hangs down on both sides of line, less"}},
    {"pins drawn together",
     kFlat + std::string(kBorder) + "[[pin]]\nmaterial = [[1, 0], [1, 0.5]]\nvelocity = [-0.95, 0, 0]\n",
     {"self_contact: pin.0 and pin.1 come together at t = 1 s, to 5 %"}},
    {"pins drawn together, released before",
     kFlat + std::string(kBorder) +
         "[[pin]]\nmaterial = [[1, 0], [1, 0.5]]\nvelocity = [-0.95, 0, 0]\nrelease = 0.9\n",
     {}},

    {"over two wires",
     kFlat + std::string("[[obstacle]]\nwire = [[0, -1, 0], [0, 1, 0]]\n[[obstacle]]\nwire = [[0.2, -1, 0], "
                         "[0.2, 1, 0]]\n[gravity]\n"),
     {"self_contact: the cloth hangs down on both sides of obstacle0, obstacle1",
      "friction: the cloth reaches beyond obstacle0, obstacle1"}},
    {"an obstacle without gravity", kFlat + kWide, {"gravity: there are obstacles"}},
    {"no bending", kFlat + std::string("[cloth.material]\nbending_stiffness = 0\n"), {"bending: "}},
    {"EOL switched off",
     kFlat + kWide + "[gravity]\n[eol]\nenabled = false\n",
     {"eol: coarse cloth may snag"}},
};

TEST(MissingEffects, AreThoseThatWouldShow)
{
    for (const MissingCase& one : kCases) {
        SCOPED_TRACE(one.name);
        std::vector<::testing::Matcher<std::string>> expected;
        for (const std::string& part : one.expected) expected.push_back(HasSubstr(part));
        EXPECT_THAT(missing_in(load(one.scene)), ElementsAreArray(expected));
    }
}

TEST(MissingEffects, CountPiecesOfCloth)
{
    const TemporaryDirectory dir;
    write_bytes(
        dir / "two.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nvt 0 0\nvt 1 0\nvt 0 1\nvt 2 0\nvt 3 0\nvt 2 "
        "1\nf 1/1 2/2 3/3\nf 4/4 5/5 6/6\n");
    const RunConfig config =
        load_scene(SceneSource{dir / "s.toml", "duration = 1\n[cloth]\nfile = \"two.obj\"\n[gravity]\n", {}});
    EXPECT_THAT(missing_in(config),
                Contains("self_contact: the cloth has 2 pieces, which may pass through each other"));
}

TEST(MissingEffects, AreToldByCheckWhereThereAreAny)
{
    const auto header = "not simulated, and would show:";
    EXPECT_THAT(describe_scene(load(kFlat + kWide + "[gravity]\n")), Not(Contains(header)));
    const auto lines = describe_scene(load(kFlat + kSmall + "[gravity]\n"));
    EXPECT_THAT(lines, Contains(header));
    EXPECT_THAT(lines, Contains(HasSubstr("  " + kOffTheTable)));
}

}  // namespace
}  // namespace arris
