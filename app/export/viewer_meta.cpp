// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/export/viewer_meta.h"

namespace arris {
namespace {

using nlohmann::ordered_json;

ordered_json vector_json(const Vec3& v)
{
    return {v.x(), v.y(), v.z()};
}

/// Rows of the 3 x 4 matrix that maps a point of the obstacle's block to the world at `time`.
ordered_json placement_json(const ViewerMeshBlock& mesh, double time)
{
    const Placement placement = mesh.obstacle->at(time);
    const Vec3 centre = placement(mesh.centre);
    ordered_json rows = ordered_json::array();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) rows.push_back(placement.rotation(row, column));
        rows.push_back(centre[row]);
    }
    return rows;
}

ordered_json box_json(const ViewerBox& box)
{
    return {{"least", vector_json(box.least)}, {"size", vector_json(box.size())}};
}

/// The obstacles. One with a motion has a placement per frame of the page, any other a single one. One that
/// deforms has the box of its points per frame.
ordered_json meshes_json(const ViewerBlocks& blocks, double frames_per_second)
{
    ordered_json result = ordered_json::array();
    for (std::size_t k = 0; k < blocks.meshes.size(); ++k) {
        const ViewerMeshBlock& mesh = blocks.meshes[k];
        const ObstacleMesh& shape = mesh.obstacle->mesh;
        ordered_json placements = ordered_json::array();
        for (const ViewerFrameBlock& frame : blocks.frames) {
            placements.push_back(placement_json(mesh, static_cast<double>(frame.index) / frames_per_second));
            if (!mesh.obstacle->motion.is_moving()) break;
        }
        result.push_back({{"name", mesh.obstacle->name},
                          {"points", shape.points.size()},
                          {"faces", shape.faces.size()},
                          {"segments", shape.segments.size()},
                          {"lone_points", shape.lone_points.size()},
                          {"size", vector_json(mesh.size)},
                          {"placements", placements}});
        if (mesh.is_mark) result.back()["mark"] = true;
        if (!mesh.obstacle->is_deforming()) continue;
        ordered_json& poses = result.back()["poses"];
        for (const ViewerFrameBlock& frame : blocks.frames) poses.push_back(box_json(frame.poses.at(k).box));
    }
    return result;
}

}  // namespace

std::size_t ViewerFrameBlock::byte_count() const
{
    std::size_t bytes = data.size();
    for (const auto& [mesh, pose] : poses) bytes += pose.data.size();
    return bytes;
}

nlohmann::ordered_json viewer_meta(const ViewerBlocks& blocks, const ViewerOptions& options)
{
    ordered_json result = {{"format", 3},
                           {"title", options.title},
                           {"frames_per_second", options.frames_per_second},
                           {"run_frames", blocks.frames.back().index + 1},
                           {"stride", blocks.stride},
                           {"strain",
                            {{"least", blocks.least_strain},
                             {"greatest", blocks.greatest_strain},
                             {"typical", blocks.typical_strain}}},
                           {"typical_speed", blocks.typical_speed}};
    result["topologies"] = ordered_json::array();
    for (const auto& [id, topology] : blocks.topologies)
        result["topologies"].push_back({{"id", id},
                                        {"vertices", topology.vertices},
                                        {"faces", topology.faces},
                                        {"edges", topology.edges},
                                        {"corners", topology.corners},
                                        {"least", {topology.least.x(), topology.least.y()}},
                                        {"size", {topology.size.x(), topology.size.y()}}});
    result["frames"] = ordered_json::array();
    for (const ViewerFrameBlock& frame : blocks.frames)
        result["frames"].push_back({{"index", frame.index},
                                    {"topology", frame.topology},
                                    {"least", vector_json(frame.box.least)},
                                    {"size", vector_json(frame.box.size())},
                                    {"strain", {frame.least_strain, frame.strain_range}},
                                    {"speed", frame.most_speed}});
    result["meshes"] = meshes_json(blocks, options.frames_per_second);
    if (!blocks.left_out.empty()) result["left_out"] = blocks.left_out;
    return result;
}

}  // namespace arris
