// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/warnings/scene_warnings.h"
#include "app/scene/scene_load.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kBase = "duration = 1\n[cloth]\nsize = [1, 1]\nresolution = [2, 2]\n";  // 4 lines
const std::string kPin = "[[pin]]\nmaterial = [[0, 0], [0, 1]]\n";
const std::string kBox = "[[obstacle]]\nbox = [1, 1, 1]\ntranslate = [0, 0, 9]\n";
const std::string kPull = "[[pull]]\nmaterial = [[1, 0], [1, 1]]\n";
const std::string kMoving = "cloth.velocity=[0,0,-1]";  // or a warning says that nothing moves

struct IneffectiveKey {
    std::string name;
    std::string text;  ///< after kBase
    std::string warning;
};

void PrintTo(const IneffectiveKey& key, std::ostream* out)
{
    *out << key.name;
}

class IneffectiveKeyTest : public ::testing::TestWithParam<IneffectiveKey> {};

TEST_P(IneffectiveKeyTest, IsTheOneWarning)
{
    const RunConfig config = load_scene(SceneSource{"s.toml", kBase + GetParam().text, {kMoving}});
    EXPECT_THAT(config.warnings, ::testing::ElementsAre("s.toml:" + GetParam().warning));
}

const std::vector<IneffectiveKey> kIneffectiveKeys = {
    {"Units", "units = \"cm\"\n", "5: cloth.units = \"cm\": has no effect: the cloth is not from a file"},
    {"Up", "up = \"y\"\n", "5: cloth.up = \"y\": has no effect: the cloth is not from a file"},
    {"UvScale", "uv_scale = 2\n", "5: cloth.uv_scale = 2: has no effect: the cloth is not from a file"},
    {"PatternAngle", "pattern = \"unstructured\"\npattern_angle = 10\n",
     "6: cloth.pattern_angle = 10: has no effect: an unstructured mesh has no direction"},
    {"Preset",
     "[cloth.material]\npreset = \"silk\"\ndensity = 1\nyoungs_modulus = 1\npoisson_ratio = "
     "0\nbending_stiffness = 0\n",
     "6: cloth.material.preset = \"silk\": has no effect: keys override all values of the preset"},
    {"Thickness", "[cloth.material]\nthickness = 1e-3\n",
     "6: cloth.material.thickness = 1e-3: has no effect: the scene has no obstacle"},
    {"Eol", "[eol]\nenabled = true\n",
     "6: eol.enabled = true: has no effect: no obstacle has a sharp feature"},
    {"Gravity", "[gravity]\nacceleration = [0, 0, 0]\n",
     "6: gravity.acceleration = [0, 0, 0]: has no effect: the acceleration is zero"},
    {"Drag", "[wind]\nvelocity = [1, 0, 0]\ndrag = 0\n", "5: wind: has no effect: wind.drag is zero"},
    {"AirDensity", "[wind]\nvelocity = [1, 0, 0]\nair_density = 0\n",
     "5: wind: has no effect: wind.air_density is zero"},
    {"GustAmplitude", "[wind]\nvelocity = [1, 0, 0]\ngust = { amplitude = 0, frequency = 1 }\n",
     "7: wind.gust = { amplitude = 0, frequency = 1 }: has no effect: the amplitude is zero"},
    {"GustOfStillAir", "[wind]\nvelocity = [0, 0, 0]\n[wind.gust]\namplitude = 1\nfrequency = 1\n",
     "7: wind.gust: has no effect: the wind's velocity is zero"},
    {"Force", kPull + "force = [0, 0, 0]\n", "7: pull.0.force = [0, 0, 0]: has no effect: the force is zero"},
    {"LateStart", kPull + "force = [0, 0, 1]\nstart = 1\n",
     "8: pull.0.start = 1: has no effect: the pull starts after the end of the run"},
    {"LateStop", kPull + "force = [0, 0, 1]\nstop = 1\n",
     "8: pull.0.stop = 1: has no effect: the run ends before that time"},
    {"LateRelease", kPin + "release = 1.5\n",
     "7: pin.0.release = 1.5: has no effect: the run ends before that time"},
    {"EarlyRelease", kPin + "release = 0\n",
     "7: pin.0.release = 0: has no effect: the pin is released before it holds anything"},
    {"LatePinStart", kPin + "start = 1\n",
     "7: pin.0.start = 1: has no effect: the pin starts after the end of the run"},
    {"KeyframeBeforePinStart",
     kPin + "start = 0.5\nkeyframes = [ { time = 0.1 }, { time = 0.5 }, { time = 0.6 } ]\n",
     "8: pin.0.keyframes.0.time = 0.1: has no effect: the next keyframe is not after the start of the pin"},
    {"Pivot", kPin + "pivot = [0, 0, 1]\n",
     "7: pin.0.pivot = [0, 0, 1]: has no effect: there is no angular_velocity"},
    {"VelocityAcross", kPin + "velocity = [1, 0, 0]\ndirections = [\"z\"]\n",
     "7: pin.0.velocity = [1, 0, 0]: has no effect: the pin does not hold x"},
    {"LateKeyframe", kPin + "keyframes = [ { time = 0 }, { time = 1 }, { time = 1.5 } ]\n",
     "7: pin.0.keyframes.2.time = 1.5: has no effect: the previous keyframe is not before the end of the "
     "run"},
    {"KeyframeAfterRelease",
     kPin + "release = 0.5\nkeyframes = [ { time = 0 }, { time = 0.5 }, { time = 0.6 } ]\n",
     "8: pin.0.keyframes.2.time = 0.6: has no effect: the previous keyframe is not before the release"},
    {"UnreachedKeyframe", kPin + "keyframes = [ { time = 0 }, { time = 1.5 } ]\n",
     "7: pin.0.keyframes.1.time = 1.5: is not reached: the run ends at 1 s, on the way to this keyframe "
     "(times "
     "are in seconds, not frames)"},
    {"UnreachedObstacleKeyframe",
     "[[obstacle]]\nbox = [1, 1, 1]\nkeyframes = [ { time = 0, translate = [0, 0, 9] }, { time = 24, "
     "translate = "
     "[0, 0, 8] } ]\n",
     "7: obstacle.0.keyframes.1.time = 24: is not reached: the run ends at 1 s, on the way to this keyframe "
     "(times are in seconds, not frames)"},
    {"Density", "[cloth.material]\ndensity = 150\n",
     "6: cloth.material.density = 150: exceeds that of any cloth: the unit is kg/m^2, and 150 g/m^2 are "
     "0.15"},
    {"SidewaysGravity", "[gravity]\nacceleration = [0, -9.81, 0]\n",
     "6: gravity.acceleration = [0, -9.81, 0]: does not point down: up is +z, so that gravity is [0, 0, "
     "-9.81]; "
     "a file with y up needs up = \"y\""},
    {"UpwardGravity", "[gravity]\nacceleration = [0, 0, 9.81]\n",
     "6: gravity.acceleration = [0, 0, 9.81]: does not point down: up is +z, so that gravity is [0, 0, "
     "-9.81]; "
     "a file with y up needs up = \"y\""},
    {"ObstacleUnits", kBox + "units = \"cm\"\n",
     "8: obstacle.0.units = \"cm\": has no effect: the obstacle is not from a file"},
    {"ObstacleUp", kBox + "up = \"y\"\n",
     "8: obstacle.0.up = \"y\": has no effect: the obstacle is not from a file"},
    {"Closed", kBox + "closed = true\n",
     "8: obstacle.0.closed = true: has no effect: the obstacle is not a wire"},
    {"FeatureAngle", "[[obstacle]]\npoints = [[0, 0, 9]]\nfeature_angle = 20\n",
     "7: obstacle.0.feature_angle = 20: has no effect: the obstacle has no faces"},
    {"Motion", kBox + "motion = {}\n",
     "8: obstacle.0.motion = {}: has no effect: the motion has no velocity"},
    {"MotionPivot", kBox + "motion = { velocity = [0, 0, 1], pivot = [1, 1, 1] }\n",
     "8: obstacle.0.motion.pivot = [1, 1, 1]: has no effect: there is no angular_velocity"},
    {"MotionStart", kBox + "motion = { velocity = [0, 0, 1], start = 1 }\n",
     "8: obstacle.0.motion.start = 1: has no effect: the motion starts after the end of the run"},
    {"MotionStop", kBox + "motion = { velocity = [0, 0, 1], stop = 2 }\n",
     "8: obstacle.0.motion.stop = 2: has no effect: the run ends before that time"},
    {"LateObstacleKeyframe",
     "[[obstacle]]\nbox = [1, 1, 1]\nkeyframes = [ { time = 1, translate = [0, 0, 9] }, { time = 2 } ]\n",
     "7: obstacle.0.keyframes.1.time = 2: has no effect: the previous keyframe is not before the end of the "
     "run"},
    {"Formats", "[output]\nframes_per_second = 0\nformats = [\"obj\"]\n",
     "7: output.formats = [\"obj\"]: has no effect: with frames_per_second = 0 there are no frames to "
     "export"},
    {"LongStep", "[time]\nstep = 0.1\n[output]\nframes_per_second = 20\n",
     "6: time.step = 0.1: is shortened to 0.05 s: steps end at frames and at the duration"},
    {"OverlappingPins", kPin + "velocity = [0, 0, 1]\n[[pin]]\nmaterial = [[0, 0], [1, 0]]\n",
     "9: pin.1.material = [[0, 0], [1, 0]]: holds 3 position components that pin.0 also holds; pin.1 alone "
     "moves them"},
    {"LaterOverlappingPins",
     kPin + "release = 0.5\nvelocity = [0, 0, 1]\n[[pin]]\nmaterial = [[0, 0], [1, 0]]\nstart = 0.4\n",
     "10: pin.1.material = [[0, 0], [1, 0]]: holds 3 position components that pin.0 also holds; pin.1 alone "
     "moves them"},
};

INSTANTIATE_TEST_SUITE_P(Scene, IneffectiveKeyTest, ::testing::ValuesIn(kIneffectiveKeys),
                         [](const auto& key) { return key.param.name; });

TEST(IneffectiveKeys, PinsThatHoldOneAfterTheOtherDoNotOverlap)
{
    const std::string pins = kPin + "release = 0.5\nvelocity = [0, 0, 1]\n" + kPin + "start = 0.5\n";
    EXPECT_THAT(load_scene(SceneSource{"s.toml", kBase + pins, {kMoving}}).warnings, IsEmpty());
}

struct Fall {
    std::string name, obstacle, set;
    bool misses;
};

// The cloth is the square [0, 1]^2 at z = 0 and falls by 4.905 m.
const Fall kFalls[] = {
    {"onto it", "box = [1, 1, 1]\ntranslate = [0.5, 0.5, -3]\n", "", false},
    {"not so far", "box = [1, 1, 1]\ntranslate = [0.5, 0.5, -6]\n", "", true},
    {"just so far", "box = [1, 1, 1]\ntranslate = [0.5, 0.5, -5.4]\n", "", false},
    {"past it", "box = [1, 1, 1]\ntranslate = [2.2, 0.5, -3]\n", "", true},
    {"along its side", "box = [1, 1, 1]\ntranslate = [1.52, 0.5, -3]\n", "", false},
    {"away from it", "box = [1, 1, 1]\ntranslate = [0.5, 0.5, 3]\n", "", true},
    {"upward to it", "box = [1, 1, 1]\ntranslate = [0.5, 0.5, 3]\n", "gravity.acceleration=[0,0,9.81]",
     false},
    {"it comes", "box = [1, 1, 1]\ntranslate = [0.5, 0.5, 3]\nmotion = { velocity = [0, 0, -9] }\n", "",
     false},
    {"blown to it", "box = [1, 1, 1]\ntranslate = [2.2, 0.5, -3]\n", "wind.velocity=[9,0,0]", false},
    {"thrown to it", "box = [1, 1, 1]\ntranslate = [2.2, 0.5, -3]\n", "cloth.velocity=[9,0,0]", false},
    {"onto a nail", "points = [[0.5, 0.5, -3]]\n", "", false},
    {"past a wire", "wire = [[3, 0, -1], [3, 1, -1]]\n", "", true},
};

TEST(SceneWarnings, TellOfAClothThatCanOnlyFallPastAllObstacles)
{
    for (const Fall& fall : kFalls) {
        SCOPED_TRACE(fall.name);
        const std::string text = kBase + "[[obstacle]]\nname = \"rock\"\n" + fall.obstacle + "[gravity]\n";
        std::vector<std::string> set;
        if (!fall.set.empty()) set.push_back(fall.set);
        const std::vector<std::string> warnings = load_scene(SceneSource{"s.toml", text, set}).warnings;
        const auto told =
            ::testing::Contains(HasSubstr("s.toml: the cloth reaches none of: rock: it only falls"));
        if (fall.misses)
            EXPECT_THAT(warnings, told);
        else
            EXPECT_THAT(warnings, ::testing::Not(told));
    }
}

TEST(SceneWarnings, TellOfAClothThatStartsStrained)
{
    const RunConfig config = load_scene(SceneSource{"s.toml", kBase, {"cloth.scale=3"}});
    EXPECT_THAT(config.warnings,
                ElementsAre(AllOf(HasSubstr("cloth.scale=3: starts the cloth strained, from 0 % "
                                            "to +200 %"),
                                  HasSubstr("change 'size' instead of 'scale'"))));
    EXPECT_THAT(load_scene(SceneSource{"s.toml", kBase, {"cloth.scale=1.05", kMoving}}).warnings,
                ::testing::IsEmpty());
}

/// A square of two triangles with this side, in the file's unit; with UVs of `uv` metres where that is given.
std::string square_obj(const std::string& side, const std::string& uv = "")
{
    std::string text = "v 0 0 0\nv " + side + " 0 0\nv " + side + " " + side + " 0\nv 0 " + side + " 0\n";
    if (uv.empty()) return text + "f 1 2 3\nf 1 3 4\n";
    text += "vt 0 0\nvt " + uv + " 0\nvt " + uv + " " + uv + "\nvt 0 " + uv + "\n";
    return text + "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";
}

TEST(SceneWarnings, TellOfBordersThatNearlyMeet)
{
    const TemporaryDirectory dir;
    write_bytes(dir / "s.toml", "duration = 1\n[cloth]\nfile = \"c.obj\"\n");
    // Two triangles: the second has places of its own, this much above those of the first.
    const auto warnings_at = [&](const std::string& z) {
        write_bytes(dir / "c.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 " + z + "\nv 1 1 " + z +
                                       "\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 3 0\nvt 4 1\nvt 3 1\n"
                                       "f 1/1 2/2 3/3\nf 4/4 5/5 6/6\n");
        return load_scene(dir / "s.toml", {kMoving}).warnings;
    };
    EXPECT_THAT(warnings_at("0"), IsEmpty()) << "sewn";
    EXPECT_THAT(
        warnings_at("1e-5"),
        ElementsAre(HasSubstr("s.toml:3: cloth.file = \"c.obj\": 4 vertices of its borders lie within half a "
                              "thickness of others, the first at (0, 0, 0) m, and stay open")));
    EXPECT_THAT(warnings_at("0.01"), IsEmpty());
}

TEST(SceneWarnings, TellOfAClothWhoseSizeIsNoCloths)
{
    const TemporaryDirectory dir;
    const auto of_file = [&](const std::string& obj, const std::string& keys) {
        write_bytes(dir / "c.obj", obj);
        write_bytes(dir / "s.toml", "duration = 1\n[cloth]\nfile = \"c.obj\"\n" + keys);
        return load_scene(dir / "s.toml", {kMoving}).warnings;
    };
    EXPECT_THAT(of_file(square_obj("500"), ""),
                ElementsAre(AllOf(HasSubstr("s.toml:3: cloth.file = \"c.obj\": the cloth is 500 x 500 m: "),
                                  HasSubstr("'units'"))));
    EXPECT_THAT(of_file(square_obj("500"), "units = \"mm\"\n"), IsEmpty());
    EXPECT_THAT(of_file(square_obj("0.5"), "units = \"mm\"\n"),
                ElementsAre(HasSubstr("the cloth is 0.0005 x 0.0005 m")));
    EXPECT_THAT(of_file(square_obj("500", "500"), ""), ElementsAre(HasSubstr("'uv_scale' for UVs")));
    EXPECT_THAT(of_file(square_obj("500", "0.5"), "units = \"mm\"\n"), IsEmpty());
    for (const auto& [obj, unit, size] :
         {std::tuple(square_obj("500"), "m", "500 x 500"), std::tuple(square_obj("60000"), "cm", "600 x 600"),
          std::tuple(square_obj("1"), "mm", "0.001 x 0.001"),
          std::tuple(square_obj("0.1"), "in", "0.00254 x 0.00254"),
          std::tuple(square_obj("500", "500"), "mm", "500 x 500")})
        EXPECT_THAT(of_file(obj, std::string("units = \"") + unit + "\"\n"),
                    ::testing::Contains(HasSubstr(std::string("cloth.units = \"") + unit +
                                                  "\": the cloth is " + size + " m: check this unit")));

    const auto of_size = [](const std::string& size, const std::string& resolution) {
        return load_scene(SceneSource{"s.toml",
                                      kBase,
                                      {"cloth.size=" + size, "cloth.resolution=" + resolution, kMoving}})
            .warnings;
    };
    EXPECT_THAT(of_size("[300,400]", "[3,4]"),
                ElementsAre(HasSubstr("the cloth is 300 x 400 m: sizes are in metres")));
    EXPECT_THAT(of_size("[1,50]", "[1,50]"), IsEmpty()) << "a ribbon";
}

TEST(SceneWarnings, TellOfAMeshThatResolvesTheBendsOfItsCloth)
{
    const auto of = [](std::vector<std::string> set) {
        set.insert(set.end(), {kMoving, "cloth.material.density=0.05"});
        return load_scene(SceneSource{"s.toml", kBase + kBox, set}).warnings;
    };
    // T = .05 kg/m^2 * 9.81 m/s^2 * 1 m; 16 cells' mean edge is .0505 m: T h^2 = 1.25e-3 J.
    const std::string stiff = "cloth.material.bending_stiffness=";
    EXPECT_THAT(of({stiff + "1.2e-3", "cloth.resolution=[16,16]", "gravity={}"}), IsEmpty());
    EXPECT_THAT(
        of({stiff + "1.3e-3", "cloth.resolution=[16,16]", "gravity={}"}),
        ElementsAre(AllOf(HasSubstr("cloth.material.bending_stiffness=1.3e-3: the mean edge of 0.0505 m"),
                          HasSubstr("eol.enabled = false"))));
    EXPECT_THAT(of({stiff + "1.2e-3", "cloth.resolution=[32,32]", "gravity={}"}), ::testing::SizeIs(1));
    EXPECT_THAT(of({stiff + "1.3e-3", "cloth.resolution=[16,16]", "gravity={}", "eol.enabled=false"}),
                IsEmpty());
    EXPECT_THAT(of({stiff + "1.3e-3", "cloth.resolution=[16,16]"}), IsEmpty()) << "nothing weighs";
}

TEST(SceneWarnings, TellOfFacesThatAreThinAndWhatToDo)
{
    const std::string nail = "[[obstacle]]\npoints = [[0, 0, 9]]\n";
    const auto of_cells = [&](const std::string& resolution) {
        return load_scene(SceneSource{"s.toml", kBase + nail, {"cloth.resolution=" + resolution, kMoving}})
            .warnings;
    };
    // Of a cell's four faces those on its long sides have atan(width / height) at their ends.
    EXPECT_THAT(of_cells("[12, 1]"),
                ElementsAre(AllOf(HasSubstr("cloth.resolution=[12, 1]: 24 of 48 faces have an angle below 5 "
                                            "degrees, the least 4.8 degrees at "),
                                  HasSubstr("cells with more even sides"))));
    EXPECT_THAT(of_cells("[11, 1]"), IsEmpty());
    EXPECT_THAT(load_scene(SceneSource{"s.toml", kBase, {"cloth.resolution=[12, 1]", kMoving}}).warnings,
                IsEmpty())
        << "no feature, no place for it";

    const TemporaryDirectory dir;
    write_bytes(dir / "c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.5 -0.01 0\nf 1 2 3\nf 1 4 2\n");
    write_bytes(dir / "s.toml", "duration = 1\n[cloth]\nfile = \"c.obj\"\n" + nail);
    EXPECT_THAT(
        load_scene(dir / "s.toml", {kMoving}).warnings,
        ElementsAre(AllOf(HasSubstr("cloth.file = \"c.obj\": 1 of 2 faces has an angle below 5 degrees, "
                                    "the least 1.1 degrees at "),
                          HasSubstr("remesh the file"))));
}

TEST(SceneWarnings, TellOfMoreVerticesThanRemeshingMayMake)
{
    const auto of = [](const std::string& keys) {
        return load_scene(SceneSource{"s.toml", kBase + "[remesh]\n" + keys, {kMoving}}).warnings;
    };
    EXPECT_THAT(
        of("edge_length = [1e-4, 2e-4]\nvertices = 300\n"),
        Contains(HasSubstr("remesh.vertices = 300: edges of 0.0002 m need more than 300 vertices on this "
                           "cloth, so edges may be as long as ")));
    EXPECT_THAT(of("edge_length = [1e-4, 2e-4]\n"), Contains(HasSubstr("remesh: edges of 0.0002 m need ")));
    EXPECT_THAT(of("edge_length = [0.01, 0.1]\nvertices = 300\n"), IsEmpty());
}

TEST(SceneWarnings, TellOfRemeshingBelowTheFirstMesh)
{
    const auto with = [](int vertices) {  // first mesh: 20 x 20 cells, of at least 441 vertices
        return load_scene(SceneSource{"s.toml",
                                      kBase + "[remesh]\nedge_length = [0.01, 0.5]\nvertices = " +
                                          std::to_string(vertices) + "\n",
                                      {kMoving, "cloth.resolution=[20, 20]"}})
            .warnings;
    };
    EXPECT_THAT(with(440),
                ElementsAre(AllOf(HasSubstr("remesh.vertices = 440: is below the "),
                                  HasSubstr(" vertices of the first mesh, so cells become coarser"))));
    EXPECT_THAT(with(900), IsEmpty());
}

TEST(SceneWarnings, TellOfAStandOffInOtherUnits)
{
    const auto load = [](const std::string& thickness) {
        return load_scene(SceneSource{
            "s.toml", kBase + "[cloth.material]\nthickness = " + thickness + "\n" + kBox, {kMoving}});
    };
    const RunConfig config = load("1");
    ASSERT_THAT(config.warnings, ::testing::SizeIs(1));
    EXPECT_THAT(config.warnings[0],
                ::testing::HasSubstr("cloth.material.thickness = 1: exceeds the mean edge"));
    EXPECT_THAT(load("0.4").warnings, ::testing::IsEmpty());
}

TEST(SceneWarnings, TellOfLayersTooThickForTheMeshOrTooNear)
{
    const TemporaryDirectory dir;
    std::string two;  // sheets of 1 x 1 m, 2 mm apart
    for (const std::string z : {" 0", " 0.002"})
        for (const std::string x : {"0 0", "1 0", "1 1", "0 1"})
            two += "v " + x + z + "\nvt " + (z == " 0" ? "" : "2") + x + "\n";
    write_bytes(dir / "two.obj", two + "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\nf 5/5 6/6 7/7\nf 5/5 7/7 8/8\n");
    const auto load = [&](const std::string& thickness) {
        write_bytes(dir / "s.toml", "duration = 1\n[cloth]\nfile = \"two.obj\"\n[gravity]\n[self_contact]\n" +
                                        thickness + "\n");
        return load_scene(dir / "s.toml", {kMoving}).warnings;
    };
    EXPECT_THAT(load(""), ::testing::IsEmpty());
    EXPECT_THAT(
        load("thickness = 0.01"),
        ElementsAre(HasSubstr("self_contact.thickness = 0.01: 8 of 8 vertices start nearer to another "
                              "layer than the 0.01 m that layers keep apart, the nearest 0.002 m")));
    EXPECT_THAT(
        load("thickness = 0.2"),
        ::testing::Contains(HasSubstr("self_contact.thickness = 0.2: layers keep 0.2 m apart, which is "
                                      "above a fifth of the mean height of the cloth's triangles, "
                                      "0.707 m")));
}

TEST(SceneWarnings, TellOfBordersThatTouchAndOfLayersTooThin)
{
    const std::string folds = R"(duration = 1
[cloth]
size = [0.3, 0.1]
resolution = [12, 4]
folds = [{ line = [[0.1, 0.1], [0.1, 0]], degrees = DEGREES }, { line = [[0.2, 0.1], [0.2, 0]], degrees = DEGREES }]
[gravity]
[self_contact]
)";
    const auto load = [&](const std::string& degrees, const std::string& more = "") {
        std::string text = folds + more;
        for (std::size_t at; (at = text.find("DEGREES")) != std::string::npos;) text.replace(at, 7, degrees);
        return load_scene(SceneSource{"s.toml", text, {kMoving}}).warnings;
    };
    EXPECT_THAT(load("119"), ::testing::Not(::testing::Contains(HasSubstr("start nearer"))));
    EXPECT_THAT(load("120"), ::testing::Contains(HasSubstr("vertices start nearer to another layer")));
    EXPECT_THAT(
        load("90", "thickness = 1e-6\n"),
        ::testing::Contains(HasSubstr("self_contact.thickness = 1e-6: layers keep only 1e-06 m apart")));
}

TEST(SceneWarnings, TellOfAModulusInPascal)
{
    const auto load = [](const std::string& modulus) {
        return load_scene(
            SceneSource{"s.toml", kBase + "[cloth.material]\nyoungs_modulus = " + modulus + "\n", {kMoving}});
    };
    const RunConfig config = load("2e9");
    ASSERT_THAT(config.warnings, ::testing::SizeIs(1));
    EXPECT_THAT(config.warnings[0],
                ::testing::HasSubstr("youngs_modulus = 2e9: exceeds that of any cloth: the unit is N/m"));
    EXPECT_THAT(load("1e5").warnings, ::testing::IsEmpty());
}

TEST(SceneWarnings, TellOfATurnThatSlerpCannotMean)
{
    const auto turned = [](const std::string& degrees) {
        return kBase + kPin +
               "keyframes = [ { time = 0 }, { time = 0.5, rotate = { axis = [0, 0, 1], degrees = " + degrees +
               " } } ]\n";
    };
    const RunConfig config = load_scene(SceneSource{"s.toml", turned("360"), {kMoving}});
    ASSERT_THAT(config.warnings, ::testing::SizeIs(1));
    EXPECT_THAT(config.warnings[0], ::testing::HasSubstr("rotates by 360 degrees"));
    EXPECT_THAT(load_scene(SceneSource{"s.toml", turned("180"), {kMoving}}).warnings, ::testing::IsEmpty());
}

TEST(SceneWarnings, AreNotGivenForDefaultsOfTheSameValue)
{
    const RunConfig config =
        load_scene(SceneSource{"s.toml", kBase + kPin + "[output]\nframes_per_second = 0\n", {kMoving}});
    EXPECT_TRUE(config.warnings.empty());
}

TEST(SceneWarnings, AreNotGivenForKeysThatWork)
{
    const std::string text =
        kBase + "[time]\nstep = 0.05\n[output]\nframes_per_second = 20\n" + kPin +
        "velocity = [0, 0, 1]\nangular_velocity = [0, 0, 1]\npivot = [0, 0, 1]\nrelease = 0.5\n" + kPull +
        "force = [0, 0, 1]\nstart = 0.5\nstop = 0.9\n[cloth.material]\npreset = \"silk\"\ndensity = 1\n";
    EXPECT_THAT(load_scene(SceneSource{"s.toml", text, {kMoving}}).warnings, ::testing::IsEmpty());
}

TEST(SceneWarnings, TellOfAClothThatNothingMoves)
{
    const auto is_told = [](const std::string& text, const std::vector<std::string>& overrides = {}) {
        const auto warnings = load_scene(SceneSource{"s.toml", kBase + text, overrides}).warnings;
        return std::any_of(warnings.begin(), warnings.end(), [](const std::string& line) {
            return line.starts_with("s.toml: nothing moves the cloth: there is no [gravity], ");
        });
    };
    for (const std::string& text : {std::string(), kPin, kBox, "[gravity]\nacceleration = [0, 0, 0]\n" + kPin,
                                    kPull + "force = [0, 0, 0]\n", kPull + "force = [0, 0, 1]\nstart = 1\n",
                                    std::string("[wind]\nvelocity = [0, 0, 0]\n"),
                                    std::string("[wind]\nvelocity = [1, 0, 0]\ndrag = 0\n"),
                                    kPin + "velocity = [0, 0, 1]\nrelease = 0\n",
                                    kBox + "motion = { velocity = [0, 0, 1], start = 1 }\n"})
        EXPECT_TRUE(is_told(text)) << text;
    for (const std::string& text :
         {std::string("[gravity]\n"), std::string("[wind]\nvelocity = [1, 0, 0]\n"),
          kPull + "force = [0, 0, 1]\n", kPin + "velocity = [0, 0, 1]\n",
          kPin + "keyframes = [ { time = 0 }, { time = 0.5, translate = [0, 0, 1] } ]\n",
          kPin + "keyframes = [ { time = 0, translate = [0.1, 0, 0] } ]\n",
          kBox + "motion = { velocity = [0, 0, -1] }\n",
          std::string("folds = [ { line = [[0.5, 0], [0.5, 1]], degrees = 60 } ]\n"),
          std::string("velocity = [1, 0, 0]\n")})
        EXPECT_FALSE(is_told(text)) << text;
    EXPECT_FALSE(is_told("", {"cloth.scale=1.01"})) << "it pulls itself to its size";
}

}  // namespace
}  // namespace arris
