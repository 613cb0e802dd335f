// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/export/viewer_obstacles.h"

#include <bit>
#include <cstdint>
#include <utility>

#include "app/export/viewer_block.h"

namespace arris {
namespace {

ViewerMeshBlock make_mesh_block(const ObstacleRecord& obstacle)
{
    const ObstacleMesh& mesh = obstacle.mesh;
    const std::vector<Vec3> points = obstacle.points_at(0.0);
    const ViewerBox box = find_box(points);
    ViewerMeshBlock block{&obstacle, box.centre(), box.size(), {}};
    Bytes raw;
    if (!obstacle.is_deforming()) {
        std::vector<std::uint32_t> numbers;
        for (int axis = 0; axis < 3; ++axis)
            for (const Vec3& point : points)
                numbers.push_back(
                    std::bit_cast<std::uint32_t>(static_cast<float>(point[axis] - block.centre[axis])));
        append_planes(numbers, raw);
    }
    append_indices(mesh.faces, mesh.segments, mesh.lone_points, raw);
    block.data = deflated(raw);
    return block;
}

ViewerPoseBlock make_pose_block(const ViewerMeshBlock& mesh, double time)
{
    std::vector<Vec3> points = mesh.obstacle->points_at(time);
    for (Vec3& point : points) point -= mesh.centre;
    ViewerPoseBlock block{find_box(points), {}};
    Bytes raw;
    append_points(points, block.box, raw);
    block.data = deflated(raw);
    return block;
}

/// Least number of bytes that a page with the obstacle takes for it.
std::size_t count_least_bytes(const ViewerMeshBlock& mesh, double last_time)
{
    if (!mesh.obstacle->is_deforming()) return mesh.data.size();
    return mesh.data.size() + make_pose_block(mesh, 0.0).data.size() +
           make_pose_block(mesh, last_time).data.size();
}

}  // namespace

void store_meshes(const std::vector<ObstacleRecord>& obstacles, std::size_t most_bytes, double last_time,
                  ViewerBlocks& blocks)
{
    std::size_t taken = 0;
    for (const ObstacleRecord& obstacle : obstacles) {
        ViewerMeshBlock block = make_mesh_block(obstacle);
        const std::size_t bytes = count_least_bytes(block, last_time);
        if (taken + bytes > most_bytes / 2) {
            blocks.left_out.push_back(obstacle.name);
            continue;
        }
        taken += bytes;
        blocks.mesh_bytes += block.data.size();
        blocks.meshes.push_back(std::move(block));
    }
    blocks.bytes = blocks.mesh_bytes;
}

std::map<std::size_t, ViewerPoseBlock> make_pose_blocks(const std::vector<ViewerMeshBlock>& meshes,
                                                        double time)
{
    std::map<std::size_t, ViewerPoseBlock> poses;
    for (std::size_t k = 0; k < meshes.size(); ++k)
        if (meshes[k].obstacle->is_deforming()) poses.emplace(k, make_pose_block(meshes[k], time));
    return poses;
}

}  // namespace arris
