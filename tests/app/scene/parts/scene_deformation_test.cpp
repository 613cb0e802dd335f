// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/scene_deformation.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "app/scene/scene_load.h"
#include "geometry/input_error.h"
#include "geometry/obstacle/point_cache.h"
#include "tests/app/error_of.h"
#include "tests/app/program.h"
#include "tests/app/temporary_directory.h"
#include "tests/elbow_body.h"
#include "tests/geometry/cache_files.h"
#include "tests/geometry/gltf_builder.h"

namespace arris {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// A tetrahedron in centimetres, y up, with an unused vertex in front.
constexpr const char* kBody =
    "v 99 99 99\nv 0 0 0\nv 0 0 100\nv 100 0 0\nv 0 100 0\nf 2 3 4\nf 2 5 3\nf 2 4 5\nf 3 5 4\n";

cache_files::Samples body_samples()
{
    cache_files::Samples samples;
    for (const double x : {0.0, 2.0, 4.0, 6.0})
        samples.push_back({{0, 0, 0}, {x, 0, 0}, {x, 0, 100}, {x + 100, 0, 0}, {x, 100, 0}});
    return samples;
}

struct SceneFolder {
    TemporaryDirectory dir;

    SceneFolder()
    {
        write_bytes(dir / "body.obj", kBody);
        write_bytes(dir / "body.pc2", cache_files::pc2(body_samples(), 1.0));
    }

    RunConfig load(const std::string& deform, const std::string& keys = "",
                   const std::string& file = "body.obj") const
    {
        write_bytes(
            dir / "s.toml",
            fmt::format("duration = 1\n[cloth]\nsize = [1, 1]\nresolution = [1, 1]\ntranslate = [0, 0, 9]\n"
                        "[[obstacle]]\nfile = \"{}\"\ndeform = {{ {} }}\nunits = \"cm\"\nup = \"y\"\n{}",
                        file, deform, keys));
        return load_scene(read_scene_source(dir / "s.toml", {}), with_program());
    }
    std::string refusal(const std::string& deform, const std::string& keys = "",
                        const std::string& file = "body.obj") const
    {
        const std::string error = error_of([&] { load(deform, keys, file); });
        EXPECT_EQ(error.find('\n'), std::string::npos);
        return error;
    }
};

const PointCache& cache_of(const RunConfig& config)
{
    return dynamic_cast<const PointCache&>(*config.scene.obstacles[0].deformation());
}

Vec3 place(const RunConfig& config, double time, std::size_t point)
{
    std::vector<Vec3> points, velocities;
    cache_of(config).find(time, points, velocities);
    return points.at(point);
}

TEST(SceneDeformation, FollowsTheMeshThroughUnitAxisAndScale)
{
    const SceneFolder folder;
    const RunConfig config = folder.load("file = \"body.pc2\"", "scale = 2\ntranslate = [0, 0, 5]\n");
    const std::vector<Vec3>& mesh = config.scene.obstacles[0].shape().mesh().points;
    ASSERT_EQ(mesh.size(), 4U);
    for (std::size_t p = 0; p < mesh.size(); ++p) {
        EXPECT_LT((place(config, 0.0, p) - mesh[p]).norm(), 1e-6);
        EXPECT_LT((place(config, 9.0, p) - mesh[p] - Vec3(0.12, 0, 0)).norm(), 1e-6);
    }
    EXPECT_EQ(cache_of(config).sample_times().back(), 3.0 / 24.0);
    EXPECT_THAT(config.notes, Contains(AllOf(HasSubstr("4 samples of 4 points from 0 s to 0.125 s"),
                                             HasSubstr("fastest vertex at 0.96 m/s"))));
    EXPECT_EQ(record_obstacles(config)[0].deformation, config.scene.obstacles[0].deformation());
}

TEST(SceneDeformation, KeysChooseTimesAndSamples)
{
    const SceneFolder folder;
    const auto times = [&](const std::string& keys) {
        return cache_of(folder.load("file = \"body.pc2\", frames_per_second = 10" + keys)).sample_times();
    };
    EXPECT_THAT(times(""), ElementsAre(0.0, 0.1, 0.2, 0.3));
    EXPECT_THAT(times(", start = 0.5, speed = 2"), ElementsAre(0.5, 0.55, 0.6, 0.65));
    EXPECT_THAT(times(", start = -0.125"), ElementsAre(-0.125, 0.1 - 0.125, 0.2 - 0.125, 0.3 - 0.125));
    EXPECT_THAT(times(", first = 1, last = 2"), ElementsAre(0.0, 0.1));
    EXPECT_THAT(times(", first = 3"), ElementsAre(0.0));
    EXPECT_THAT(cache_of(folder.load("file = \"body.pc2\"")).jumps(), IsEmpty());
    const RunConfig linear = folder.load("file = \"body.pc2\", interpolation = \"linear\"");
    EXPECT_EQ(cache_of(linear).jumps().size(), 3U);
    EXPECT_NEAR(place(folder.load("file = \"body.pc2\", first = 2"), 0.0, 0).x(), 0.04, 1e-7);
}

TEST(SceneDeformation, SamplesThatNearlyMeetAFrameOrAnEventAreThere)
{
    const SceneFolder folder;
    const RunConfig config = folder.load("file = \"body.pc2\", frames_per_second = 10, start = 0.1",
                                         "[output]\nframes_per_second = 10\n");
    EXPECT_NE(0.1 + 2.0 / 10.0, 0.3) << "no case to test";
    EXPECT_THAT(cache_of(config).sample_times(), ElementsAre(0.1, 0.2, 0.3, 0.4));
}

TEST(SceneDeformation, SharpEdgesBeginAt45Degrees)
{
    const SceneFolder folder;
    EXPECT_EQ(folder.load("file = \"body.pc2\"").as_run["obstacle"][0]["feature_angle"], 45.0);
    EXPECT_EQ(
        folder.load("file = \"body.pc2\"", "feature_angle = 20\n").as_run["obstacle"][0]["feature_angle"],
        20.0);
    EXPECT_EQ(folder.load("file = \"body.pc2\"", "[[obstacle]]\nbox = [1, 1, 1]\n")
                  .as_run["obstacle"][1]["feature_angle"],
              14.0);
}

TEST(SceneDeformation, ErrorsNameKeyFileAndSample)
{
    const SceneFolder folder;
    const std::string& dir = folder.dir.path();
    EXPECT_THAT(folder.refusal("file = \"no.pc2\""),
                AllOf(HasSubstr("s.toml:8: obstacle.0.deform.file = \"no.pc2\": "),
                      HasSubstr(dir + "/no.pc2: no such file")));
    EXPECT_THAT(folder.refusal("file = \"body.pc2\", last = 4"),
                HasSubstr("has no sample 4; allowed: 0 to 3"));
    EXPECT_THAT(folder.refusal("start = 1"), HasSubstr("obstacle.0.deform.file: is required"));
    EXPECT_THAT(folder.refusal("file = \"body.pc2\", speed = 0"), HasSubstr("allowed: a number > 0"));
    EXPECT_THAT(folder.refusal("file = \"body.pc2\", first = -1"), HasSubstr("allowed: "));
    EXPECT_THAT(folder.refusal("file = \"body.pc2\", rate = 3"), HasSubstr("unknown key"));

    cache_files::Samples samples = body_samples();
    samples[2][3].x() = 1e9;
    write_bytes(folder.dir / "far.pc2", cache_files::pc2(samples, 1.0));
    EXPECT_THAT(folder.refusal("file = \"far.pc2\""),
                HasSubstr(dir + "/far.pc2: sample 2, vertex 4 (1e+09, 0, 0)"));

    std::vector<Vec3>& first = samples[0];
    for (Vec3& p : first) p *= 0.01;
    write_bytes(folder.dir / "metres.pc2", cache_files::pc2(samples, 1.0));
    EXPECT_THAT(folder.refusal("file = \"metres.pc2\""), HasSubstr("its edges are 0.01 times as long"));
}

/// An elbow that closes until its legs overlap by 4 mm, in sample 3 of 6.
struct ElbowFolder : SceneFolder {
    ElbowBody body;

    ElbowFolder()
    {
        body.gap = -0.004;
        body.cell = 0.015;
        const ObstacleMesh mesh = body.make();
        std::string text;
        for (const Vec3& p : mesh.points) text += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
        for (const auto& [a, b, c] : mesh.faces) text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
        write_bytes(dir / "elbow.obj", text);
        cache_files::Samples samples;
        for (const double angle : {0.0, 1.5, 2.5, M_PI, 2.5, 1.5})
            samples.push_back(body.bend(mesh.points, angle));
        write_bytes(dir / "elbow.pc2", cache_files::pc2(samples, 1.0));
    }
    RunConfig load(const std::string& keys) const
    {
        write_bytes(dir / "s.toml",
                    "duration = 1\n[cloth]\nsize = [1, 1]\nresolution = [1, 1]\ntranslate = [0, 0, 9]\n"
                    "[[obstacle]]\nfile = \"elbow.obj\"\ndeform = { file = \"elbow.pc2\"" +
                        keys + " }\n");
        return load_scene(read_scene_source(dir / "s.toml", {}), with_program());
    }
};

TEST(SceneDeformation, FacesThatCrossAreToldWithTheirTimes)
{
    const RunConfig config = ElbowFolder().load(", frames_per_second = 10");
    EXPECT_THAT(config.warnings, Contains(AllOf(HasSubstr("obstacle.0.deform.file"), HasSubstr("faces cross"),
                                                HasSubstr("elbow.pc2: sample 3), at 0.3 s: "))));
}

TEST(SceneDeformation, ASlitPartsTheLegsOfAnElbow)
{
    const ElbowFolder folder;
    const RunConfig config = folder.load(", frames_per_second = 10, slit = 0.005");
    EXPECT_THAT(
        config.notes,
        Contains(AllOf(HasSubstr("obstacle.0.deform.slit = 0.005: the skin retreats in 6 of 6 samples"),
                       HasSubstr("elbow.pc2: sample"))));
    // The middles of the legs, 13 cm from the bend's two ends
    const std::vector<Vec3>& own = config.scene.obstacles[0].shape().mesh().points;
    double gap = 0.0;
    std::vector<Vec3> points, velocities;
    cache_of(config).find(0.3, points, velocities);
    const double far = folder.body.bend_length() + 0.1;
    const auto nearest = [&](const Vec3& rest) {
        return points[std::min_element(own.begin(), own.end(),
                                       [&](const Vec3& a, const Vec3& b) {
                                           return (a - rest).norm() < (b - rest).norm();
                                       }) -
                      own.begin()];
    };
    gap = (nearest({far, 0.0, 0.03}) - nearest({-0.1, 0.0, 0.03})).z();
    EXPECT_GT(gap, 0.0045);
    EXPECT_LT(gap, 0.009);

    EXPECT_THAT(folder.load(", frames_per_second = 10, slit = 0.001").warnings,
                Contains(AllOf(HasSubstr("obstacle.0.deform.slit"), HasSubstr("use 0.0025 m or more"))));
    EXPECT_THAT(error_of([&] { folder.load(", slit = 0"); }), HasSubstr("allowed: a number > 0"));
    EXPECT_THAT(
        error_of([&] { folder.load(", slit = 0.02"); }),
        HasSubstr("is too wide for this mesh; allowed: at most 0.00991 m, a fiftieth of the mesh's size"));
}

TEST(SceneDeformation, ArcsWithinAStepAreToldOf)
{
    const ElbowFolder folder;
    const auto arcs = Contains(HasSubstr("leaves its straight way by"));
    EXPECT_THAT(folder.load(", frames_per_second = 200").warnings, arcs);
    EXPECT_THAT(folder.load(", frames_per_second = 10").warnings, Not(arcs));
    EXPECT_THAT(folder.load(", frames_per_second = 200, interpolation = \"linear\"").warnings, Not(arcs));
}

TEST(SceneDeformation, ABodyInsideOutIsRefused)
{
    const SceneFolder folder;
    cache_files::Samples mirrored = body_samples(), swapped = body_samples();
    for (std::vector<Vec3>& sample : mirrored)
        for (Vec3& p : sample) p.x() = -p.x();
    for (std::vector<Vec3>& sample : swapped)
        for (Vec3& p : sample) std::swap(p.y(), p.z());
    for (const cache_files::Samples& samples : {mirrored, swapped}) {
        write_bytes(folder.dir / "odd.pc2", cache_files::pc2(samples, 1.0));
        EXPECT_THAT(
            folder.refusal("file = \"odd.pc2\""),
            AllOf(HasSubstr("odd.pc2: sample 0, the mesh is turned inside out"), HasSubstr("allowed: ")));
    }
}

TEST(SceneDeformation, AUsdTextHasItsOwnUnitAndAxis)
{
    // body.obj is in centimetres, y up.
    const SceneFolder folder;
    const auto write = [&](const std::string& head, double unit) {
        std::string text = "#usda 1.0\n(" + head + ")\ndef Mesh \"body\" { point3d[] points.timeSamples = {";
        for (const char* code : {"0", "24"}) {
            text += fmt::format("{}: [(0, 0, 0)", code);
            for (Vec3 p : {Vec3(0, 0, 0), Vec3(0, -1, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)}) {
                if (unit < 1.0) p = Vec3(p.x(), p.z(), -p.y());
                text += fmt::format(", ({}, {}, {})", p.x() / unit, p.y() / unit, p.z() / unit);
            }
            text += "], ";
        }
        write_bytes(folder.dir / "body.usda", text + "} }");
    };
    const auto expect_mesh = [&] {
        const RunConfig config = folder.load("file = \"body.usda\", prim = \"/body\"", "scale = 2\n");
        const std::vector<Vec3>& mesh = config.scene.obstacles[0].shape().mesh().points;
        ASSERT_EQ(mesh.size(), 4U);
        for (std::size_t p = 0; p < 4; ++p) EXPECT_LT((place(config, 0.0, p) - mesh[p]).norm(), 1e-12);
        EXPECT_EQ(cache_of(config).sample_times().back(), 1.0);
    };
    write("metersPerUnit = 1\nupAxis = \"Z\"", 1.0);
    expect_mesh();
    write("doc = 'nothing declared'", 0.01);
    expect_mesh();

    EXPECT_THAT(folder.refusal("file = \"body.pc2\", prim = \"/body\""),
                AllOf(HasSubstr("obstacle.0.deform.prim = \"/body\": contradicts obstacle.0.deform.file"),
                      HasSubstr("allowed: no prim, or a USD file")));
    EXPECT_THAT(folder.refusal("file = \"body.usda\", prim = \"/root\""),
                AllOf(HasSubstr("obstacle.0.deform.file"), HasSubstr("has no Mesh /root; allowed: /body")));
}

TEST(SceneDeformation, AGltfFileMovesItself)
{
    const SceneFolder folder;
    write_bytes(folder.dir / "bent.glb", make_bent_tetrahedron().glb());
    const auto load = [&](const std::string& keys) {
        write_bytes(folder.dir / "g.toml",
                    "duration = 1\n[cloth]\nsize = [1, 1]\nresolution = [1, 1]\ntranslate = [0, 0, 9]\n"
                    "[[obstacle]]\nfile = \"bent.glb\"\n" +
                        keys);
        return load_scene(read_scene_source(folder.dir / "g.toml", {}), with_program());
    };
    for (const char* keys : {"deform = {}\n", "deform = { file = \"bent.glb\", animation = \"walk\" }\n"}) {
        const RunConfig config = load(keys);
        EXPECT_EQ(cache_of(config).sample_times().size(), 25U);
        const std::vector<Vec3>& mesh = config.scene.obstacles[0].shape().mesh().points;
        ASSERT_EQ(mesh.size(), 4U);
        for (std::size_t p = 0; p < 4; ++p) EXPECT_LT((place(config, 0.0, p) - mesh[p]).norm(), 1e-6);
        // z up: the tip at (2, 0, 0) turns about the file's z axis to (1, 1, 0).
        const auto tip = std::find_if(mesh.begin(), mesh.end(),
                                      [](const Vec3& p) { return (p - Vec3(2, 0, 0)).norm() < 1e-6; });
        ASSERT_NE(tip, mesh.end());
        EXPECT_LT((place(config, 1.0, static_cast<std::size_t>(tip - mesh.begin())) - Vec3(1, 0, 1)).norm(),
                  1e-6);
    }
    // Unit and axis of the scene hold for the mesh and for its motion.
    const RunConfig other = load("deform = {}\nunits = \"cm\"\nup = \"z\"\n");
    const std::vector<Vec3>& mesh = other.scene.obstacles[0].shape().mesh().points;
    for (std::size_t p = 0; p < 4; ++p) EXPECT_LT((place(other, 0.0, p) - mesh[p]).norm(), 1e-8);
    EXPECT_NEAR(mesh[1].norm(), 0.02, 1e-8);

    const auto refusal = [&](const std::string& keys) { return error_of([&] { load(keys); }); };
    EXPECT_THAT(refusal("deform = { animation = \"run\" }\n"),
                AllOf(HasSubstr("bent.glb: it has no animation \"run\"; allowed: \"walk\"")));
    EXPECT_THAT(refusal("deform = { file = \"body.pc2\" }\n"),
                AllOf(HasSubstr("obstacle.0.deform.file"), HasSubstr("contradicts the obstacle's file"),
                      HasSubstr("allowed: a glTF file that moves itself")));
    EXPECT_THAT(refusal("deform = { prim = \"/a\" }\n"), HasSubstr("allowed: no prim, or a USD file"));
    EXPECT_THAT(folder.refusal("file = \"bent.glb\""), HasSubstr("contradicts the obstacle's file"));
    EXPECT_THAT(folder.refusal("file = \"body.pc2\", animation = \"walk\""),
                HasSubstr("allowed: no animation, or a glTF file"));
}

TEST(SceneDeformation, NeedsAFileWhoseVerticesHaveAnOrder)
{
    const SceneFolder folder;
    write_bytes(folder.dir / "body.stl",
                "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                "endfacet\nendsolid a\n");
    EXPECT_THAT(folder.refusal("file = \"body.pc2\"", "", "body.stl"),
                AllOf(HasSubstr("obstacle.0.file"), HasSubstr("allowed: OBJ, PLY or glTF")));
    write_bytes(folder.dir / "box.toml",
                "duration = 1\n[cloth]\nsize = [1, 1]\nresolution = [1, 1]\n[[obstacle]]\nbox = [1, 1, 1]\n"
                "deform = { file = \"body.pc2\" }\n");
    EXPECT_THAT(error_of([&] { load_scene(read_scene_source(folder.dir / "box.toml", {}), with_program()); }),
                AllOf(HasSubstr("box.toml:7: obstacle.0.deform"), HasSubstr("contradicts obstacle.0.box")));
}

TEST(SceneDeformation, WarnsOfCollapsedFacesFarMovesAndShortSamples)
{
    const SceneFolder folder;
    cache_files::Samples samples = body_samples();
    samples[1][4] = {2, 0, 50};    // on an edge
    samples[3][2] = {6, 0, -100};  // 2 m away
    write_bytes(folder.dir / "odd.pc2", cache_files::pc2(samples, 1.0));
    EXPECT_THAT(folder.load("file = \"odd.pc2\"").warnings,
                AllOf(Contains(AllOf(HasSubstr("obstacle.0.deform.file"), HasSubstr("has no area"),
                                     HasSubstr("sample 1"))),
                      Contains(AllOf(HasSubstr("vertex 3 moves 2 m"), HasSubstr("sample 3")))));
    EXPECT_THAT(folder.load("file = \"body.pc2\", frames_per_second = 1000").warnings,
                Contains(HasSubstr("samples are 0.001 s apart, less than time.step, 0.005 s")));
}

TEST(SceneDeformation, AResumedSceneTakesThePosesOfTheRun)
{
    const SceneFolder folder;
    const RunConfig first = folder.load("file = \"body.pc2\"");
    const TemporaryDirectory& dir = folder.dir;
    write_obstacles(dir.path(), record_obstacles(first));
    std::filesystem::remove(dir / "body.pc2");
    std::filesystem::remove(dir / "body.obj");
    const std::vector<ObstacleRecord> records = read_obstacles(dir.path());
    LoadOptions options;
    options.cloth = &first.cloth;
    options.obstacles = &records;
    const RunConfig again = load_scene(read_scene_source(dir / "s.toml", {}), options);
    for (const double t : {0.0, 0.03, 0.07, 1.0})
        for (std::size_t p = 0; p < 4; ++p) EXPECT_EQ(place(again, t, p), place(first, t, p));

    std::vector<ObstacleRecord> rigid = records;
    rigid[0].deformation = nullptr;
    options.obstacles = &rigid;
    EXPECT_THAT(error_of([&] { load_scene(read_scene_source(dir / "s.toml", {}), options); }),
                HasSubstr("obstacle.0.deform"));
}

}  // namespace
}  // namespace arris
