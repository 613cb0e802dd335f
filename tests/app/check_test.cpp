// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/scene/parts/scene_effects.h"
#include "app/scene/scene_load.h"

namespace arris {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

RunConfig load(const std::string& extra)
{
    return load_scene(SceneSource{
        "s.toml",
        "title = \"a\\u001b[31mb\"\nduration = 1\n[cloth]\nsize = [2, 0.5]\nresolution = [4, 2]\n" + extra,
        {}});
}

TEST(Check, DescribesTheScene)
{
    const auto lines =
        describe_scene(load("rotate = { axis = [0, 0, 1], degrees = 90 }\n[[pin]]\nmaterial = [[0, 0], [0, "
                            "0.5]]\nrelease = 0.5\n[gravity]\n"
                            "[[pull]]\nmaterial = [[2, 0], [2, 0]]\nforce = [0, 0, 1]\n[[probe]]\nname = "
                            "\"tip\"\nmaterial = [2, 0.25]\n"
                            "[output]\nframes_per_second = 0\n"));
    EXPECT_EQ(lines[0], "title: a\\u001b[31mb");
    EXPECT_EQ(lines[1], "cloth: 2 x 0.5 m of material, 1 m^2, 0.15 kg; 23 vertices, 32 faces");
    EXPECT_EQ(lines[2], "  mesh edges: mean 0.323 m, from 0.25 to 0.5 m; least angle 26.6 degrees");
    EXPECT_EQ(lines[3], "  initial extent: 0.5 x 2 x 0 m");
    EXPECT_THAT(lines[4], HasSubstr("cotton: density 0.15 kg/m^2, membrane 500 N/m"));
    EXPECT_THAT(lines, Contains("  gravity: [gravity] is given"));
    EXPECT_THAT(lines, Contains("  wind: no [wind]"));
    EXPECT_THAT(lines, Contains(HasSubstr("  friction: no [friction]: ")));
    EXPECT_THAT(lines, Contains(HasSubstr("  remesh: no [remesh]: ")));
    EXPECT_THAT(lines, Contains("  damping: cloth.material.damping is 0 s"));
    EXPECT_THAT(lines, Contains("pin.0: 3 vertices in [[0, 0], [0, 0.5]], at rest, until 0.5 s"));
    EXPECT_THAT(lines, Contains("pull.0: [0, 0, 1] N on 1 vertex of [[2, 0], [2, 0]]"));
    EXPECT_THAT(lines, Contains(HasSubstr("probe tip: material point [2, 0.25], in face ")));
    EXPECT_THAT(lines, Contains("run: 1 s, BDF2 in 200 steps of at most 0.005 s; 0 frames"));
    EXPECT_THAT(lines, Contains(HasSubstr("of memory (this machine has ")));
}

TEST(Check, SaysWhichEffectsAreOnAndWhy)
{
    const auto effects = list_effects(
        load("[cloth.material]\nbending_stiffness = 0\ndamping = 0.1\n[wind]\nvelocity = [1, 0, 0]\n"));
    std::string on;
    for (const SceneEffect& effect : effects) {
        EXPECT_FALSE(effect.reason.empty()) << effect.name;
        if (effect.is_on) on += effect.name + " ";
    }
    EXPECT_EQ(effects.size(), 11u);
    EXPECT_EQ(on, "damping wind ");
}

TEST(Check, DescribesObstaclesWithTheirFeaturesAndMotion)
{
    const auto lines =
        describe_scene(load("[[obstacle]]\nname = \"table\"\nbox = [1, 2, 0.5]\ntranslate = [0, 0, "
                            "5]\nmotion = { velocity = [0, 0, "
                            "1], start = 0.5 }\n"
                            "[[obstacle]]\npoints = [[0, 0, 9], [1, 0, 9]]\n"
                            "[[obstacle]]\nwire = [[0, 0, 9], [3, 0, 9]]\nkeyframes = [ { time = 0 }, { time "
                            "= 0.5, translate = [0, "
                            "0, 1] } ]\n"));
    EXPECT_THAT(lines, Contains("obstacle table: box, 12 triangles in 1 closed surface"));
    EXPECT_THAT(lines,
                Contains("  extent at time 0: 1 x 2 x 0.5 m, from [-0.5, -1, 4.75] to [0.5, 1, 5.25]"));
    EXPECT_THAT(lines, Contains("  sharp features: 12 edges in 12 lines, 14 m in all, the shortest line 0.5 "
                                "m, 1.55 times the cloth's mean edge; 8 corners or points"));
    EXPECT_THAT(lines, Contains("  moves at [0, 0, 1] m/s from 0.5 s on"));
    EXPECT_THAT(lines, Contains("obstacle obstacle1: points, 2 lone points"));
    EXPECT_THAT(lines, Contains("  sharp features: 2 corners or points"));
    EXPECT_THAT(lines, Contains("  at rest"));
    EXPECT_THAT(lines, Contains("obstacle obstacle2: wire, 1 wire segment"));
    EXPECT_THAT(lines, Contains("  2 keyframes from 0 s to 0.5 s"));
    EXPECT_THAT(lines, Contains("the cloth is clear of all obstacles at time 0"));
    EXPECT_THAT(lines, Contains("  obstacle: 3 [[obstacle]]: table, obstacle1, obstacle2"));
    EXPECT_THAT(lines, Contains(HasSubstr("  eol: eol.enabled is true, and an obstacle has sharp features")));
}

TEST(Check, SaysTheLimitOfFoldsOverAWire)
{
    const std::string nail = "[[obstacle]]\npoints = [[0, 0, 9]]\n";
    const std::string wire = "[[obstacle]]\nwire = [[0, 0, 9], [3, 0, 9]]\n";
    const auto limit = HasSubstr("known limit: where cloth is folded over a wire");
    EXPECT_THAT(describe_scene(load(wire + nail + wire)), Contains(limit).Times(1));
    EXPECT_THAT(describe_scene(load(nail)), Not(Contains(limit)));
    EXPECT_THAT(describe_scene(load(wire + "[eol]\nenabled = false\n")), Not(Contains(limit)));
}

TEST(Check, SaysWhatAPinRidesOn)
{
    const auto lines = describe_scene(
        load("[[obstacle]]\nname = \"rod\"\nwire = [[0, 0, 9], [3, 0, 9]]\n[[pin]]\nmaterial = [[0, 0], [0, "
             "0.5]]\nfollow = \"rod\"\n"));
    EXPECT_THAT(lines, Contains("pin.0: 3 vertices in [[0, 0], [0, 0.5]], moves with rod"));
}

}  // namespace
}  // namespace arris
