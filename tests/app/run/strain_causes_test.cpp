// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/strain_causes.h"
#include "app/scene/scene_load.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace arris {
namespace {

using ::testing::HasSubstr;

// E = 500 N/m, 0.15 kg/m^2, 1 m x 0.5 m, mean edge 0.0808 m.
const std::string kBase = "duration = 1\n[cloth]\nsize = [1, 0.5]\nresolution = [10, 5]\n";
const std::string kPins = "[[pin]]\nmaterial = [[0, 0], [0, 0.5]]\n[[pin]]\nmaterial = [[1, 0], [1, 0.5]]\n";
const std::string kCorner = "[[pin]]\nmaterial = [[0, 0], [0, 0]]\n";

struct CauseCase {
    std::string name, scene;
    std::vector<std::string> set;
    std::string stretch, compression;
};

const CauseCase kCauses[] = {
    {"nothing",
     "",
     {},
     "no load or pin of the scene explains it",
     "a fold needs several edges of the mesh, whose"},
    // 0.15 * 9.81 * 1 / 500
    {"light",
     "[gravity]\n",
     {},
     "explains it, the greatest being its weight (density * gravity * length / "
     "youngs_modulus): 0.294 %",
     "a fold needs several edges"},
    {"heavy",
     "[gravity]\n",
     {"cloth.material.density=30"},
     "youngs_modulus) alone strains it by 58.9 %: lower "
     "cloth.material.density, which is in kg/m^2, or raise",
     "alone strains it by 58.9 %: lower cloth.material.density"},
    {"soft", "[gravity]\n", {"cloth.material.youngs_modulus=10"}, "alone strains it by 14.7 %", "by 14.7 %"},
    // 50 / (0.5 * 500)
    {"pulled",
     "[[pull]]\nmaterial = [[1, 0], [1, 0.5]]\nforce = [30, 0, 40]\n",
     {},
     "pull.0 (force / (width * "
     "youngs_modulus)) alone strains it by 20 %: lower pull.0.force",
     "pull.0"},
    // 0.6 * 10^2 / 500
    {"blown",
     "[wind]\nvelocity = [0, 0, 10]\n",
     {},
     "the wind (pressure * length / youngs_modulus) alone strains it by "
     "12 %",
     "the wind"},
    {"pinned apart",
     kPins,
     {"pin.1.velocity=[0.4,0,0]"},
     "pin.0 and pin.1 are then 20 % farther apart than the "
     "material between them: move them less far",
     "and pulled cloth contracts across the pull"},
    {"pinned together",
     kPins,
     {"pin.1.velocity=[-0.4,0,0]"},
     "no load or pin",
     "pin.0 and pin.1 are then 20 % nearer "
     "than the material between them: leave it room to fold"},
    {"released", kPins, {"pin.1.velocity=[0.4,0,0]", "pin.1.release=0.3"}, "no load or pin", "a fold needs"},
    {"held in one direction",
     kPins,
     {"pin.1.velocity=[0.4,0,0]", "pin.1.directions=['x']"},
     "no load or pin",
     "a fold needs"},
    // 0.5 m^2 * 1 kg/m^2 * 9.81 / (0.0808 * 500)
    {"hangs on a corner",
     "[gravity]\n" + kCorner,
     {"cloth.material.density=1"},
     "its whole weight on one pinned "
     "vertex stretches it by 12",
     "a fold needs"},
    {"scaled",
     "",
     {"cloth.scale=0.7"},
     "it starts strained, from -30 % to +0 %, as cloth.scale = 0.7 scales its "
     "positions but not its material: change cloth.size instead",
     "cloth.scale = 0.7"},
};

TEST(StrainCauses, AreMeasuredInTheScene)
{
    for (const CauseCase& one : kCauses) {
        SCOPED_TRACE(one.name);
        const RunConfig config = load_scene(SceneSource{"s.toml", kBase + one.scene, one.set});
        const StrainPeak stretch = {0.3, 0.5, Vec3::Zero(), Vec2(0.05, 0.05)};
        const StrainPeak compression = {-0.3, 0.5, Vec3::Zero(), Vec2(0.05, 0.05)};
        EXPECT_THAT(explain_stretch(config, stretch), HasSubstr(one.stretch));
        EXPECT_THAT(explain_compression(config, compression), HasSubstr(one.compression));
    }
}

// The sheet lies at z = 0; 57.7 m/s is the speed of sound in it.
struct MovingCase {
    const char* name;
    std::string scene;
    double time;  ///< s, of the peak
    Vec3 peak;    ///< m, material and world
    std::string says;
};

TEST(StrainCauses, NameTheObstacleOrPinThatMoves)
{
    const std::string rim = kPins + "[gravity]\n";
    const auto box = [](const std::string& name, const std::string& more) {
        return "[[obstacle]]\nname = \"" + name + "\"\nbox = [0.1, 0.1, 0.1]\n" + more + "\n";
    };
    const std::string resting = box("post", "translate = [0.5, 0.25, -0.06]");
    const Vec3 middle(0.5, 0.25, 0.0);
    const MovingCase kMoving[] = {
        {"a fast obstacle that has stopped",
         rim + box("ram",
                   "translate = [0.5, 0.25, 0.1]\nmotion = { velocity = [0, 0, -20], start = 0.1, stop "
                   "= 0.11 }"),
         0.12,
         {0.5, 0.25, -0.15},
         "ram moves 0.2 m, at up to 20 m/s there: move it more slowly or less far"},
        {"a slow one that goes far",
         rim + box("ram", "translate = [0.5, 0.25, 0.1]\nmotion = { velocity = [0, 0, -0.5] }"),
         0.5,
         {0.5, 0.25, -0.2},
         "ram moves 0.25 m, at up to 0.5 m/s there: move it less far"},
        {"keyframes",
         rim + box("ram",
                   "keyframes = [{time = 0, translate = [0.5, 0.25, 0.1]}, {time = 0.5, translate = "
                   "[0.5, 0.25, -0.2]}]"),
         0.5,
         {0.5, 0.25, -0.15},
         "ram moves 0.3 m, at up to 0.6 m/s there: move it less far"},
        {"a rotor",
         box("rotor",
             "translate = [0.5, 0.25, 0.06]\nmotion = { angular_velocity = [0, 0, 25.13274], pivot = [0, "
             "0.25, 0] }"),
         0.5, middle, "rotor moves 1 m, at up to 12.6 m/s there: move it more slowly"},
        {"one of two",
         rim + resting + box("ram", "translate = [0.5, 0.25, 0.1]\nmotion = { velocity = [0, 0, -0.5] }"),
         0.5,
         {0.5, 0.25, -0.2},
         "ram moves"},
        {"the nearer of two",
         rim + box("far", "translate = [0.5, 5, 0.1]\nmotion = { velocity = [0, 0, -50] }") +
             box("ram", "translate = [0.5, 0.25, 0.1]\nmotion = { velocity = [0, 0, -0.5] }"),
         0.5,
         {0.5, 0.25, -0.2},
         "ram moves"},
        {"far from the peak, at a pin",
         rim + box("ram", "translate = [0.5, 0.25, 0.1]\nmotion = { velocity = [0, 0, -0.5] }"),
         0.5,
         {0.0, 0.0, 0.0},
         "ram moves 0.25 m, at up to 0.5 m/s: move it less far"},
        {"a pin that pulls cloth over a post",
         resting + "[[pin]]\nmaterial = [[0, 0], [0, 0.5]]\nvelocity = [-0.5, 0, 0]\n", 0.5, middle,
         "pin.0 moves 0.25 m, at up to 0.5 m/s: move it less far"},
        {"a pin that jerks",
         resting + "[[pin]]\nmaterial = [[0, 0], [0, 0.5]]\nvelocity = [-30, 0, 0]\nrelease = 0.003\n",
         0.01,
         {0.05, 0.25, 0.0},
         "pin.0 moves 0.09 m, at up to 30 m/s there: move it more slowly"},
        {"cloth that is thrown", "[gravity]\n" + resting, 0.5, middle,
         "the cloth (cloth.velocity) starts at 25 m/s: move it more slowly"},
        {"an obstacle that starts later",
         rim + box("ram", "translate = [0.5, 0.25, 0.1]\nmotion = { velocity = [0, 0, -20], start = 0.3 }"),
         0.2, middle, "no load or pin"},
        {"an obstacle at rest", rim + resting, 0.5, middle, "no load or pin"},
        {"a small way",
         rim + box("ram", "translate = [0.5, 0.25, 0.1]\nmotion = { velocity = [0, 0, -0.02] }"),
         0.5,
         {0.5, 0.25, 0.0},
         "no load or pin"},
    };
    for (const MovingCase& one : kMoving) {
        SCOPED_TRACE(one.name);
        const bool is_thrown =
            one.scene.find("velocity") == std::string::npos && one.says.starts_with("the cloth");
        const RunConfig config = load_scene(SceneSource{
            "s.toml", kBase + one.scene,
            is_thrown ? std::vector<std::string>{"cloth.velocity=[0,0,-25]"} : std::vector<std::string>{}});
        const StrainPeak peak = {0.3, one.time, one.peak, one.peak.head<2>()};
        EXPECT_THAT(explain_stretch(config, peak), ::testing::StartsWith(one.says));
    }
}

TEST(StrainCauses, OfACornerCountNearItAlone)
{
    const RunConfig config =
        load_scene(SceneSource{"s.toml", kBase + "[gravity]\n" + kCorner, {"cloth.material.density=1"}});
    const StrainPeak far = {0.3, 0.5, Vec3::Zero(), Vec2(0.5, 0.25)};
    EXPECT_THAT(explain_stretch(config, far), HasSubstr("no load or pin of the scene explains it"));
}

TEST(StrainCauses, OfOneKindShareALine)
{
    const RunConfig config = load_scene(SceneSource{"s.toml", kBase, {"cloth.scale=0.7"}});
    StrainPeaks peaks;
    peaks.stretch = {0.3, 0.1, Vec3::Zero(), Vec2(0.1, 0.1)};
    peaks.compression = {-0.6, 0.2, Vec3::Zero(), Vec2(0.2, 0.1)};
    peaks.in_plane = {-0.4, 0.2, Vec3::Zero(), Vec2(0.3, 0.1)};
    const std::vector<std::string> lines = warn_of_strain(peaks, config);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_THAT(lines[0],
                ::testing::AllOf(HasSubstr("stretched by 30 %"), HasSubstr("compressed by 60 %"),
                                 HasSubstr("compressed by 40 %"), HasSubstr("and stayed plane: woven")));
    // One place, and one line, where the greatest compression is that of plane cloth.
    const RunConfig unscaled = load_scene(SceneSource{"s.toml", kBase, {}});
    peaks.compression = peaks.in_plane;
    EXPECT_EQ(warn_of_strain(peaks, unscaled).size(), 2u);
}

}  // namespace
}  // namespace arris
