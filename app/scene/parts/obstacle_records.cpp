// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/obstacle_records.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

#include "app/files/binary_stream.h"
#include "app/files/keyframe_stream.h"
#include "app/files/pose_file.h"
#include "app/scene/keys/scene_keys.h"
#include "app/text/printable.h"
#include "geometry/input_error.h"
#include "geometry/obstacle/obstacle_topology.h"

namespace arris {
namespace {

// The format has a version of its own, so that a later version of the program can export an earlier run.
constexpr FileKind kKind = {"ARRIS obstacles\n", "obstacles 2", "there are no obstacles",
                            "is not an obstacles file of arris", "obstacles 1"};

void write_placement(BinaryWriter& out, const Placement& placement)
{
    for (int row = 0; row < 3; ++row) out.vector(placement.rotation.row(row));
    out.vector(placement.translation);
}

Placement read_placement(BinaryReader& in)
{
    Placement placement;
    for (int row = 0; row < 3; ++row) placement.rotation.row(row) = in.vector();
    placement.translation = in.vector();
    return placement;
}

void write_motion(BinaryWriter& out, const RigidMotion& motion)
{
    for (const Vec3* vector : {&motion.velocity, &motion.angular_velocity, &motion.pivot})
        out.vector(*vector);
    out.number(motion.start);
    out.number(motion.stop);
    write_keyframes(out, motion.keyframes);
}

RigidMotion read_motion(BinaryReader& in)
{
    RigidMotion motion;
    for (Vec3* vector : {&motion.velocity, &motion.angular_velocity, &motion.pivot}) *vector = in.vector();
    motion.start = in.number<double>();
    motion.stop = in.number<double>();
    motion.keyframes = read_keyframes(in);
    return motion;
}

template <std::size_t size>
void write_tuples(BinaryWriter& out, const std::vector<std::array<int, size>>& tuples)
{
    out.list(tuples, [&](const std::array<int, size>& tuple) {
        for (const int index : tuple) out.number(static_cast<std::int32_t>(index));
    });
}

template <std::size_t size>
std::vector<std::array<int, size>> read_tuples(BinaryReader& in)
{
    return in.list<std::array<int, size>>(size * sizeof(std::int32_t), [&] {
        std::array<int, size> tuple;
        for (int& index : tuple) index = in.number<std::int32_t>();
        return tuple;
    });
}

void write_mesh(BinaryWriter& out, const ObstacleMesh& mesh)
{
    out.vectors(mesh.points);
    write_tuples(out, mesh.faces);
    write_tuples(out, mesh.segments);
    out.list(mesh.lone_points, [&](int point) { out.number(static_cast<std::int32_t>(point)); });
}

ObstacleMesh read_mesh(BinaryReader& in)
{
    ObstacleMesh mesh;
    mesh.points = in.vectors();
    mesh.faces = read_tuples<3>(in);
    mesh.segments = read_tuples<2>(in);
    mesh.lone_points =
        in.list<int>(sizeof(std::int32_t), [&] { return static_cast<int>(in.number<std::int32_t>()); });
    return mesh;
}

/// Describes the first invalid value; empty if there is none.
std::string find_defect(const ObstacleRecord& record)
{
    if (!is_scene_name(record.name)) return "the name of an obstacle is invalid";
    const RigidMotion& motion = record.motion;
    const bool is_sound = record.placement.rotation.allFinite() && record.placement.translation.allFinite() &&
                          motion.velocity.allFinite() && motion.angular_velocity.allFinite() &&
                          motion.pivot.allFinite() && std::isfinite(motion.start) &&
                          motion.stop >= motion.start && are_sound(motion.keyframes);
    if (!is_sound) return record.name + ": the motion is invalid";
    const std::string defect = validate(record.mesh);
    return defect.empty() ? defect : record.name + ": " + defect;
}

const PoseFile& poses_of(const Deformation& deformation)
{
    return dynamic_cast<const PoseFile&>(*dynamic_cast<const PointCache&>(deformation).source());
}

std::shared_ptr<const Deformation> open_poses(const std::string& run_dir, const ObstacleRecord& record)
{
    const std::string path = poses_file(run_dir, record.name);
    std::shared_ptr<const PoseFile> file = PoseFile::open(path);
    if (file->point_count() != record.mesh.points.size())
        throw InputError(fmt::format("{}: is damaged: it has {} points where the obstacle has {}",
                                     printable(path), file->point_count(), record.mesh.points.size()));
    const PoseInterpolation interpolation = file->head().interpolation;
    return std::make_shared<PointCache>(std::move(file), interpolation);
}

}  // namespace

std::vector<Vec3> ObstacleRecord::points_at(double time) const
{
    if (!deformation) return mesh.points;
    std::vector<Vec3> points, velocities;
    deformation->find(time, points, velocities);
    return points;
}

std::vector<Vec3> ObstacleRecord::world_points(double time) const
{
    std::vector<Vec3> points = points_at(time);
    const Placement to_world = at(time);
    for (Vec3& point : points) point = to_world(point);
    return points;
}

std::string obstacles_file(const std::string& run_dir)
{
    return (std::filesystem::path(run_dir) / "obstacles").string();
}

std::string poses_file(const std::string& run_dir, const std::string& name)
{
    return (std::filesystem::path(run_dir) / fmt::format("obstacle_{}.poses", name)).string();
}

bool is_poses_file(std::string_view name)
{
    constexpr std::string_view kBefore = "obstacle_", kAfter = ".poses";
    return name.size() > kBefore.size() + kAfter.size() && name.starts_with(kBefore) &&
           name.ends_with(kAfter) &&
           is_scene_name(name.substr(kBefore.size(), name.size() - kBefore.size() - kAfter.size()));
}

std::uint64_t count_pose_bytes(const Deformation& deformation)
{
    return poses_of(deformation).size();
}

void write_obstacles(const std::string& run_dir, const std::vector<ObstacleRecord>& obstacles)
{
    for (const ObstacleRecord& record : obstacles)
        if (record.deformation) poses_of(*record.deformation).copy_to(poses_file(run_dir, record.name));
    BinaryWriter body;
    body.list(obstacles, [&](const ObstacleRecord& record) {
        body.text(record.name);
        write_mesh(body, record.mesh);
        write_placement(body, record.placement);
        write_motion(body, record.motion);
        body.number(static_cast<std::uint8_t>(record.deformation != nullptr));
    });
    write_sealed(obstacles_file(run_dir), kKind, body.bytes());
}

std::vector<ObstacleRecord> read_obstacles(const std::string& run_dir)
{
    const std::string path = obstacles_file(run_dir);
    if (!std::filesystem::exists(path)) return {};
    const SealedFile file = read_sealed(path, kKind);
    const bool has_deformations = file.version == kKind.version;
    BinaryReader in(file.body, path);
    std::vector<char> is_deforming;
    constexpr std::size_t kLeastRecordBytes = 24 * sizeof(double);
    std::vector<ObstacleRecord> records = in.list<ObstacleRecord>(kLeastRecordBytes, [&] {
        ObstacleRecord record;
        record.name = in.text();
        record.mesh = read_mesh(in);
        record.placement = read_placement(in);
        record.motion = read_motion(in);
        is_deforming.push_back(has_deformations && in.number<std::uint8_t>() != 0 ? 1 : 0);
        return record;
    });
    if (!in.is_at_end()) in.fail("is damaged: it is longer than its counts say");
    std::set<std::string> names = {"cloth"};
    for (const ObstacleRecord& record : records) {
        if (const std::string defect = find_defect(record); !defect.empty()) in.fail("is damaged: " + defect);
        if (!names.insert(record.name).second) in.fail("is damaged: a name occurs twice");
    }
    for (std::size_t i = 0; i < records.size(); ++i)
        if (is_deforming[i] != 0) records[i].deformation = open_poses(run_dir, records[i]);
    return records;
}

std::size_t count_obstacle_frames(const ObstacleRecord& obstacle, std::size_t frame_count)
{
    return obstacle.is_moving() ? frame_count : std::min<std::size_t>(frame_count, 1);
}

}  // namespace arris
