// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/export/export_frames.h"
#include "app/run/run_export_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "app/files/frame_files.h"
#include "app/files/pose_file.h"
#include "app/report/report.h"
#include "geometry/input_error.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "tests/app/error_of.h"
#include "tests/app/example_frame.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A cloth that a viewer can show: the example's greatest doubles have no finite bounding box.
Frame make_tame_frame(int i)
{
    Frame frame = make_moved_frame(i);
    frame.world[2] = {0.0, 1.0, 0.0};
    frame.vertex_velocity[3] = {0.0, 0.0, 1.0};
    return frame;
}

void write_run(const TemporaryDirectory& dir, int frame_count, const char* scene)
{
    std::filesystem::create_directories(frames_directory(dir.path()));
    for (int i = 0; i < frame_count; ++i) write_frame(frame_file(dir.path(), i, "ply"), make_tame_frame(i));
    RunReport report;
    report.scene = nlohmann::ordered_json::parse(scene);
    write_report_json(dir / "report.json", report);
}

constexpr const char* kScene = R"({"title": "T \"q\" </script>", "output": {"frames_per_second": 12.5}})";

TEST(ExportFrames, MakesEveryFormatFromTheRunsReport)
{
    const TemporaryDirectory dir;
    write_run(dir, 3, kScene);
    const ExportOptions options = read_export_options(dir.path());
    EXPECT_EQ(options.title, "T \"q\" </script>");
    EXPECT_EQ(options.frames_per_second, 12.5);
    export_frames(dir.path(), {"obj", "usd", "viewer", "vtk"}, options);
    for (const char* file : {"frames/cloth_00000.obj", "frames/cloth_00002.obj", "cloth.usda", "viewer.html",
                             "frames/cloth_00002.vtp", "cloth.pvd"})
        EXPECT_TRUE(std::filesystem::exists(dir / file)) << file;
    EXPECT_THAT(read_bytes(dir / "cloth.usda"), HasSubstr("timeCodesPerSecond = 12.5\n"));
    EXPECT_EQ(dir.entry_count(), 1U + 3U + 3U + 3U + 3U + 1U);
}

TEST(ExportFrames, MovesThePointsOfAnObstacleThatDeforms)
{
    const TemporaryDirectory dir;
    write_run(dir, 3, kScene);
    ObstacleRecord body{"body", make_box({1.0, 2.0, 0.5}), {}, {}};
    body.placement.translation = {0.0, 0.0, 3.0};
    // Twice as long at frame 2.
    PoseFileWriter writer({{0.0, 2.0 / 12.5}, body.mesh.points.size(), false, PoseInterpolation::Linear});
    std::vector<Vec3> points = body.mesh.points;
    writer.add(points);
    for (Vec3& point : points) point.x() *= 2.0;
    writer.add(points);
    body.deformation = std::make_shared<PointCache>(writer.finish(), PoseInterpolation::Linear);
    write_obstacles(dir.path(), {body});

    ExportOptions options = read_export_options(dir.path());
    export_frames(dir.path(), {"obj", "vtk", "usd", "gltf", "viewer"}, options);
    const auto first_point = [&](int frame) {
        const std::string text = read_bytes(frame_file(dir.path(), frame, "obj", "body"));
        const std::size_t at = text.find("\nv ") + 3;
        std::istringstream in(text.substr(at, text.find('\n', at) - at));
        Vec3 point;
        in >> point[0] >> point[1] >> point[2];
        return point;
    };
    for (int frame = 0; frame < 3; ++frame) {
        const Vec3& rest = body.mesh.points[0];
        const Vec3 expected(rest.x() * (1.0 + 0.5 * frame), rest.y(), rest.z() + 3.0);
        EXPECT_NEAR((first_point(frame) - expected).norm(), 0.0, 1e-15) << frame;
    }
    EXPECT_NE(read_bytes(frame_file(dir.path(), 2, "vtp", "body")),
              read_bytes(frame_file(dir.path(), 1, "vtp", "body")));
    options.up = UpAxis::Y;
    options.is_overwriting = true;
    export_frames(dir.path(), {"obj"}, options);
    EXPECT_NEAR((first_point(2) - turn_to(UpAxis::Y)(body.world_points(2.0 / 12.5)[0])).norm(), 0.0, 1e-15);
}

TEST(ExportFrames, RefusesUnknownFormatsBeforeItWritesAny)
{
    const TemporaryDirectory dir;
    write_run(dir, 1, kScene);
    const auto error_with = [&](const char* format) {
        return error_of([&] { export_frames(dir.path(), {"obj", format}, {}); });
    };
    EXPECT_THAT(error_with("fbx"),
                AllOf(HasSubstr("\"fbx\""), HasSubstr("obj, usd, viewer, vtk, pc2, mdd, gltf")));
    EXPECT_THAT(error_with(""), HasSubstr("\"\""));
    EXPECT_FALSE(std::filesystem::exists(dir / "frames/cloth_00000.obj"));
    require_known_formats({"viewer", "usd", "obj", "obj"});
    require_known_formats({});
}

TEST(ExportFrames, ConstantTopologyIsOfEveryFormatButTheViewer)
{
    const TemporaryDirectory dir;
    write_run(dir, 2, kScene);
    ExportOptions options = read_export_options(dir.path());
    export_frames(dir.path(), {"pc2", "mdd", "gltf"}, options);
    for (const char* file : {"cloth.pc2", "cloth.mdd", "cloth_base.obj", "cloth.glb"})
        EXPECT_TRUE(std::filesystem::exists(dir / file)) << file;
    export_frames(dir.path(), {"obj"}, options);
    EXPECT_THAT(read_bytes(dir / "frames/cloth_00001.obj"), HasSubstr("\nl "));
    options.is_topology_constant = true;
    options.is_overwriting = true;
    export_frames(dir.path(), {"obj"}, options);
    EXPECT_THAT(read_bytes(dir / "frames/cloth_00001.obj"), Not(HasSubstr("\nl ")));
    EXPECT_THAT(error_of([&] { export_frames(dir.path(), {"viewer"}, options); }), HasSubstr("\"viewer\""));
}

TEST(ExportFrames, ReplacesFilesOfAnotherMeshOrAxisOnlyOnRequest)
{
    const TemporaryDirectory dir;
    write_run(dir, 2, kScene);
    const ExportOptions plain = read_export_options(dir.path());
    export_frames(dir.path(), {"obj", "mdd"}, plain);
    export_frames(dir.path(), {"obj", "mdd"}, plain);  // makes the same files again
    const std::string obj = read_bytes(dir / "frames/cloth_00001.obj");

    ExportOptions constant = plain, turned = plain;
    constant.is_topology_constant = true;
    turned.up = UpAxis::Y;
    const auto error_with = [&](const std::vector<std::string>& formats, const ExportOptions& options) {
        return error_of([&] { export_frames(dir.path(), formats, options); });
    };
    EXPECT_THAT(error_with({"usd", "obj"}, constant),
                HasSubstr(": holds frames/cloth_00000.obj, which \"obj\" with --topology constant would "
                          "replace; allowed: --overwrite, or another format"));
    EXPECT_FALSE(std::filesystem::exists(dir / "cloth.usda")) << "nothing is written";
    EXPECT_THAT(error_with({"mdd"}, turned), HasSubstr("holds cloth.mdd, which \"mdd\" with --up y"));
    EXPECT_THAT(error_with({"pc2"}, turned), HasSubstr("holds cloth_base.obj, which \"pc2\" with --up y"));
    ExportOptions grid = plain;
    grid.grid = GridSize{2, 3};
    EXPECT_THAT(error_with({"mdd"}, grid), HasSubstr("holds cloth.mdd, which \"mdd\" with --grid 2x3"));
    EXPECT_EQ(read_bytes(dir / "frames/cloth_00001.obj"), obj);

    EXPECT_EQ(error_with({"usd"}, constant), "") << "no such file is there";
    constant.is_overwriting = true;
    EXPECT_EQ(error_with({"usd", "obj"}, constant), "");
    EXPECT_NE(read_bytes(dir / "frames/cloth_00001.obj"), obj);
}

TEST(ExportFrames, RefusesAGridThatNoFormatUses)
{
    const TemporaryDirectory dir;
    write_run(dir, 2, kScene);
    ExportOptions options = read_export_options(dir.path());
    options.grid = GridSize{2, 2};
    EXPECT_THAT(error_of([&] { export_frames(dir.path(), {"obj"}, options); }),
                HasSubstr("no format uses it"));
    EXPECT_THAT(error_of([&] { export_frames(dir.path(), {"pc2"}, options); }), HasSubstr("rectangle"));
}

/// Positions in an OBJ file, in order.
std::vector<Vec3> obj_points(const std::string& path)
{
    std::istringstream text(read_bytes(path));
    std::vector<Vec3> points;
    for (std::string word; text >> word;) {
        if (word != "v") continue;
        Vec3& x = points.emplace_back();
        text >> x[0] >> x[1] >> x[2];
    }
    return points;
}

TEST(ExportFrames, TurnsClothAndObstaclesForProgramsWithYUp)
{
    const TemporaryDirectory dir;
    write_run(dir, 2, kScene);
    ObstacleRecord box{"box", make_box({1.0, 2.0, 3.0}), {}, {}};
    box.placement.translation = {0.1, 0.2, 0.3};
    write_obstacles(dir.path(), {box});
    ExportOptions options = read_export_options(dir.path());
    const std::vector<std::string> formats = {"obj", "vtk", "pc2", "mdd"};
    const auto read_all = [&] {
        std::map<std::string, std::vector<Vec3>> points;
        for (const char* name : {"frames/cloth_00001.obj", "frames/box_00000.obj", "cloth_base.obj"})
            points[name] = obj_points(dir / name);
        return points;
    };
    export_frames(dir.path(), formats, options);
    const auto upright = read_all();
    const std::string vtp = read_bytes(dir / "frames/box_00000.vtp"), pc2 = read_bytes(dir / "cloth.pc2");
    options.up = UpAxis::Y;
    options.is_overwriting = true;
    export_frames(dir.path(), formats, options);
    for (const auto& [name, lying] : read_all()) {
        ASSERT_EQ(lying.size(), upright.at(name).size());
        for (std::size_t v = 0; v < lying.size(); ++v) {
            const Vec3& x = upright.at(name)[v];
            EXPECT_EQ(lying[v], Vec3(x[0], x[2], -x[1])) << name;
        }
    }
    EXPECT_NE(read_bytes(dir / "frames/box_00000.vtp"), vtp);
    EXPECT_NE(read_bytes(dir / "cloth.pc2"), pc2);
    EXPECT_THAT(read_bytes(dir / "frames/box_00000.obj"), HasSubstr("# Arris: m, y is up"));
    for (const char* format : {"usd", "gltf", "viewer"})
        EXPECT_THAT(error_of([&] {
                        export_frames(dir.path(), {"obj", format}, options);
                    }),
                    AllOf(HasSubstr("--up y"), HasSubstr(format), HasSubstr("obj, vtk, pc2, mdd")));
}

TEST(ExportFrames, TurnsVelocitiesWithTheCloth)
{
    Frame frame = make_tame_frame(0);
    frame.vertex_velocity[0] = {1.0, 2.0, 3.0};
    frame.material_velocity[0] = {4.0, 5.0, 6.0};
    const FrameSource source{1, [&](std::size_t) { return frame; }};
    const Frame lying = turned(source, UpAxis::Y).read(0);
    EXPECT_EQ(lying.vertex_velocity[0], Vec3(1.0, 3.0, -2.0));
    EXPECT_EQ(lying.material_velocity[0], Vec3(4.0, 6.0, -5.0));
    EXPECT_EQ(turned(source, UpAxis::Z).read(0).vertex_velocity[0], frame.vertex_velocity[0]);
}

TEST(ExportFrames, SaysWhatIsMissing)
{
    const TemporaryDirectory dir;
    EXPECT_THAT(error_of([&] { read_export_options(dir.path()); }), HasSubstr("holds no run"));
    EXPECT_THAT(error_of([&] { export_frames(dir.path(), {"obj"}, {}); }), HasSubstr("no frames"));
    write_run(dir, 3, kScene);
    std::filesystem::remove(frame_file(dir.path(), 1, "ply"));
    EXPECT_THAT(error_of([&] { export_frames(dir.path(), {"obj"}, {}); }),
                HasSubstr("cloth_00001.ply: is missing"));
}

TEST(ExportFrames, RefusesReportsThatAreNone)
{
    const TemporaryDirectory dir;
    const auto error_in = [&](const std::string& report) {
        write_bytes(dir / "report.json", report);
        return error_of([&] { read_export_options(dir.path()); });
    };
    for (const char* report : {"", "{", "[]", "3", "{}", R"({"scene": 3})", "\xff\xfe"})
        EXPECT_THAT(error_in(report), HasSubstr("report.json: is not the report of a run")) << report;
    EXPECT_THAT(error_in(R"({"scene": {}})"), HasSubstr("frames_per_second"));
    EXPECT_THAT(error_in(R"({"scene": {"output": 3}})"), HasSubstr("frames_per_second"));
    EXPECT_THAT(error_in(R"({"scene": {"output": {"frames_per_second": "24"}}})"), HasSubstr("not a number"));
    EXPECT_THAT(error_in(R"({"scene": {"output": {"frames_per_second": 0}}})"), HasSubstr("wrote no frames"));
    EXPECT_THAT(error_in(R"({"scene": {"output": {"frames_per_second": -1}}})"), HasSubstr("is -1"));
    EXPECT_EQ(error_in(R"({"scene": {"title": 7, "output": {"frames_per_second": 24}}})"), "");
}

}  // namespace
}  // namespace arris
