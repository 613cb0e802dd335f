// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/scene_obstacles.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "app/scene/scene_load.h"
#include "geometry/input_error.h"
#include "solver/step.h"
#include "tests/app/error_of.h"
#include "tests/app/program.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

constexpr double kRoundOff = 1e-14;  // of lengths of about 1 m
const std::string kBase = "duration = 1\n[cloth]\nsize = [1, 1]\nresolution = [2, 2]\n";  // at z = 0
const std::string kThrown = "cloth.velocity=[0,0,1]";  // or a warning says that it only falls, past them

RunConfig load(const std::string& text, const LoadOptions& options = with_program())
{
    return load_scene(SceneSource{"s.toml", text, {}}, options);
}

/// A tetrahedron with its right angle at the origin and legs of 1, 2, 3 units.
constexpr const char* kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

Box3 world_bounds(const MovingObstacle& obstacle, double time)
{
    Box3 box;
    for (const Vec3& point : obstacle.shape().mesh().points) box.extend(obstacle.at(time).placement(point));
    return box;
}

void expect_box(const Box3& box, const Vec3& least, const Vec3& greatest)
{
    EXPECT_NEAR((box.min() - least).norm(), 0.0, kRoundOff) << box.min().transpose();
    EXPECT_NEAR((box.max() - greatest).norm(), 0.0, kRoundOff) << box.max().transpose();
}

TEST(SceneObstacles, BuildsEveryShape)
{
    const RunConfig config =
        load(kBase +
             "[[obstacle]]\nbox = [1, 2, 3]\ntranslate = [0, 0, 5]\n"
             "[[obstacle]]\nname = \"nails\"\npoints = [[0, 0, 1], [0.5, 0, 2]]\n"
             "[[obstacle]]\nwire = [[0, 0, 1], [1, 0, 1], [1, 1, 1]]\n"
             "[[obstacle]]\nwire = [[0, 0, 1], [1, 0, 1], [1, 1, 1]]\nclosed = true\n"
             "[[obstacle]]\nteeth = { count = 2, pitch = 0.5, height = 0.25, width = 2, tip_degrees = 60 }\n"
             "translate = [0, 0, -4]\n[gravity]\n");
    const std::vector<MovingObstacle>& obstacles = config.scene.obstacles;
    ASSERT_EQ(obstacles.size(), 5U);
    EXPECT_EQ(obstacles[0].name(), "obstacle0");
    EXPECT_EQ(obstacles[1].name(), "nails");
    EXPECT_EQ(obstacles[4].name(), "obstacle4");
    expect_box(world_bounds(obstacles[0], 0.0), {-0.5, -1.0, 3.5}, {0.5, 1.0, 6.5});
    EXPECT_THAT(obstacles[1].shape().mesh().lone_points, SizeIs(2));
    EXPECT_THAT(obstacles[2].shape().mesh().segments, SizeIs(2));
    EXPECT_THAT(obstacles[3].shape().mesh().segments, SizeIs(3));
    EXPECT_EQ(world_bounds(obstacles[4], 0.0).max().z(), -3.75);
    EXPECT_THAT(config.warnings, IsEmpty());
}

TEST(SceneObstacles, WritesTheirDefaultsOutAndOnlyThoseOfTheirShape)
{
    const auto json =
        load(kBase + "[[obstacle]]\nbox = [1, 1, 1]\ntranslate = [0, 0, 5]\n").as_run["obstacle"][0];
    EXPECT_EQ(json["name"], "obstacle0");
    EXPECT_EQ(json["scale"], 1.0);
    EXPECT_EQ(json["feature_angle"], 14.0);
    EXPECT_EQ(json["rotate"]["degrees"], 0.0);
    for (const char* absent : {"file", "units", "up", "closed", "motion", "keyframes", "points"})
        EXPECT_FALSE(json.contains(absent)) << absent;
}

/// A cylinder around y of radius 0.5 as OBJ text with six digits.
std::string cylinder_obj(int sides)
{
    std::string text;
    for (const int y : {0, 1})
        for (int k = 0; k < sides; ++k) {
            const double angle = 2.0 * M_PI * k / sides;
            text += fmt::format("v {:.6f} {} {:.6f}\n", 0.5 * std::sin(angle), y, 0.5 * std::cos(angle));
        }
    for (int k = 0; k < sides; ++k) {
        const int next = (k + 1) % sides;
        text += fmt::format("f {} {} {} {}\n", k + 1, next + 1, next + 1 + sides, k + 1 + sides);
    }
    for (const int first : {1, 1 + sides}) {
        text += "f";
        for (int k = 0; k < sides; ++k) text += fmt::format(" {}", first + k);
        text += "\n";
    }
    return text;
}

// 14 degrees is the turn of no regular polygon: 25 sides turn by 14.4 degrees, 26 sides by 13.8.
TEST(SceneObstacles, SidesOfACylinderAreSharpByDefaultUpToTwentyFive)
{
    TemporaryDirectory directory;
    const std::string path = directory / "cylinder.obj";
    struct Case {
        int sides;
        const char* key;
        bool are_sharp;
    };
    for (const Case& c : {Case{12, "", true},
                          {24, "", true},
                          {25, "", true},
                          {26, "", false},
                          {32, "", false},
                          {12, "feature_angle = 29.98\n", true},
                          {12, "feature_angle = 30\n", false},
                          {12, "feature_angle = 30.02\n", false},
                          {24, "feature_angle = 15\n", false}}) {
        std::ofstream(path) << cylinder_obj(c.sides);
        const RunConfig config =
            load(kBase + "[[obstacle]]\nfile = \"" + path + "\"\n" + c.key + "translate = [0, 0, 5]\n");
        EXPECT_THAT(config.scene.obstacles[0].shape().features().edges,
                    SizeIs((c.are_sharp ? 3 : 2) * c.sides))
            << c.sides << " sides, " << c.key;
    }
}

TEST(SceneObstacles, RidgesOfTeethAreSharpByDefaultAboveFourteenDegrees)
{
    struct Case {
        double tip;  // degrees
        bool are_sharp;
    };
    for (const Case& c : {Case{165.97, true}, {166.0, false}, {166.03, false}, {150.0, true}}) {
        const RunConfig config = load(
            kBase + fmt::format("[[obstacle]]\nteeth = {{ count = 3, pitch = 4, height = 0.1, width = 1, "
                                "tip_degrees = {} }}\ntranslate = [0, 0, -4]\n",
                                c.tip));
        const ObstacleFeatures& features = config.scene.obstacles[0].shape().features();
        const ObstacleMesh& mesh = config.scene.obstacles[0].shape().mesh();
        int ridges = 0;
        for (const FeatureEdge& edge : features.edges) {
            const auto& [a, b] = config.scene.obstacles[0].shape().topology().edges[edge.edge].points;
            if (mesh.points[a].z() > 0.05 && mesh.points[b].z() > 0.05) ++ridges;
        }
        EXPECT_EQ(ridges, c.are_sharp ? 3 : 0) << c.tip << " degrees";
    }
}

TEST(SceneObstacles, PlacesThemByScaleRotationAndTranslation)
{
    const RunConfig config = load(kBase +
                                  "[[obstacle]]\nwire = [[0, 0, 0], [1, 0, 0], [1, 2, 0]]\nscale = 2\n"
                                  "rotate = { axis = [0, 0, 1], degrees = 90 }\ntranslate = [0, 0, 5]\n");
    const MovingObstacle& wire = config.scene.obstacles[0];
    const Placement placement = wire.at(0.0).placement;
    // translate + R (2 p): x turns to y, y to -x.
    const Vec3 expected[] = {{0.0, 0.0, 5.0}, {0.0, 2.0, 5.0}, {-4.0, 2.0, 5.0}};
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR((placement(wire.shape().mesh().points[static_cast<std::size_t>(i)]) - expected[i]).norm(),
                    0.0, kRoundOff);
}

TEST(SceneObstacles, MovesThemAsWritten)
{
    const RunConfig config = load(
        kBase +
        "[[obstacle]]\npoints = [[0, 0, 5]]\ntranslate = [1, 0, 0]\n"
        "motion = { velocity = [0, 0, 1], angular_velocity = [0, 0, 2], pivot = [1, 1, 0], start = 0.25, "
        "stop = 0.75 }\n"
        "[[obstacle]]\npoints = [[0, 0, 5]]\nkeyframes = [ { time = 0, translate = [0, 0, 1] }, { time = "
        "1, translate = [0, 4, 1] } ]\n");
    const MovingObstacle &turning = config.scene.obstacles[0], &keyed = config.scene.obstacles[1];
    const auto place = [](const MovingObstacle& obstacle, double time) {
        return obstacle.at(time).placement(obstacle.shape().mesh().points[0]);
    };
    EXPECT_EQ(place(turning, 0.25), Vec3(1.0, 0.0, 5.0));
    // p = pivot + v tau + R(2 tau)(p0 - pivot), tau = 0.5, p0 - pivot = (0, -1, 5)
    const Vec3 turned(1.0 + std::sin(1.0), 1.0 - std::cos(1.0), 5.5);
    EXPECT_NEAR((place(turning, 0.75) - turned).norm(), 0.0, kRoundOff);
    EXPECT_EQ(place(turning, 9.0), place(turning, 0.75));
    EXPECT_NEAR((place(keyed, 0.0) - Vec3(0, 0, 6)).norm(), 0.0, kRoundOff);
    EXPECT_NEAR((place(keyed, 0.5) - Vec3(0, 2, 6)).norm(), 0.0, kRoundOff);
    EXPECT_THAT(input_jumps(config.scene), ElementsAre(0.25, 0.75, 1.0));
}

TEST(SceneObstacles, TheirTimesSnapToFramesAsAllOthersDo)
{
    const RunConfig config =
        load(kBase +
             "[output]\nframes_per_second = 10\n[[obstacle]]\npoints = [[0, 0, 5]]\nmotion = { "
             "velocity = [0, 0, 1], start = 0.30000000000000004 }\n");
    EXPECT_EQ(config.scene.obstacles[0].motion().start, 3 / 10.0);
}

TEST(SceneObstacles, APinFollowsByName)
{
    const RunConfig config = load(
        kBase +
        "[[obstacle]]\npoints = [[0, 0, 5]]\n"
        "[[obstacle]]\nname = \"rod\"\nwire = [[0, 0, 5], [1, 0, 5]]\nmotion = { velocity = [0, 0, 1] }\n"
        "[[pin]]\nmaterial = [[0, 0], [0, 1]]\nfollow = \"rod\"\n");
    ASSERT_TRUE(config.scene.pins[0].follows);
    EXPECT_EQ(*config.scene.pins[0].follows, 1);
    EXPECT_EQ(config.as_run["pin"][0]["follow"], "rod");
    for (const char* absent : {"velocity", "angular_velocity", "pivot", "keyframes"})
        EXPECT_FALSE(config.as_run["pin"][0].contains(absent)) << absent;
    const Placement half_way = pin_placement(config.scene, config.scene.pins[0], {}, 0.5);
    EXPECT_NEAR((half_way(Vec3(0, 1, 0)) - Vec3(0, 1, 0.5)).norm(), 0.0, kRoundOff);
}

TEST(SceneObstacles, ReadsFilesBesideTheSceneInTheirUnits)
{
    const TemporaryDirectory dir;
    std::filesystem::create_directories(dir / "meshes");
    write_bytes(dir / "meshes/wedge.obj", kTetrahedron);
    write_bytes(dir / "s.toml",
                kBase +
                    "[[obstacle]]\nfile = \"meshes/wedge.obj\"\ntranslate = [0, 0, 5]\n"
                    "[[obstacle]]\nfile = \"meshes/wedge.obj\"\nunits = \"cm\"\nup = \"y\"\nscale = 10\n"
                    "translate = [0, 0, 5]\n");
    const RunConfig config = load_scene(dir / "s.toml", {}, with_program());
    expect_box(world_bounds(config.scene.obstacles[0], 0.0), {0.0, 0.0, 5.0}, {1.0, 2.0, 8.0});
    // y up becomes z: (x, y, z) -> (x, -z, y), a tenth as large.
    expect_box(world_bounds(config.scene.obstacles[1], 0.0), {0.0, -0.3, 5.0}, {0.1, 0.0, 5.2});
    EXPECT_EQ(config.scene.obstacles[0].shape().topology().is_solid, std::vector<char>{1});
}

TEST(SceneObstacles, TellOfAFileThatIsMostlyInOtherUnits)
{
    const TemporaryDirectory dir;
    write_bytes(dir / "wedge.obj", kTetrahedron);
    const auto warnings_of = [&](const std::string& keys) {
        write_bytes(dir / "s.toml",
                    kBase + "[[obstacle]]\nfile = \"wedge.obj\"\ntranslate = [0, 0, 500]\n" + keys);
        return load_scene(dir / "s.toml", {kThrown}, with_program()).warnings;
    };
    EXPECT_THAT(warnings_of(""), IsEmpty());
    EXPECT_THAT(warnings_of("scale = 5\n"), IsEmpty());
    EXPECT_THAT(warnings_of("scale = 100\n"),
                ElementsAre(AllOf(HasSubstr("obstacle.0.file"),
                                  HasSubstr("374 m in size and the cloth 1.41 m"), HasSubstr("'units'"))));
    EXPECT_THAT(warnings_of("scale = 1e-3\n"), IsEmpty());
    EXPECT_THAT(warnings_of("scale = 1e-4\n"), SizeIs(1));
    EXPECT_THAT(warnings_of("scale = 100\nunits = \"m\"\n"),
                ElementsAre(AllOf(HasSubstr("obstacle.0.units"), HasSubstr("check this unit"))));
}

TEST(SceneObstacles, TellOfASurfaceThatClosesButForAHole)
{
    const TemporaryDirectory dir;
    const std::string cube =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
        "f 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    const auto warnings_of = [&](const std::string& obj) {
        write_bytes(dir / "box.obj", obj);
        write_bytes(dir / "s.toml",
                    kBase + "[[obstacle]]\nfile = \"box.obj\"\ntranslate = [0, 0, 5]\n[gravity]\n");
        return load_scene(dir / "s.toml", {kThrown}, with_program()).warnings;
    };
    EXPECT_THAT(warnings_of(cube),
                ElementsAre(AllOf(HasSubstr("s.toml:6: obstacle.0.file = \"box.obj\": "),
                                  HasSubstr("a surface is closed except for a hole (4 border edges)"),
                                  HasSubstr("without an inside"))));
    EXPECT_THAT(warnings_of(cube + "f 5 6 7 8\n"), IsEmpty()) << "with a lid";
    EXPECT_THAT(warnings_of("v 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nf 1 2 3\nf 1 3 4\n"), IsEmpty())
        << "an open sheet is meant as one";
    // The low box of a table top, without its upper side, or a half of it; a tetrahedron without a face.
    const std::string table =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 .05\nv 1 0 .05\nv 1 1 .05\nv 0 1 .05\n"
        "f 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    for (const std::string& open : {table, table + "f 5 6 7\n",
                                    std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                                                "f 1 3 2\nf 1 2 4\nf 1 4 3\n")})
        EXPECT_THAT(warnings_of(open), ElementsAre(HasSubstr("a surface is closed except for a hole")))
            << open;
    // A box without two sides that meet, a roof, and a ramp.
    const std::string corner = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
    for (const char* faces : {"f 1 4 3 2\nf 1 2 6 5\n", "f 1 4 3 2\nf 1 2 6 5\nf 4 1 5 8\n"})
        EXPECT_THAT(warnings_of(corner + faces), IsEmpty()) << faces;
    // Three sides of a long box, and four of them: a channel and a tube.
    const std::string channel =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 9\nv 1 0 9\nv 1 1 9\nv 0 1 9\n"
        "f 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\n";
    EXPECT_THAT(warnings_of(channel), IsEmpty());
    EXPECT_THAT(warnings_of(channel + "f 4 1 5 8\n"), IsEmpty());
    // A hemisphere of rings of eight.
    std::string bowl = "v 0 0 0\n";
    constexpr int kRings = 4, kAround = 8;
    for (int ring = 1; ring <= kRings; ++ring)
        for (int k = 0; k < kAround; ++k) {
            const double down = 0.5 * M_PI * ring / kRings, around = 2.0 * M_PI * k / kAround;
            bowl += fmt::format("v {} {} {}\n", std::sin(down) * std::cos(around),
                                std::sin(down) * std::sin(around), 1.0 - std::cos(down));
        }
    for (int ring = 0; ring < kRings; ++ring)
        for (int k = 0; k < kAround; ++k) {
            const auto at = [&](int r, int j) { return r == 0 ? 1 : 2 + (r - 1) * kAround + j % kAround; };
            if (ring > 0) bowl += fmt::format("f {} {} {}\n", at(ring, k), at(ring + 1, k), at(ring, k + 1));
            bowl += fmt::format("f {} {} {}\n", at(ring, k + 1), at(ring + 1, k), at(ring + 1, k + 1));
        }
    EXPECT_THAT(warnings_of(bowl), IsEmpty());
}

TEST(SceneObstacles, TellWhereFacesCrossAndWhatToDo)
{
    const TemporaryDirectory dir;
    // A leaf through another, within 2 to 3 cm.
    write_bytes(dir / "leaves.obj",
                "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 2 2 -1\nv 2 2 1\nv 3 3 1\n"
                "f 1 2 3\nf 4 5 6\n");
    write_bytes(dir / "s.toml", kBase +
                                    "[[obstacle]]\nfile = \"leaves.obj\"\nunits = \"cm\"\ntranslate = [0, 0, "
                                    "5]\n[gravity]\n");
    EXPECT_THAT(load_scene(dir / "s.toml", {kThrown}, with_program()).warnings,
                ElementsAre(AllOf(HasSubstr("1 pair of faces crosses, overlaps or touches"),
                                  HasSubstr("near [0.025, 0.025, 0] (m, z up, before it is scaled"),
                                  HasSubstr("unite its parts"))));
}

TEST(SceneObstacles, BlamesTheKeyThatNamesABadFileAndTellsWhatWasRepaired)
{
    const TemporaryDirectory dir;
    const std::string scene = dir / "s.toml";
    write_bytes(scene, kBase + "[[obstacle]]\nfile = \"table.obj\"\ntranslate = [0, 0, 5]\n[gravity]\n");
    const auto refusal = [&] { return error_of([&] { load_scene(scene, {}, with_program()); }); };
    EXPECT_THAT(refusal(), HasSubstr("s.toml:6: obstacle.0.file = \"table.obj\": "));
    write_bytes(dir / "table.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_THAT(refusal(), HasSubstr("s.toml:6: obstacle.0.file = \"table.obj\": "));
    EXPECT_EQ(refusal().find('\n'), std::string::npos);

    write_bytes(dir / "table.obj", kTetrahedron + std::string("f 2 3 4\n"));
    const RunConfig config = load_scene(scene, {kThrown}, with_program());
    EXPECT_THAT(config.warnings, ElementsAre(HasSubstr("s.toml:6: obstacle.0.file = \"table.obj\": ")));

    LoadOptions options = with_program();
    options.importer = {"/bin/false"};
    EXPECT_THAT(error_of([&] { load_scene(scene, {}, options); }), HasSubstr("obstacle.0.file"));
}

TEST(SceneObstacles, TakeTheStoredMeshesWhateverBecameOfTheFiles)
{
    const TemporaryDirectory dir;
    write_bytes(dir / "wedge.obj", kTetrahedron);
    write_bytes(dir / "s.toml",
                kBase + "[[obstacle]]\nfile = \"wedge.obj\"\nscale = 2\ntranslate = [0, 0, 5]\n");
    const RunConfig first = load_scene(dir / "s.toml", {}, with_program());
    const std::vector<ObstacleRecord> records = record_obstacles(first);
    std::filesystem::remove(dir / "wedge.obj");

    LoadOptions options;
    options.importer = {};
    options.cloth = &first.cloth;
    options.obstacles = &records;
    const RunConfig again = load_scene(dir / "s.toml", {}, options);
    EXPECT_EQ(again.scene.obstacles[0].shape().mesh().points, first.scene.obstacles[0].shape().mesh().points);
    EXPECT_EQ(again.scene.obstacles[0].at(0.0).placement.translation, Vec3(0, 0, 5));

    std::vector<ObstacleRecord> others = records;
    others[0].name = "other";
    options.obstacles = &others;
    EXPECT_THAT(error_of([&] { load_scene(dir / "s.toml", {}, options); }),
                HasSubstr("obstacle0 is not among the obstacles that the run stored"));
    const std::vector<ObstacleRecord> none;
    options.obstacles = &none;
    EXPECT_THAT(error_of([&] { load_scene(dir / "s.toml", {}, options); }),
                HasSubstr("is missing, in which the run stored its obstacles"));
}

const std::string kCrate = "[[obstacle]]\nname = \"crate\"\nbox = [0.4, 0.4, 0.4]\n";

TEST(SceneObstacles, RefuseClothThatIntersectsThemOnlyAtTime0)
{
    const std::string inside = kBase + kCrate + "translate = [0.5, 0.5, 0.1]\n";
    EXPECT_THAT(error_of([&] { load(inside); }),
                AllOf(HasSubstr("crate"), HasSubstr("0.1 m deep"),
                      HasSubstr("move the cloth or the obstacle ('translate')"), Not(HasSubstr("'units'"))));

    LoadOptions telling = with_program();
    telling.tells_intersections = true;
    const RunConfig told = load(inside, telling);
    EXPECT_THAT(told.intersections, ElementsAre(HasSubstr("0.1 m deep into crate")));

    // A resumed run's cloth is where it is.
    LoadOptions resumed = with_program();
    const std::vector<ObstacleRecord> records = record_obstacles(told);
    resumed.cloth = &told.cloth;
    resumed.obstacles = &records;
    EXPECT_EQ(load(inside, resumed).cloth.world, told.cloth.world);
}

TEST(SceneObstacles, AskAfterUnitsWhereAFileIntersectsTheCloth)
{
    const TemporaryDirectory dir;
    write_bytes(dir / "wedge.obj", kTetrahedron);
    write_bytes(dir / "s.toml",
                kBase + "[[obstacle]]\nfile = \"wedge.obj\"\ntranslate = [0.2, 0.2, -0.1]\n[gravity]\n");
    EXPECT_THAT(error_of([&] { load_scene(dir / "s.toml", {}, with_program()); }),
                AllOf(HasSubstr("at least 0.001 m apart"), HasSubstr("'units'")));
}

TEST(SceneObstacles, MeetTheClothWherePinsHaveItAtTime0)
{
    // Without its pin the cloth is at z = 0, in the crate; its pin lifts all of it out.
    const std::string lifted =
        "[[pin]]\nmaterial = [[0, 0], [1, 1]]\nkeyframes = [ { time = 0, translate = [0, 0, 3] } ]\n";
    EXPECT_EQ(error_of([&] { load(kBase + kCrate + "translate = [0.5, 0.5, 0]\n" + lifted); }), "");
    EXPECT_THAT(error_of([&] { load(kBase + kCrate + "translate = [0.5, 0.5, 3]\n" + lifted); }),
                HasSubstr("crate"));
}

TEST(SceneObstacles, MoveClothOutThatIsClearButNearerThanItsThickness)
{
    // The crate's top is 0.2 mm below the cloth, whose middle vertex is above it.
    const RunConfig config = load(kBase + kCrate + "translate = [0.5, 0.5, -0.2002]\n[gravity]\n");
    EXPECT_THAT(config.warnings,
                ElementsAre(AllOf(HasSubstr("nearer to obstacles than its thickness, 0.001 m"),
                                  HasSubstr("vertices are moved out to that distance"))));
    for (int v = 0; v < config.cloth.vertex_count(); ++v)
        if ((config.cloth.material[static_cast<std::size_t>(v)] - Vec2(0.5, 0.5)).norm() < 0.1) {
            EXPECT_GE(config.cloth.world[static_cast<std::size_t>(v)].z(),
                      0.0008 - 1e-9);  // thickness - 0.2 mm
        }
    EXPECT_THAT(load(kBase + kCrate + "translate = [0.5, 0.5, -0.2012]\n[gravity]\n").warnings, IsEmpty());
}

TEST(SceneObstacles, BlameTheThicknessWhereItStrainsTheCloth)
{
    const std::string scene = kBase + "[gravity]\n" + kCrate + "translate = [0.5, 0.5, -0.25]\n";
    const auto load_with = [&](const std::vector<std::string>& overrides) {
        return load_scene(SceneSource{"s.toml", scene, overrides}, with_program()).warnings;
    };
    EXPECT_THAT(
        load_with({"cloth.material.thickness=0.6"}),
        ElementsAre(AllOf(HasSubstr("nearer to obstacles than its thickness, 0.6 m"),
                          HasSubstr("is then strained from "), HasSubstr("reduce cloth.material.thickness"),
                          HasSubstr("mean edge 0.416 m")),
                    HasSubstr("0.6: exceeds the mean edge of the cloth's mesh, 0.416 m: ")));
    // What is strained where it is placed still is its UVs' doing.
    EXPECT_THAT(
        load_with({"cloth.material.thickness=0.07", "cloth.scale=3"}),
        ElementsAre(Not(HasSubstr("is then strained")), HasSubstr("material coordinates are in metres")));
}

/// A box of half the side `half` about (0.5, 0.5, 0), with faces that look `inward` or outward, and without
/// its upper side if it `is_open`. `first` is the number of its first vertex.
std::string room_obj(double half, bool is_inward, bool is_open = false, int first = 1)
{
    std::string text;
    for (int corner = 0; corner < 8; ++corner)
        text += fmt::format("v {} {} {}\n", 0.5 + (corner & 1 ? half : -half),
                            0.5 + (corner & 2 ? half : -half), corner & 4 ? half : -half);
    const std::array<std::array<int, 4>, 6> kSides = {
        {{0, 2, 3, 1}, {0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}, {4, 5, 7, 6}}};
    for (std::size_t side = 0; side < (is_open ? 5 : 6); ++side) {
        auto [a, b, c, d] = kSides[side];
        if (is_inward) std::swap(b, d);
        text += fmt::format("f {} {} {} {}\n", a + first, b + first, c + first, d + first);
    }
    return text;
}

struct RoomCase {
    const char* name;
    std::string obj;
    const char* error;      ///< part of it; "" where the scene is valid
    const char* not_error;  ///< what it must not say
};

constexpr const char* kRoomAdvice =
    "wholly inside a closed surface, which is solid whichever way its faces look; for a room around the "
    "cloth, "
    "leave out a face, or give the walls an inner and an outer surface; else move";

TEST(SceneObstacles, TellWhatARoomNeedsWhereAClosedSurfaceHoldsTheWholeCloth)
{
    const RoomCase kRooms[] = {
        {"faces look inward", room_obj(2, true), kRoomAdvice, "intersects"},
        {"faces look outward", room_obj(2, false), kRoomAdvice, "intersects"},
        {"tetrahedron", "v -9 -9 -1\nv 19 -9 -1\nv 0 19 -1\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n",
         kRoomAdvice, "intersects"},
        {"open on top", room_obj(2, true, true), "", ""},
        {"walls with an inner and an outer surface", room_obj(2, true) + room_obj(3, false, false, 9), "",
         ""},
        {"both surfaces look outward", room_obj(2, false) + room_obj(3, false, false, 9), "", ""},
        {"cloth through the wall", room_obj(0.3, true), "deep into", "wholly inside"},
        {"cloth on the wall", "v 0 0 -1\nv 1 0 -1\nv 0 1 -1\nv 0 0 0\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n",
         "allowed: cloth that starts clear", "wholly inside"},
    };
    for (const RoomCase& one : kRooms) {
        SCOPED_TRACE(one.name);
        const TemporaryDirectory dir;
        write_bytes(dir / "room.obj", one.obj);
        write_bytes(dir / "s.toml", kBase + "[gravity]\n[[obstacle]]\nfile = \"room.obj\"\n");
        const std::string error = error_of([&] { load_scene(dir / "s.toml", {}, with_program()); });
        if (*one.error == '\0') {
            EXPECT_EQ(error, "");
        } else {
            EXPECT_THAT(error,
                        AllOf(HasSubstr(one.error), Not(HasSubstr(one.not_error)), Not(HasSubstr("\n"))));
        }
    }
}

TEST(SceneObstacles, SayThatASurfaceTurnedInsideOutIsSolid)
{
    const TemporaryDirectory dir;
    write_bytes(dir / "s.toml",
                kBase + "[gravity]\n[[obstacle]]\nfile = \"room.obj\"\ntranslate = [9, 0, 0]\n");
    write_bytes(dir / "room.obj", room_obj(2, true));
    EXPECT_THAT(load_scene(dir / "s.toml", {kThrown}, with_program()).warnings,
                ElementsAre(HasSubstr(
                    "turned 12 of 12 faces round, to agree with their neighbours and to face outward "
                    "(cavities: inward); a closed surface is solid, whichever way its faces look")));
    write_bytes(dir / "room.obj", room_obj(2, false));
    EXPECT_THAT(load_scene(dir / "s.toml", {kThrown}, with_program()).warnings, IsEmpty());
}

TEST(SceneObstacles, OfAPlausibleSizeAreNoSurpriseBesideAnyPlausibleCloth)
{
    struct Sizes {
        double half;   ///< of the box in the file, m
        double cloth;  ///< side, m
        bool is_told;
    };
    const Sizes kSizes[] = {
        {0.0003, 0.1, false},  // a needle's tip beside a napkin
        {0.0005, 1.0, false}, {0.0005, 10.0, false}, {0.002, 0.24, false},
        {0.002, 10.0, false}, {0.01, 3.0, false},    {0.014, 10.0, false},
        {0.05, 10.0, false},  {4.0, 0.1, false},     {4.0, 0.02, false},  // a room around a handkerchief
        {0.0002, 0.1, true},  {0.0002, 10.0, true},  {5.0, 0.1, true},    // a box of .1 m in centimetres
        {50.0, 2.0, true},    {500.0, 10.0, true},
    };
    for (const Sizes& one : kSizes) {
        SCOPED_TRACE(std::to_string(one.half) + " " + std::to_string(one.cloth));
        const TemporaryDirectory dir;
        write_bytes(dir / "box.obj", room_obj(one.half, false));
        write_bytes(dir / "s.toml", "duration = 1\n[cloth]\nsize = [" + std::to_string(one.cloth) + ", " +
                                        std::to_string(one.cloth) +
                                        "]\nresolution = [4, 4]\n[[obstacle]]\nfile = \"box.obj\"\n"
                                        "translate = [0, 0, -5000]\n");
        const auto is_of_size = HasSubstr("m in size and the cloth");
        const std::vector<std::string> warnings =
            load_scene(dir / "s.toml", {kThrown}, with_program()).warnings;
        EXPECT_EQ(std::any_of(warnings.begin(), warnings.end(),
                              [&](const std::string& line) { return ::testing::Value(line, is_of_size); }),
                  one.is_told);
    }
}

struct UnitCase {
    const char* keys;
    double half;          ///< of the box in the file
    const char* warning;  ///< after "obstacle.0."; "" without one
};

TEST(SceneObstacles, OfSurprisingSizeBlameTheUnitThatIsWrittenOrMissing)
{
    const UnitCase kUnits[] = {
        {"", 0.2, ""},
        {"units = \"m\"\n", 0.2, ""},
        {"units = \"cm\"\n", 20, ""},
        {"scale = 0.001\n", 200, ""},
        {"", 200, "file = \"box.obj\": the obstacle is 693 m in size and the cloth 1.41 m: a file that"},
        {"units = \"m\"\n", 200,
         "units = \"m\": the obstacle is 693 m in size and the cloth 1.41 m: check this unit, and 'scale'"},
        {"units = \"cm\"\n", 20000, "units = \"cm\": the obstacle is 693 m"},
        {"units = \"mm\"\n", 0.2, "units = \"mm\": the obstacle is 0.000693 m in size"},
        {"units = \"in\"\nscale = 100\n", 80, "units = \"in\": the obstacle is 704 m in size"},
        {"scale = 0.001\n", 0.2, "file = \"box.obj\": the obstacle is 0.000693 m in size"},
        // Of a factor 20 either way: centimetres in a table 5 times smaller or larger than the cloth.
        {"", 8.1, ""},
        {"", 8.2, "file = \"box.obj\": the obstacle is 28.4 m in size and the cloth 1.41 m: a file that"},
        {"units = \"m\"\n", 8.2, "units = \"m\": the obstacle is 28.4 m in size"},
    };
    for (const UnitCase& one : kUnits) {
        SCOPED_TRACE(std::string(one.keys) + std::to_string(one.half));
        const TemporaryDirectory dir;
        write_bytes(dir / "box.obj", room_obj(one.half, false));
        write_bytes(dir / "s.toml",
                    kBase + "[[obstacle]]\nfile = \"box.obj\"\n" + one.keys + "translate = [0, 0, -5000]\n");
        const std::vector<std::string> warnings =
            load_scene(dir / "s.toml", {kThrown}, with_program()).warnings;
        if (*one.warning == '\0')
            EXPECT_THAT(warnings, IsEmpty());
        else
            EXPECT_THAT(warnings, ElementsAre(HasSubstr(std::string("obstacle.0.") + one.warning)));
    }
}

}  // namespace
}  // namespace arris
