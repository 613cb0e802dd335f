// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace arris {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

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
    EXPECT_EQ(lines[2], "  placed within 0.5 x 2 x 0 m of the world");
    EXPECT_THAT(lines[3], HasSubstr("cotton: density 0.15 kg/m^2, membrane 500 N/m"));
    EXPECT_THAT(lines, Contains("  gravity: [gravity] is there"));
    EXPECT_THAT(lines, Contains("  wind: no [wind]"));
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

TEST(Check, EndsWithTheWarnings)
{
    const auto lines = describe_scene(load("units = \"m\"\n"));
    EXPECT_EQ(lines.back(),
              "warning: s.toml:6: cloth.units = \"m\": has no effect: the cloth is not from a file");
}

}  // namespace
}  // namespace arris
