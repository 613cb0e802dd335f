// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/keys/scene_document.h"

#include <gtest/gtest.h>

#include "app/scene/parts/run_config.h"
#include "app/scene/scene_load.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

const std::string kBase = "duration = 1\n[cloth]\nsize = [1, 1]\nresolution = [2, 2]\n";
const std::string kPin = "[[pin]]\nmaterial = [[0, 0], [0, 1]]\n";

RunConfig load(const std::string& text, const std::vector<std::string>& overrides)
{
    return load_scene(SceneSource{"s.toml", text, overrides});
}

TEST(SceneDocument, QuotesValuesAsTheyAreWritten)
{
    const SceneDocument document("s.toml",
                                 "\"ä\" = 'x' # c\n a . b = -1_0.5e3\nc = [1,\r\n 2]\n[d]\ne = \"ü\" # "
                                 "f\n[[g]]\n[[g]]\nh = {i = 1}\n");
    EXPECT_EQ(document.describe("ä"), "s.toml:1: ä = 'x'");
    EXPECT_EQ(document.describe("a.b"), "s.toml:2: a.b = -1_0.5e3");
    EXPECT_EQ(document.describe("c"), "s.toml:3: c = [1,  2]");
    EXPECT_EQ(document.describe("c.1"), "s.toml:4: c.1 = 2");
    EXPECT_EQ(document.describe("d"), "s.toml:5: d");
    EXPECT_EQ(document.describe("d.e"), "s.toml:6: d.e = \"ü\"");
    EXPECT_EQ(document.describe("g.1.h"), "s.toml:9: g.1.h = {i = 1}");
    EXPECT_EQ(document.describe("g.1.h.i"), "s.toml:9: g.1.h.i = 1");
}

TEST(SceneDocument, PlacesWhatIsMissingAtTheNearestTableAbove)
{
    const SceneDocument document("s.toml", "a = 1\n[b]\n[b.c]\n[[d]]\n[[d]]\n");
    EXPECT_EQ(document.describe("b.c.x"), "s.toml:3: b.c.x");
    EXPECT_EQ(document.describe("b.x.y"), "s.toml:2: b.x.y");
    EXPECT_EQ(document.describe("d.1.x"), "s.toml:5: d.1.x");
    EXPECT_EQ(document.describe("x"), "s.toml:1: x");
}

TEST(SceneDocument, CountsLinesBehindAByteOrderMark)
{
    const SceneDocument document("s.toml",
                                 "\xef\xbb\xbf"
                                 "ab = 12\r\ncd = 34\r\n");
    EXPECT_EQ(document.describe("ab"), "s.toml:1: ab = 12");
    EXPECT_EQ(document.describe("cd"), "s.toml:2: cd = 34");
}

TEST(SceneDocument, ReadsALineOfAMillionValuesInTimeLinearInIt)
{
    std::string text = "x = [";
    for (int i = 0; i < 1'000'000; ++i) text += "1, ";
    const SceneDocument document("s.toml", text + "]\n");
    EXPECT_EQ(document.find("x")->items.size(), 1'000'000u);
    EXPECT_EQ(document.describe("x.999999"), "s.toml:1: x.999999 = 1");
}

TEST(SceneOverride, ReplacesAValue)
{
    const RunConfig config = load(kBase, {"duration=2.5", "cloth.resolution=[4, 4]", "time.step=1e-3"});
    EXPECT_EQ(config.duration, 2.5);
    EXPECT_EQ(config.cloth.vertex_count(), 41);
    EXPECT_EQ(config.settings.step, 1e-3);
}

TEST(SceneOverride, LetsTheLaterOneWin)
{
    EXPECT_EQ(load(kBase, {"duration=2", "duration=3"}).duration, 3.0);
}

TEST(SceneOverride, ReachesElementsByIndex)
{
    const RunConfig config = load(kBase + kPin + kPin, {"pin.1.release=0.5"});
    EXPECT_GT(config.scene.pins[0].release, 1e9);
    EXPECT_EQ(config.scene.pins[1].release, 0.5);
}

TEST(SceneOverride, ReachesElementsOfElements)
{
    const RunConfig config = load(kBase + kPin, {"pin.0.keyframes.0.time=0", "pin.0.keyframes.1.time=0.5",
                                                 "pin.0.keyframes.1.rotate={axis=[0,0,1],degrees=9}",
                                                 "pin.0.keyframes.1.rotate.degrees=10"});
    EXPECT_EQ(config.as_run["pin"][0]["keyframes"][1]["rotate"]["degrees"], 10.0);
}

TEST(SceneOverride, AppendsAtTheNextIndex)
{
    const RunConfig config = load(kBase + kPin, {"pin.1.material=[[1, 0], [1, 1]]", "pin.1.release=0.5"});
    ASSERT_EQ(config.scene.pins.size(), 2u);
    EXPECT_EQ(config.scene.pins[1].material.parts().front().min, Vec2(1.0, 0.0));
}

TEST(SceneOverride, MakesTablesThatAreMissing)
{
    const RunConfig config =
        load(kBase, {"gravity.acceleration=[0,0,-1]", "wind.velocity=[1,0,0]", "wind.gust.amplitude=0.1",
                     "wind.gust.frequency=2", "probe.0.name=tip", "probe.0.material=[1,1]"});
    EXPECT_EQ(config.scene.gravity->acceleration, Vec3(0.0, 0.0, -1.0));
    EXPECT_EQ(config.scene.wind->gust->frequency, 2.0);
    EXPECT_EQ(config.probes[0].name, "tip");
}

TEST(SceneOverride, ReplacesWholeTablesAndLists)
{
    const RunConfig config =
        load(kBase + kPin + kPin + "[gravity]\nacceleration = [0, 0, -1]\n", {"pin=[]", "gravity={}"});
    EXPECT_TRUE(config.scene.pins.empty());
    EXPECT_EQ(config.scene.gravity->acceleration, Vec3(0.0, 0.0, -9.81));
}

TEST(SceneOverride, TakesABareWordAsText)
{
    const RunConfig config = load(kBase, {"title=two words", "cloth.material.preset=silk",
                                          "cloth.pattern=\"diagonal\"", "time.integrator='implicit_euler'"});
    EXPECT_EQ(config.title, "two words");
    EXPECT_EQ(config.as_run["cloth"]["material"]["preset"], "silk");
    EXPECT_EQ(config.cloth.vertex_count(), 9);
    EXPECT_EQ(config.settings.integrator, Integrator::ImplicitEuler);
    EXPECT_EQ(load(kBase, {"title=a=b"}).title, "a=b");
}

TEST(SceneOverride, IsRefusedWhereItIsNotUtf8)
{
    EXPECT_THROW(load(kBase, {"title=\xff"}), InputError);
    EXPECT_THROW(load(kBase, {"title=\xc3"}), InputError);
}

TEST(SceneOverride, StandsForFileAndLineInWarnings)
{
    const RunConfig config = load(kBase, {"cloth.units=cm", "gravity={}"});
    ASSERT_EQ(config.warnings.size(), 1u);
    EXPECT_EQ(config.warnings[0], "--set cloth.units=cm: has no effect: the cloth is not from a file");
}

}  // namespace
}  // namespace arris
