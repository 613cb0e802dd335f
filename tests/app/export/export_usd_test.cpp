// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/export/export_usd.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstring>

#include "geometry/input_error.h"
#include "geometry/obstacle_input/deform/vertex_cache.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "tests/app/error_of.h"
#include "tests/app/example_frame.h"
#include "tests/app/stretching_obstacle.h"
#include "tests/app/temporary_directory.h"
#include "tests/app/usda_parser.h"

namespace arris {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::string> write_frames(const TemporaryDirectory& dir, const std::vector<Frame>& frames)
{
    std::vector<std::string> paths;
    for (const Frame& frame : frames) {
        paths.push_back(dir / ("cloth_" + std::to_string(paths.size()) + ".ply"));
        write_frame(paths.back(), frame);
    }
    return paths;
}

FrameSource source_of(const std::vector<std::string>& paths)
{
    return {paths.size(), [paths](std::size_t i) { return read_frame(paths[i]); }};
}

std::string export_text(const std::vector<Frame>& frames, const UsdOptions& options = {"A title", 24.0})
{
    const TemporaryDirectory dir;
    write_usd(dir / "cloth.usda", source_of(write_frames(dir, frames)), options);
    return read_bytes(dir / "cloth.usda");
}

std::vector<double> times(const UsdaAttribute& attribute)
{
    std::vector<double> result;
    for (const auto& [time, value] : attribute.samples) result.push_back(time);
    return result;
}

template <class Vector>
std::vector<double> flat(const std::vector<Vector>& vectors)
{
    std::vector<double> result;
    for (const Vector& vector : vectors)
        result.insert(result.end(), vector.data(), vector.data() + vector.size());
    return result;
}

template <class Vector>
void expect_same(const UsdaValue& value, const std::vector<Vector>& vectors)
{
    const std::vector<double> read = value.numbers(), wanted = flat(vectors);
    EXPECT_EQ(value.kind, '[');
    EXPECT_EQ(value.items.size(), vectors.size());
    ASSERT_EQ(read.size(), wanted.size());
    // Bits, not values: -0 must stay -0.
    EXPECT_EQ(std::memcmp(read.data(), wanted.data(), read.size() * sizeof(double)), 0);
}

TEST(ExportUsd, DescribesTheStage)
{
    const std::string text =
        export_text({make_moved_frame(0), make_moved_frame(1), make_moved_frame(2)}, {"Tablecloth", 29.97});
    const UsdaParser usd(text);
    EXPECT_EQ(usd.stage.at("doc").text, "Tablecloth");
    EXPECT_EQ(usd.stage.at("defaultPrim").text, usd.root);
    EXPECT_EQ(usd.root, "arris");
    EXPECT_EQ(usd.stage.at("upAxis").text, "Z");
    EXPECT_EQ(usd.stage.at("metersPerUnit").number, 1.0);
    EXPECT_EQ(usd.stage.at("startTimeCode").number, 0.0);
    EXPECT_EQ(usd.stage.at("endTimeCode").number, 2.0);
    EXPECT_EQ(usd.stage.at("timeCodesPerSecond").number, 29.97);
    EXPECT_EQ(usd.stage.at("framesPerSecond").number, 29.97);
    EXPECT_EQ(usd.prim_type, "Mesh");
    EXPECT_EQ(usd.prim_name, "cloth");
    EXPECT_EQ(usd.attributes.at("subdivisionScheme").value.at(0).text, "none");
}

TEST(ExportUsd, KeepsEveryNumberOfEveryFrame)
{
    const std::vector<Frame> frames = {make_example_frame(), make_moved_frame(1), make_moved_frame(2)};
    const std::string text = export_text(frames);
    const UsdaParser usd(text);
    EXPECT_EQ(usd.attributes.at("points").type, "point3f[]");
    EXPECT_EQ(usd.attributes.at("velocities").type, "vector3f[]");
    EXPECT_EQ(times(usd.attributes.at("points")), (std::vector<double>{0.0, 1.0, 2.0}));
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const auto time = static_cast<double>(i);
        expect_same(usd.attributes.at("points").samples.at(time), frames[i].world);
        expect_same(usd.attributes.at("velocities").samples.at(time), frames[i].vertex_velocity);
    }
}

TEST(ExportUsd, WritesOnceWhatNeverChanges)
{
    const std::string text = export_text({make_moved_frame(0), make_moved_frame(1)});
    const UsdaParser usd(text);
    EXPECT_EQ(usd.attributes.at("faceVertexCounts").value.at(0).numbers(), (std::vector<double>{3, 3}));
    EXPECT_EQ(usd.attributes.at("faceVertexIndices").value.at(0).numbers(),
              (std::vector<double>{0, 1, 2, 2, 1, 3}));
    EXPECT_TRUE(usd.attributes.at("faceVertexIndices").samples.empty());
    const UsdaAttribute& st = usd.attributes.at("primvars:st");
    EXPECT_EQ(st.type, "texCoord2f[]");
    EXPECT_EQ(st.metadata.at("interpolation").text, "vertex");
    EXPECT_TRUE(st.samples.empty());
    expect_same(st.value.at(0), make_example_frame().material);
}

TEST(ExportUsd, SamplesFacesOnlyWhereTheyChange)
{
    Frame flipped = make_moved_frame(2);
    flipped.faces = {{0, 1, 3}, {0, 3, 2}};
    Frame smaller = make_moved_frame(4);
    smaller.faces.pop_back();
    for (auto* values : {&smaller.strain, &smaller.stretch_energy, &smaller.bending_energy})
        values->pop_back();
    const std::string text = export_text(
        {make_moved_frame(0), make_moved_frame(1), flipped, flipped, smaller, make_moved_frame(5)});
    const UsdaParser usd(text);
    EXPECT_THAT(times(usd.attributes.at("faceVertexIndices")), ElementsAre(0, 2, 4, 5));
    EXPECT_THAT(times(usd.attributes.at("faceVertexCounts")), ElementsAre(0, 4, 5));
    EXPECT_EQ(usd.attributes.at("faceVertexIndices").samples.at(2).numbers(),
              (std::vector<double>{0, 1, 3, 0, 3, 2}));
    EXPECT_EQ(usd.attributes.at("faceVertexCounts").samples.at(4).numbers(), (std::vector<double>{3}));
}

// A reader interpolates arrays of one length by index, also where the vertices are others.
TEST(ExportUsd, HoldsTheFrameBeforeWhereTheMeshChanges)
{
    Frame flipped = make_moved_frame(2);
    flipped.faces = {{0, 1, 3}, {0, 3, 2}};
    Frame renamed = flipped;
    renamed.ids = {0, 7, 13, 12};
    renamed.material[2] = {0.4, 0.4};
    const std::vector<Frame> frames = {make_moved_frame(0), make_moved_frame(1), flipped, renamed, renamed};
    const std::string text = export_text(frames);
    const UsdaParser usd(text);
    for (const char* name : {"points", "velocities", "extent", "primvars:st"}) {
        const auto& samples = usd.attributes.at(name).samples;
        EXPECT_THAT(times(usd.attributes.at(name)), ElementsAre(0, 1, 1.999999, 2, 2.999999, 3, 4)) << name;
        EXPECT_EQ(samples.at(1.999999).numbers(), samples.at(1).numbers()) << name;
        EXPECT_EQ(samples.at(2.999999).numbers(), samples.at(2).numbers()) << name;
    }
}

TEST(ExportUsd, WritesEolEdgesAsCreases)
{
    std::vector<Frame> frames(4, make_example_frame());
    frames[1].eol_edges.clear();
    frames[3].eol_edges = {{1, 2}, {2, 3}};
    const UsdaParser usd(export_text(frames));
    for (const char* name : {"creaseIndices", "creaseLengths", "creaseSharpnesses"})
        EXPECT_THAT(times(usd.attributes.at(name)), ElementsAre(0, 1, 2, 3)) << name;
    EXPECT_THAT(usd.attributes.at("creaseIndices").samples.at(3).numbers(), ElementsAre(1, 2, 2, 3));
    EXPECT_THAT(usd.attributes.at("creaseLengths").samples.at(3).numbers(), ElementsAre(2, 2));
    EXPECT_THAT(usd.attributes.at("creaseSharpnesses").samples.at(3).numbers(), ElementsAre(10, 10));
    EXPECT_TRUE(usd.attributes.at("creaseIndices").samples.at(1).items.empty());
    for (Frame& frame : frames) frame.eol_edges.clear();
    EXPECT_EQ(UsdaParser(export_text(frames)).attributes.count("creaseIndices"), 0U);
}

// Between two samples USD interpolates, so a late change must not leak into the frames before it.
TEST(ExportUsd, SamplesMaterialCoordinatesAtEveryFrameIfTheyChangeAtAll)
{
    std::vector<Frame> frames(4, make_example_frame());
    frames[3].material[1] = {0.2, 0.0};
    const std::string text = export_text(frames);
    const UsdaParser usd(text);
    const UsdaAttribute& st = usd.attributes.at("primvars:st");
    EXPECT_THAT(times(st), ElementsAre(0, 1, 2, 3));
    EXPECT_TRUE(st.value.empty());
    EXPECT_EQ(st.metadata.at("interpolation").text, "vertex");
    for (std::size_t i = 0; i < frames.size(); ++i)
        expect_same(st.samples.at(static_cast<double>(i)), frames[i].material);
}

TEST(ExportUsd, BoundsThePointsOfEveryFrame)
{
    Frame frame = make_example_frame();
    frame.world = {{1.0, -2.0, 3.0}, {-1.0, 5.0, 0.0}, {0.5, 0.0, 9.0}, {0.0, 0.0, 0.5}};
    const std::string text = export_text({frame, make_moved_frame(1)});
    const UsdaParser usd(text);
    const UsdaAttribute& extent = usd.attributes.at("extent");
    EXPECT_EQ(extent.type, "float3[]");
    EXPECT_EQ(extent.samples.at(0).numbers(), (std::vector<double>{-1.0, -2.0, 0.0, 1.0, 5.0, 9.0}));
    EXPECT_EQ(extent.samples.size(), 2U);
}

TEST(ExportUsd, AcceptsOneFrameNoneAndEmptyOnes)
{
    const std::string one = export_text({make_example_frame()});
    expect_same(UsdaParser(one).attributes.at("points").value.at(0), make_example_frame().world);
    EXPECT_EQ(UsdaParser(one).stage.at("endTimeCode").number, 0.0);
    const std::string none = export_text({});
    EXPECT_EQ(UsdaParser(none).stage.at("endTimeCode").number, 0.0);
    const std::string empty = export_text({Frame{}});
    EXPECT_TRUE(UsdaParser(empty).attributes.at("points").value.at(0).items.empty());
}

TEST(ExportUsd, TakesAnyTitleForText)
{
    for (const std::string title : {"\"\"\"\ndef Sphere \"x\" {}\n", "back\\slash\\\"",
                                    "tab\t and bell\x07 5", "Tischtuch über Eck, 布", ""}) {
        const std::string text = export_text({make_example_frame()}, {title, 24.0});
        EXPECT_EQ(UsdaParser(text).stage.at("doc").text, title);
        EXPECT_EQ(UsdaParser(text).prim_name, "cloth");
    }
}

TEST(ExportUsd, LeavesNothingHalfWhenAFrameIsBad)
{
    const TemporaryDirectory dir;
    const std::vector<std::string> paths = write_frames(dir, {make_example_frame(), make_moved_frame(1)});
    write_usd(dir / "cloth.usda", source_of(paths), {"good", 24.0});
    const std::string good = read_bytes(dir / "cloth.usda");
    write_bytes(paths[1], "ply\n");
    EXPECT_THROW(write_usd(dir / "cloth.usda", source_of(paths), {"bad", 24.0}), InputError);
    EXPECT_EQ(read_bytes(dir / "cloth.usda"), good);
    EXPECT_EQ(dir.entry_count(), 3U);
}

// Freed memory stays resident under the address sanitizer, in a quarantine of 256 MiB.
#if defined(__SANITIZE_ADDRESS__)
constexpr long kMostKibibytes = 512 * 1024;
#else
constexpr long kMostKibibytes = 16 * 1024;
#endif

TEST(ExportUsd, HoldsNoMoreThanAFewFrames)
{
    constexpr std::size_t kVertices = 5000;
    const TemporaryDirectory dir;
    Frame frame;
    frame.world.assign(kVertices, Vec3(1.0 / 3.0, 2.0 / 3.0, 1.0 / 7.0));
    frame.vertex_velocity = frame.material_velocity = frame.world;
    frame.material.assign(kVertices, Vec2(0.1, 0.2));
    frame.ids.resize(kVertices);
    frame.eol.resize(kVertices);
    frame.contact.resize(kVertices);
    write_frame(dir / "a.ply", frame);
    const std::vector<std::string> paths(100, dir / "a.ply");

    rusage before = {}, after = {};
    getrusage(RUSAGE_SELF, &before);
    write_usd(dir / "cloth.usda", source_of(paths), {"long", 24.0});
    getrusage(RUSAGE_SELF, &after);
    EXPECT_GT(std::filesystem::file_size(dir / "cloth.usda"), 50U << 20);
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, kMostKibibytes);
}

TEST(ExportUsd, PlacesObstaclesByATransformThatIsSampledWhereTheyMove)
{
    ObstacleRecord table{"table", make_box({1.0, 2.0, 0.5}), {}, {}};
    table.placement = {rotation_about(Vec3::UnitZ(), 90.0), {0.0, 0.0, 3.0}};
    ObstacleRecord rope{
        "rope", make_wire({{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}}, false), {}, {}};
    rope.motion.velocity = {24.0, 0.0, 0.0};
    ObstacleRecord nails{"nails", make_points({{0.0, 0.0, 0.0}, {0.0, 0.0, 7.0}}), {}, {}};

    const TemporaryDirectory dir;
    const auto frames = write_frames(dir, {make_moved_frame(0), make_moved_frame(1), make_moved_frame(2)});
    write_usd(dir / "cloth.usda", source_of(frames), {"A title", 24.0}, {table, rope, nails});
    const UsdaParser usd(read_bytes(dir / "cloth.usda"));
    EXPECT_EQ(usd.prim_name, "cloth");
    ASSERT_EQ(usd.others.size(), 1U);
    EXPECT_EQ(usd.others[0].name, "obstacles");
    const std::vector<UsdaPrim>& obstacles = usd.others[0].children;
    ASSERT_EQ(obstacles.size(), 3U);

    const UsdaPrim& first = obstacles[0];
    EXPECT_EQ(first.type + " " + first.name, "Xform table");
    EXPECT_EQ(first.attributes.at("xformOpOrder").value.at(0).items.at(0).text, "xformOp:transform");
    const UsdaAttribute& placement = first.attributes.at("xformOp:transform");
    EXPECT_EQ(placement.type, "matrix4d");
    EXPECT_TRUE(placement.samples.empty());
    // Rows are the images of the axes (x to y, y to -x), then the translation.
    EXPECT_EQ(placement.value.at(0).numbers(),
              (std::vector<double>{0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 3, 1}));
    ASSERT_EQ(first.children.size(), 1U);
    const UsdaPrim& surface = first.children[0];
    EXPECT_EQ(surface.type, "Mesh");
    EXPECT_EQ(surface.attributes.at("faceVertexCounts").value.at(0).numbers(), std::vector<double>(12, 3.0));
    EXPECT_EQ(surface.attributes.at("faceVertexIndices").value.at(0).numbers().size(), 36U);
    expect_same(surface.attributes.at("points").value.at(0), table.mesh.points);
    EXPECT_EQ(surface.attributes.at("extent").value.at(0).numbers(),
              (std::vector<double>{-0.5, -1, -0.25, 0.5, 1, 0.25}));

    const UsdaPrim& second = obstacles[1];
    const UsdaAttribute& moving = second.attributes.at("xformOp:transform");
    EXPECT_THAT(times(moving), ElementsAre(0, 1, 2));
    EXPECT_EQ(moving.samples.at(2).numbers().at(12), 2.0);
    ASSERT_EQ(second.children.size(), 1U);
    EXPECT_EQ(second.children[0].type, "BasisCurves");
    EXPECT_EQ(second.children[0].attributes.at("curveVertexCounts").value.at(0).numbers(),
              (std::vector<double>{2, 2}));
    EXPECT_EQ(second.children[0].attributes.at("points").value.at(0).numbers(),
              (std::vector<double>{0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 1, 0}));
    EXPECT_EQ(second.children[0].attributes.at("type").value.at(0).text, "linear");

    const UsdaPrim& third = obstacles[2];
    ASSERT_EQ(third.children.size(), 1U);
    EXPECT_EQ(third.children[0].type, "Points");
    EXPECT_EQ(third.children[0].attributes.at("points").value.at(0).numbers(),
              (std::vector<double>{0, 0, 0, 0, 0, 7}));
    EXPECT_EQ(third.children[0].attributes.at("widths").metadata.at("interpolation").text, "constant");
    for (const UsdaPrim& obstacle : obstacles)
        EXPECT_FALSE(obstacle.children[0].attributes.contains("velocities")) << obstacle.name;
}

TEST(ExportUsd, ADeformingObstacleMovesAnObstacleAgain)
{
    ObstacleRecord body = make_stretching("body", make_box({1.0, 2.0, 0.5}));
    body.placement.translation = {0.0, 0.0, 3.0};
    const TemporaryDirectory dir;
    const auto frames = write_frames(dir, {make_moved_frame(0), make_moved_frame(1), make_moved_frame(2)});
    write_usd(dir / "cloth.usda", source_of(frames), {"A title", 2.0}, {body});

    VertexCacheRequest request;
    request.path = dir / "cloth.usda";
    request.vertex_count = 8;
    EXPECT_THAT(error_of([&] { open_vertex_cache(request); }),
                HasSubstr("allowed: /arris/cloth, /arris/obstacles/body/surface"));
    request.prim = "/arris/obstacles/body/surface";
    const auto cache = open_vertex_cache(request);
    EXPECT_THAT(cache->times(), ElementsAre(0.0, 0.5, 1.0));
    EXPECT_EQ(cache->declared().up, 'z');
    std::vector<Vec3> vertices, points, velocities;
    for (std::size_t k = 0; k < 3; ++k) {
        cache->read(k, vertices);
        body.deformation->find(cache->times()[k], points, velocities);
        for (std::size_t v = 0; v < 8; ++v)
            EXPECT_LT((vertices.at(v) - points[v] - Vec3(0, 0, 3)).norm(), 1e-6);
    }
}

TEST(ExportUsd, SamplesPointsAndVelocitiesOfObstaclesThatDeform)
{
    ObstacleRecord body = make_stretching("body", make_box({1.0, 2.0, 0.5}));
    body.placement.translation = {0.0, 0.0, 3.0};
    ObstacleRecord rope =
        make_stretching("rope", make_wire({{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {2.0, 1.0, 0.0}}, false));
    ObstacleRecord nails = make_stretching("nails", make_points({{1.0, 0.0, 0.0}, {2.0, 0.0, 7.0}}));

    const TemporaryDirectory dir;
    const auto frames = write_frames(dir, {make_moved_frame(0), make_moved_frame(1), make_moved_frame(2)});
    write_usd(dir / "cloth.usda", source_of(frames), {"A title", 2.0}, {body, rope, nails});
    const UsdaParser usd(read_bytes(dir / "cloth.usda"));
    const std::vector<UsdaPrim>& obstacles = usd.others.at(0).children;
    ASSERT_EQ(obstacles.size(), 3U);
    EXPECT_TRUE(obstacles[0].attributes.at("xformOp:transform").samples.empty());

    const UsdaPrim& surface = obstacles[0].children.at(0);
    for (const char* name : {"points", "velocities", "extent"})
        EXPECT_THAT(times(surface.attributes.at(name)), ElementsAre(0, 1, 2)) << name;
    std::vector<Vec3> points, velocities;
    body.deformation->find(1.0, points, velocities);  // time code 2 at two frames a second
    expect_same(surface.attributes.at("points").samples.at(2), points);
    expect_same(surface.attributes.at("velocities").samples.at(2), velocities);
    EXPECT_EQ(surface.attributes.at("extent").samples.at(2).numbers(),
              (std::vector<double>{-1, -1, -0.25, 1, 1, 0.25}));
    EXPECT_TRUE(surface.attributes.at("faceVertexIndices").samples.empty());

    const UsdaPrim& wires = obstacles[1].children.at(0);
    EXPECT_EQ(wires.attributes.at("points").samples.at(1).numbers(),
              (std::vector<double>{0, 0, 0, 1.5, 0, 0, 1.5, 0, 0, 3, 1, 0}));
    EXPECT_EQ(wires.attributes.at("velocities").samples.at(1).numbers(),
              (std::vector<double>{0, 0, 0, 1, 0, 0, 1, 0, 0, 2, 0, 0}));
    EXPECT_EQ(obstacles[2].children.at(0).attributes.at("points").samples.at(2).numbers(),
              (std::vector<double>{2, 0, 0, 4, 0, 7}));

    write_usd(dir / "one.usda", source_of({frames[0]}), {"A title", 2.0}, {body});
    const UsdaParser one(read_bytes(dir / "one.usda"));
    const UsdaAttribute& still = one.others.at(0).children.at(0).children.at(0).attributes.at("points");
    EXPECT_TRUE(still.samples.empty());
    expect_same(still.value.at(0), body.mesh.points);
}

}  // namespace
}  // namespace arris
