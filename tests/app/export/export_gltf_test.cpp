// SPDX-License-Identifier: GPL-3.0-or-later
//
// scripts/test_formats validates a file and reads it with three.js.
#include "app/export/export_gltf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "geometry/obstacle_input/obstacle_shapes.h"
#include "tests/app/error_of.h"
#include "tests/app/stretching_obstacle.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A right triangle whose last corner rises by 1 m a frame.
FrameSource make_rising(std::size_t count)
{
    return {count, [](std::size_t i) {
                Frame frame;
                frame.world = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, static_cast<double>(i)}};
                frame.material = {{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}};
                frame.faces = {{0, 1, 2}};
                return frame;
            }};
}

std::uint32_t number_at(const std::string& bytes, std::size_t at)
{
    std::uint32_t number = 0;
    std::memcpy(&number, bytes.data() + at, sizeof number);
    return number;
}

nlohmann::json json_of(const std::string& bytes)
{
    return nlohmann::json::parse(bytes.substr(20, number_at(bytes, 12)));
}

TEST(ExportGltf, TargetsAreDifferencesFromTheFirstFrame)
{
    const TemporaryDirectory dir;
    write_gltf(dir / "a.glb", make_rising(3), {"T", 2.0});
    const std::string bytes = read_bytes(dir / "a.glb");
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(number_at(bytes, 8), bytes.size());
    const nlohmann::json json = json_of(bytes);
    const nlohmann::json& targets = json["meshes"][0]["primitives"][0]["targets"];
    ASSERT_EQ(targets.size(), 2U);
    const auto accessor = [&](const nlohmann::json& shape) {
        return json["accessors"][shape["POSITION"].get<int>()];
    };
    EXPECT_EQ(accessor(targets[1])["max"], nlohmann::json({0.0, 0.0, 2.0}));
    EXPECT_EQ(accessor(json["meshes"][0]["primitives"][0]["attributes"])["max"],
              nlohmann::json({1.0, 1.0, 0.0}));
    const nlohmann::json& samplers = json["animations"][0]["samplers"];
    EXPECT_EQ(json["accessors"][samplers[0]["input"].get<int>()]["max"], nlohmann::json({1.0}));
    // Three frames by two weights: 0 0, 1 0, 0 1.
    const nlohmann::json& weights = json["accessors"][samplers[0]["output"].get<int>()];
    EXPECT_EQ(weights["count"], 6);
    const nlohmann::json& view = json["bufferViews"][weights["sparse"]["indices"]["bufferView"].get<int>()];
    const std::size_t arrays = 20 + number_at(bytes, 12) + 8;
    const std::size_t places = arrays + view["byteOffset"].get<std::size_t>();
    EXPECT_EQ(number_at(bytes, places), 2U);
    EXPECT_EQ(number_at(bytes, places + 4), 5U);
}

TEST(ExportGltf, NormalsOfTargetsAreDifferencesOfUnitNormals)
{
    const TemporaryDirectory dir;
    write_gltf(dir / "a.glb", make_rising(3), {"", 24.0});
    const std::string bytes = read_bytes(dir / "a.glb");
    const nlohmann::json json = json_of(bytes);
    const int index = json["meshes"][0]["primitives"][0]["targets"][1]["NORMAL"];
    const nlohmann::json& accessor = json["accessors"][index];
    const nlohmann::json& view = json["bufferViews"][accessor["bufferView"].get<int>()];
    const std::size_t at = 20 + number_at(bytes, 12) + 8 + view["byteOffset"].get<std::size_t>() +
                           accessor["byteOffset"].get<std::size_t>();
    std::array<float, 3> normal;
    std::memcpy(normal.data(), bytes.data() + at, sizeof normal);
    // (1, 0, 0) x (0, 1, 2) = (0, -2, 1); the first frame's normal is (0, 0, 1).
    EXPECT_FLOAT_EQ(normal[0], 0.0F);
    EXPECT_FLOAT_EQ(normal[1], static_cast<float>(-2.0 / std::sqrt(5.0)));
    EXPECT_FLOAT_EQ(normal[2], static_cast<float>(1.0 / std::sqrt(5.0) - 1.0));
}

TEST(ExportGltf, OneFrameHasNoAnimation)
{
    const TemporaryDirectory dir;
    ObstacleRecord moving{"moving", {}, {}, {}};
    moving.mesh.points = {{0.0, 0.0, 0.0}};
    moving.mesh.lone_points = {0};
    moving.motion.velocity = {1.0, 0.0, 0.0};
    write_gltf(dir / "a.glb", make_rising(1), {"", 24.0}, {moving});
    const nlohmann::json json = json_of(read_bytes(dir / "a.glb"));
    EXPECT_FALSE(json.contains("animations"));
    EXPECT_FALSE(json["meshes"][0]["primitives"][0].contains("targets"));
    EXPECT_EQ(json["meshes"][1]["primitives"][0]["mode"], 0);
}

TEST(ExportGltf, ObstaclesMoveOnlyIfTheyDoInTheRun)
{
    const TemporaryDirectory dir;
    ObstacleRecord still{"still", {}, {}, {}}, moving{"moving", {}, {}, {}};
    moving.motion.velocity = {1.0, 0.0, 0.0};
    write_gltf(dir / "a.glb", make_rising(3), {"", 24.0}, {still, moving});
    const nlohmann::json json = json_of(read_bytes(dir / "a.glb"));
    std::vector<std::string> moved;
    for (const nlohmann::json& channel : json["animations"][0]["channels"])
        moved.push_back(json["nodes"][channel["target"]["node"].get<int>()]["name"].get<std::string>() + " " +
                        channel["target"]["path"].get<std::string>());
    EXPECT_THAT(moved, ::testing::ElementsAre("cloth weights", "moving translation", "moving rotation"));
}

TEST(ExportGltf, AnObstacleThatDeformsHasTargetsBehindTheCloths)
{
    const TemporaryDirectory dir;
    ObstacleRecord body = make_stretching("body", make_box({1.0, 2.0, 0.5}));
    body.mesh.segments = {{0, 7}};
    write_gltf(dir / "a.glb", make_rising(3), {"", 2.0}, {body});
    const std::string bytes = read_bytes(dir / "a.glb");
    const nlohmann::json json = json_of(bytes);
    std::vector<std::string> moved;
    for (const nlohmann::json& channel : json["animations"][0]["channels"])
        moved.push_back(json["nodes"][channel["target"]["node"].get<int>()]["name"].get<std::string>() + " " +
                        channel["target"]["path"].get<std::string>());
    EXPECT_THAT(moved, ::testing::ElementsAre("cloth weights", "body weights"));
    EXPECT_EQ(json["meshes"][1]["weights"].size(), 2U);
    const nlohmann::json& primitives = json["meshes"][1]["primitives"];
    ASSERT_EQ(primitives.size(), 2U);
    EXPECT_EQ(primitives[0]["targets"], primitives[1]["targets"]);
    ASSERT_EQ(primitives[0]["targets"].size(), 2U);

    // Frames 1 and 2 are at 0.5 and 1 s.
    for (const std::size_t frame : {1U, 2U}) {
        const nlohmann::json& accessor =
            json["accessors"][primitives[0]["targets"][frame - 1]["POSITION"].get<int>()];
        ASSERT_EQ(accessor["count"], 8);
        const nlohmann::json& view = json["bufferViews"][accessor["bufferView"].get<int>()];
        const std::size_t at = 20 + number_at(bytes, 12) + 8 + view["byteOffset"].get<std::size_t>() +
                               accessor["byteOffset"].get<std::size_t>();
        ASSERT_LE(at + 8 * sizeof(std::array<float, 3>), bytes.size());
        for (std::size_t p = 0; p < 8; ++p) {
            std::array<float, 3> way;
            std::memcpy(way.data(), bytes.data() + at + p * sizeof way, sizeof way);
            const double x = 0.5 * static_cast<double>(frame) * body.mesh.points[p].x();
            EXPECT_EQ(way, (std::array<float, 3>{static_cast<float>(x), 0.0F, 0.0F})) << frame << " " << p;
        }
    }
    EXPECT_EQ(json["bufferViews"][json["accessors"][0]["bufferView"].get<int>()]["buffer"], 0);
    EXPECT_EQ(json["buffers"][0]["byteLength"].get<std::size_t>() + 20 + number_at(bytes, 12) + 8,
              bytes.size());
}

TEST(ExportGltf, RefusesAnotherMeshAndTooManyFrames)
{
    const TemporaryDirectory dir;
    FrameSource turned = make_rising(2);
    turned.read = [read = turned.read](std::size_t i) {
        Frame frame = read(i);
        if (i == 1) frame.faces = {{1, 2, 0}};
        return frame;
    };
    EXPECT_THAT(error_of([&] {
                    write_gltf(dir / "a.glb", turned, {"", 24.0});
                }),
                AllOf(HasSubstr("a.glb: frame 1"), HasSubstr("one mesh")));
    EXPECT_THAT(error_of([&] {
                    write_gltf(dir / "a.glb", make_rising(100000), {"", 24.0});
                }),
                AllOf(HasSubstr("100000 frames"), HasSubstr("4294967295")));
    EXPECT_EQ(dir.entry_count(), 0U);
}

}  // namespace
}  // namespace arris
