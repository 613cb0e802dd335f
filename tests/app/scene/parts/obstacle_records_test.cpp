// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/obstacle_records.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "app/files/binary_stream.h"
#include "app/files/pose_file.h"
#include "geometry/input_error.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "tests/app/error_of.h"
#include "tests/app/stretching_obstacle.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

using ::testing::HasSubstr;

std::vector<ObstacleRecord> make_records()
{
    ObstacleRecord table{"table", make_box({1.0, 2.0, 0.5}), {}, {}};
    table.placement = {rotation_about({1.0, 2.0, 3.0}, 40.0), {0.1, -0.0, 1e-310}};
    table.motion.velocity = {1.0, 0.0, 0.0};
    table.motion.angular_velocity = {0.0, 0.3, 0.0};
    table.motion.pivot = {0.0, 0.0, 2.0};
    table.motion.start = 0.25;
    ObstacleRecord wire{"wire", make_wire({{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}}, true), {}, {}};
    wire.motion.keyframes = {{0.0, Vec3::Zero(), Eigen::Quaterniond::Identity()},
                             {1.0, Vec3::UnitX(), Eigen::Quaterniond(rotation_about(Vec3::UnitZ(), 90.0))}};
    return {table, wire, {"nails", make_points({{0.1, 0.2, 0.3}, {1.0, 0.0, 0.0}}), {}, {}}};
}

std::string refusal(const TemporaryDirectory& dir)
{
    return error_of([&] { read_obstacles(dir.path()); });
}

TEST(ObstacleRecords, ReadBackToTheSameBytes)
{
    const TemporaryDirectory dir;
    const std::vector<ObstacleRecord> records = make_records();
    write_obstacles(dir.path(), records);
    const std::string bytes = read_bytes(obstacles_file(dir.path()));
    const std::vector<ObstacleRecord> read = read_obstacles(dir.path());
    ASSERT_EQ(read.size(), 3U);
    EXPECT_EQ(read[0].mesh.faces, records[0].mesh.faces);
    EXPECT_EQ(read[1].mesh.segments, records[1].mesh.segments);
    EXPECT_EQ(read[2].mesh.lone_points, records[2].mesh.lone_points);
    for (std::size_t i = 0; i < 3; ++i)
        for (const double time : {0.0, 0.5, 7.0}) {
            EXPECT_EQ(read[i].at(time).rotation, records[i].at(time).rotation);
            EXPECT_EQ(read[i].at(time).translation, records[i].at(time).translation);
        }
    write_obstacles(dir.path(), read);
    EXPECT_TRUE(read_bytes(obstacles_file(dir.path())) == bytes);
}

TEST(ObstacleRecords, ARunWithoutThemHasNone)
{
    const TemporaryDirectory dir;
    EXPECT_TRUE(read_obstacles(dir.path()).empty());
    write_obstacles(dir.path(), {});
    EXPECT_TRUE(read_obstacles(dir.path()).empty());
}

TEST(ObstacleRecords, EveryTruncationAndEveryFlippedByteIsOneInputError)
{
    const TemporaryDirectory dir;
    const std::string path = obstacles_file(dir.path());
    write_obstacles(dir.path(), make_records());
    const std::string whole = read_bytes(path);
    for (std::size_t length = 0; length < whole.size(); length += 1 + length / 40) {
        write_bytes(path, whole.substr(0, length));
        EXPECT_THAT(refusal(dir), HasSubstr(path)) << length;
    }
    for (std::size_t k = 0; k < whole.size(); k += 1 + k / 40) {
        std::string damaged = whole;
        damaged[k] = static_cast<char>(damaged[k] ^ 0x81);
        write_bytes(path, damaged);
        EXPECT_THAT(refusal(dir), HasSubstr(path)) << k;
    }
    write_bytes(path, whole + "x");
    EXPECT_NE(refusal(dir), "");
}

TEST(ObstacleRecords, WhatNoObstacleCanBeIsRefused)
{
    const TemporaryDirectory dir;
    const auto refused = [&](const char* what, const auto& damage) {
        std::vector<ObstacleRecord> records = make_records();
        damage(records);
        write_obstacles(dir.path(), records);
        EXPECT_THAT(refusal(dir), HasSubstr("damaged")) << what;
    };
    using Records = std::vector<ObstacleRecord>;
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    refused("index", [](Records& r) { r[0].mesh.faces[3][1] = 8; });
    refused("negative index", [](Records& r) { r[0].mesh.faces[3][1] = -1; });
    refused("segment", [](Records& r) { r[1].mesh.segments[0][1] = 3; });
    refused("lone point", [](Records& r) { r[2].mesh.lone_points[0] = 99; });
    refused("point", [&](Records& r) { r[2].mesh.points[0].x() = kNan; });
    refused("flat face", [](Records& r) { r[0].mesh.faces[0][1] = r[0].mesh.faces[0][0]; });
    refused("placement", [&](Records& r) { r[0].placement.translation.x() = kNan; });
    refused("velocity", [&](Records& r) { r[0].motion.velocity.x() = INFINITY; });
    refused("times", [](Records& r) { r[0].motion.stop = -1.0; });
    refused("keyframes", [](Records& r) { std::swap(r[1].motion.keyframes[0], r[1].motion.keyframes[1]); });
    refused("rotation", [](Records& r) { r[1].motion.keyframes[1].rotate.coeffs().setZero(); });
    refused("path as a name", [](Records& r) { r[1].name = "../x"; });
    refused("the cloth's name", [](Records& r) { r[1].name = "cloth"; });
    refused("one name twice", [](Records& r) { r[1].name = "table"; });
}

TEST(ObstacleRecords, OneThatNeverMovesHasOneFrame)
{
    const std::vector<ObstacleRecord> records = make_records();
    EXPECT_EQ(count_obstacle_frames(records[0], 24), 24U);
    EXPECT_EQ(count_obstacle_frames(records[1], 24), 24U);
    EXPECT_EQ(count_obstacle_frames(records[2], 24), 1U);
    EXPECT_EQ(count_obstacle_frames(records[2], 0), 0U);
}

/// A box that grows from 1 to 3 m within a second, in an obstacle's frame.
ObstacleRecord growing_box()
{
    ObstacleRecord record{"body", make_box({1.0, 1.0, 1.0}), {}, {}};
    PoseFileWriter writer({{0.0, 1.0}, record.mesh.points.size(), true, PoseInterpolation::Linear});
    writer.add(record.mesh.points);
    std::vector<Vec3> grown = record.mesh.points;
    for (Vec3& point : grown) point *= 3.0;
    writer.add(grown);
    record.deformation = std::make_shared<PointCache>(writer.finish(), PoseInterpolation::Linear);
    record.placement = {rotation_about(Vec3::UnitZ(), 90.0), {0.0, 0.0, 1.0}};
    return record;
}

TEST(ObstacleRecords, DeformingOnesHaveTheirPosesInAFileBeside)
{
    const TemporaryDirectory dir;
    std::vector<ObstacleRecord> records = make_records();
    records.push_back(growing_box());
    write_obstacles(dir.path(), records);
    EXPECT_TRUE(std::filesystem::exists(dir / "obstacle_body.poses"));
    EXPECT_EQ(dir.entry_count(), 2U);
    const std::vector<ObstacleRecord> read = read_obstacles(dir.path());
    EXPECT_EQ(read[0].deformation, nullptr);
    ASSERT_NE(read[3].deformation, nullptr);
    EXPECT_EQ(read[3].deformation->sample_times(), (std::vector<double>{0.0, 1.0}));
    EXPECT_EQ(read[3].deformation->jumps(), std::vector<double>{1.0});
    for (const double time : {-1.0, 0.3, 1.0})
        EXPECT_EQ(read[3].world_points(time), records[3].world_points(time));

    const Vec3 corner = read[3].mesh.points[0];
    EXPECT_LT(
        (read[3].world_points(0.5)[0] - Vec3(-2 * corner.y(), 2 * corner.x(), 2 * corner.z() + 1)).norm(),
        1e-15);
    EXPECT_EQ(count_obstacle_frames(read[3], 24), 24U);
    EXPECT_EQ(read[2].world_points(7.0), records[2].mesh.points);
}

TEST(ObstacleRecords, PosesOfAnotherMeshOrNoneAreInputErrors)
{
    const TemporaryDirectory dir;
    write_obstacles(dir.path(), {growing_box()});
    PoseFileWriter writer({{0.0}, 3, false, PoseInterpolation::Cubic});
    writer.add({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    writer.finish()->copy_to(dir / "obstacle_body.poses");
    EXPECT_THAT(refusal(dir),
                HasSubstr("obstacle_body.poses: is damaged: it has 3 points where the obstacle has 8"));
    std::filesystem::remove(dir / "obstacle_body.poses");
    EXPECT_THAT(refusal(dir), HasSubstr("obstacle_body.poses: is missing"));
}

TEST(ObstacleRecords, AFileOfTheEarlierVersionIsRead)
{
    const TemporaryDirectory dir;
    constexpr FileKind kNow{"ARRIS obstacles\n", "obstacles 2", "", ""},
        kEarlier{"ARRIS obstacles\n", "obstacles 1", "", ""};
    const ObstacleRecord nails = make_records()[2];
    write_obstacles(dir.path(), {nails});
    std::string body = read_sealed(obstacles_file(dir.path()), kNow).body;
    body.pop_back();  // version 1 ends a record with its motion
    write_sealed(obstacles_file(dir.path()), kEarlier, body);
    const std::vector<ObstacleRecord> read = read_obstacles(dir.path());
    ASSERT_EQ(read.size(), 1U);
    EXPECT_EQ(read[0].mesh.points, nails.mesh.points);
    EXPECT_EQ(read[0].deformation, nullptr);
}

TEST(ObstacleRecords, OneThatDeformsMovesInItsPlacement)
{
    ObstacleRecord record = make_stretching("body", make_box({1.0, 2.0, 0.5}));
    record.placement = {rotation_about(Vec3::UnitZ(), 90.0), {0.0, 0.0, 3.0}};
    const std::vector<Vec3> own = record.points_at(2.0), world = record.world_points(2.0);
    for (std::size_t p = 0; p < own.size(); ++p) {
        EXPECT_EQ(own[p], stretched(record.mesh.points[p], 2.0));
        EXPECT_EQ(world[p], record.placement(own[p]));
    }
    EXPECT_EQ(count_obstacle_frames(record, 24), 24U);
}

TEST(ObstacleRecords, OneOfASinglePoseNeverMoves)
{
    ObstacleRecord record = make_stretching("body", make_box({1.0, 2.0, 0.5}));
    record.deformation = std::make_shared<FormulaDeformation>(
        record.mesh.points, [](const Vec3& rest, double) { return Vec3(2.0 * rest); },
        [](const Vec3&, double) { return Vec3(0.0, 0.0, 0.0); });
    EXPECT_EQ(count_obstacle_frames(record, 24), 1U);
    EXPECT_EQ(record.world_points(0.0)[0], 2.0 * record.mesh.points[0]);
}

}  // namespace
}  // namespace arris
