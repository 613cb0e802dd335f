// SPDX-License-Identifier: GPL-3.0-or-later
// The page is the template of viewer/dist with inserted script elements that the browser does not execute:
// one JSON element that lists the frames, and one element per block of data (base64 of zlib), which the page
// decodes when the block is shown.
//
//     frame      x y z of every vertex | strain of every face | contact of every vertex, one bit |
//                u v of the EOL vertices | speed of every vertex
//     topology   vertices of every face | vertices of every EOL edge | EOL vertices on corners and points |
//                u v of every vertex
//     mesh       per obstacle: x y z of every point | points of every face, wire segment | lone points
//     pose       per frame and obstacle that deforms: x y z of every point, which its mesh then lacks
//
// A topology is stored where it changes. Only EOL vertices move in the material, so a frame needs no other u
// v. Numbers are stored as differences to their predecessor, first all high bytes, then all low bytes:
// interleaved bytes hardly deflate (positions of 10k vertices with wrinkles of 0.1 mm take 31 instead of 58
// kB; smooth positions 10 instead of 56 kB).
#include "app/export/viewer_html.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <vector>

#include "app/export/viewer_block.h"
#include "app/export/viewer_meta.h"
#include "app/export/viewer_obstacles.h"
#include "app/files/atomic_file.h"
#include "app/files/frame.h"
#include "app/files/frame_files.h"
#include "embedded/viewer_template.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

using nlohmann::ordered_json;

constexpr std::string_view kDataMarker = "<!-- ARRIS-DATA -->";
constexpr double kSpeedLevels = 255.0;   // steps of a speed, which only a colour shows
constexpr double kLargestNumber = 1e18;  // the page squares numbers in single precision, up to 3e38
constexpr double kTypicalQuantile =
    0.99;  // of a frame's strains, so that a few thin faces do not determine the colour range

/// Appends u, then v of the points.
void append_material(const std::vector<Vec2>& points, const Vec2& least, const Vec2& size, Bytes& out)
{
    for (int axis = 0; axis < 2; ++axis) {
        std::vector<std::uint16_t> numbers;
        for (const Vec2& point : points) numbers.push_back(to_level(point[axis], least[axis], size[axis]));
        append_planes(numbers, out);
    }
}

Bytes packed_topology(const ViewerTopology& topology)
{
    Bytes raw;
    append_indices(topology.faces, topology.eol_edges, topology.eol_corners, raw);
    append_material(topology.material, topology.least, topology.size, raw);
    return deflated(raw);
}

/// Speeds as shares of the frame's greatest one, one byte each, as differences.
void append_speeds(const Frame& frame, double most, Bytes& out)
{
    std::uint8_t last = 0;
    for (const Vec3& velocity : frame.material_velocity) {
        const double share = most > 0.0 ? velocity.norm() / most : 0.0;
        const auto level = static_cast<std::uint8_t>(std::lround(std::clamp(share, 0.0, 1.0) * kSpeedLevels));
        out.push_back(static_cast<std::uint8_t>(level - last));
        last = level;
    }
}

Bytes packed_frame(const Frame& frame, const ViewerTopology& topology, const ViewerFrameBlock& block)
{
    Bytes raw;
    raw.reserve(6 * frame.world.size() + 2 * frame.faces.size() + frame.world.size() / 8 + 1);
    append_points(frame.world, block.box, raw);
    std::vector<std::uint16_t> numbers;
    for (const double strain : frame.strain)
        numbers.push_back(to_level(strain, block.least_strain, block.strain_range));
    append_planes(numbers, raw);

    const std::size_t bits = raw.size();
    raw.resize(bits + (frame.contact.size() + 7) / 8, 0);
    for (std::size_t v = 0; v < frame.contact.size(); ++v)
        if (frame.contact[v]) raw[bits + v / 8] |= static_cast<std::uint8_t>(1 << (v % 8));

    std::vector<Vec2> moved;
    for (const int v : topology.eol_vertices) moved.push_back(frame.material[static_cast<std::size_t>(v)]);
    append_material(moved, topology.least, topology.size, raw);
    append_speeds(frame, block.most_speed, raw);
    return deflated(raw);
}

/// Sets the part of the topology that concerns the material.
void find_material(const Frame& frame, ViewerTopology& topology)
{
    std::set<int> moving(topology.eol_corners.begin(), topology.eol_corners.end());
    for (const auto& edge : topology.eol_edges) moving.insert(edge.begin(), edge.end());
    topology.eol_vertices.assign(moving.begin(), moving.end());

    topology.least = frame.material[0];
    Vec2 greatest = frame.material[0];
    for (const Vec2& point : frame.material) {
        topology.least = topology.least.cwiseMin(point);
        greatest = greatest.cwiseMax(point);
    }
    topology.size = greatest - topology.least;
    topology.material = frame.material;
    for (const int v : topology.eol_vertices) topology.material[static_cast<std::size_t>(v)].setZero();
}

ViewerTopology topology_of(const Frame& frame)
{
    ViewerTopology topology;
    topology.vertices = frame.world.size();
    topology.faces = frame.faces;
    topology.eol_edges = frame.eol_edges;
    for (std::size_t v = 0; v < frame.eol.size(); ++v)
        if (frame.eol[v] == 2) topology.eol_corners.push_back(static_cast<int>(v));
    find_material(frame, topology);
    return topology;
}

ViewerFrameBlock make_frame_block(const Frame& frame, std::int64_t index, const ViewerTopology& topology,
                                  int id)
{
    ViewerFrameBlock block{index, id, find_box(frame.world), 0.0, 0.0, 0.0, {}, {}};
    const auto [least, most] = std::minmax_element(frame.strain.begin(), frame.strain.end());
    block.least_strain = *least;
    block.strain_range = *most - *least;
    for (const Vec3& velocity : frame.material_velocity)
        block.most_speed = std::max(block.most_speed, velocity.norm());
    block.data = packed_frame(frame, topology, block);
    return block;
}

double typical(std::vector<double> values)
{
    const auto rank = static_cast<std::ptrdiff_t>(kTypicalQuantile * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
}

double typical_speed(const Frame& frame)
{
    std::vector<double> speeds;
    for (const Vec3& velocity : frame.material_velocity) speeds.push_back(velocity.norm());
    return typical(std::move(speeds));
}

/// Removes every second of the frames kept so far, except the run's last, and the topologies that are then
/// unused.
void thin(std::int64_t last, ViewerBlocks& blocks)
{
    blocks.stride *= 2;
    std::erase_if(blocks.frames, [&](const ViewerFrameBlock& frame) {
        return frame.index % blocks.stride != 0 && frame.index != last;
    });
    std::set<int> used;
    blocks.bytes = blocks.mesh_bytes;
    for (const ViewerFrameBlock& frame : blocks.frames) {
        used.insert(frame.topology);
        blocks.bytes += frame.byte_count();
    }
    std::erase_if(blocks.topologies, [&](const auto& entry) { return !used.contains(entry.first); });
    for (const auto& [id, topology] : blocks.topologies) blocks.bytes += topology.data.size();
}

/// Stores the frame's topology unless it equals `current`, that of the previous frame; updates `current`.
void store_topology(const Frame& frame, ViewerTopology& current, ViewerBlocks& blocks)
{
    // A topology that thin() has removed is stored again where a later frame has it.
    ViewerTopology topology = topology_of(frame);
    if (topology == current && blocks.topologies.contains(blocks.newest_topology)) return;
    ViewerTopologyBlock block{topology.vertices,           topology.faces.size(), topology.eol_edges.size(),
                              topology.eol_corners.size(), topology.least,        topology.size,
                              packed_topology(topology)};
    blocks.bytes += block.data.size();
    blocks.topologies.emplace(++blocks.newest_topology, std::move(block));
    current = std::move(topology);
}

void store_frame(const Frame& frame, std::int64_t index, double time, const ViewerTopology& topology,
                 ViewerBlocks& blocks)
{
    ViewerFrameBlock block = make_frame_block(frame, index, topology, blocks.newest_topology);
    block.poses = make_pose_blocks(blocks.meshes, time);
    blocks.bytes += block.byte_count();
    blocks.least_strain = std::min(blocks.least_strain, block.least_strain);
    blocks.greatest_strain = std::max(blocks.greatest_strain, block.least_strain + block.strain_range);
    blocks.typical_strain = std::max(blocks.typical_strain, typical(frame.strain));
    blocks.typical_speed = std::max(blocks.typical_speed, typical_speed(frame));
    blocks.frames.push_back(std::move(block));
}

/// Refuses numbers that the page's single precision cannot hold.
void check_magnitudes(const Frame& frame, const std::string& path)
{
    if (frame.faces.empty()) throw InputError(path + ": has no faces to show");
    for (const Vec3& x : frame.world)
        if (x.cwiseAbs().maxCoeff() > kLargestNumber)
            throw InputError(path + ": a vertex is farther away than the viewer can show");
    for (const double strain : frame.strain)
        if (std::abs(strain) > kLargestNumber)
            throw InputError(path + ": a strain is larger than the viewer can show");
    for (const Vec3& velocity : frame.material_velocity)
        if (velocity.cwiseAbs().maxCoeff() > kLargestNumber)
            throw InputError(path + ": a speed is larger than the viewer can show");
}

/// Reads the run's frames one by one.
ViewerBlocks pack_run(const std::string& run_directory, const ViewerOptions& options,
                      const std::vector<ObstacleRecord>& obstacles)
{
    const std::int64_t last = count_frames(run_directory) - 1;
    if (last < 0) refuse_no_frames(run_directory);

    ViewerBlocks blocks;
    const auto time = [&](std::int64_t index) {
        return static_cast<double>(index) / options.frames_per_second;
    };
    store_meshes(obstacles, options.most_bytes, time(last), blocks);
    ViewerTopology topology;
    for (std::int64_t index = 0; index <= last; ++index) {
        if (index % blocks.stride != 0 && index != last) continue;
        const std::string path = frame_file(run_directory, index, "ply");
        const Frame frame = split_seams(read_frame(path));
        check_magnitudes(frame, path);
        store_topology(frame, topology, blocks);
        store_frame(frame, index, time(index), topology, blocks);
        while (blocks.bytes > options.most_bytes && blocks.stride <= last) thin(last, blocks);
    }
    return blocks;
}

/// JSON without HTML markup: `<` occurs only in strings, where \u003c is equivalent.
std::string inert_json(const ordered_json& json)
{
    std::string result;
    for (const char c : json.dump(-1, ' ', true, ordered_json::error_handler_t::replace))
        c == '<' ? result.append("\\u003c") : result.append(1, c);
    return result;
}

void write_data(const std::string& id, const Bytes& data, AtomicFile& file)
{
    file.write("<script type=\"text/plain\" id=\"" + id + "\">" + base64(data) + "</script>\n");
}

void write_page(const std::string& path, std::string_view first_line, const ViewerBlocks& blocks,
                const ViewerOptions& options)
{
    AtomicFile file(path);
    file.write(first_line);
    const std::string_view page = embedded::viewer_template();
    const std::size_t marker = page.find(kDataMarker);
    assert(marker != std::string_view::npos && "the viewer's template has no place for data");
    file.write(page.substr(0, marker));
    file.write("<script type=\"application/json\" id=\"arris-meta\">" +
               inert_json(viewer_meta(blocks, options)) + "</script>\n");
    for (const auto& [id, topology] : blocks.topologies)
        write_data("arris-topology-" + std::to_string(id), topology.data, file);
    for (std::size_t i = 0; i < blocks.meshes.size(); ++i)
        write_data("arris-mesh-" + std::to_string(i), blocks.meshes[i].data, file);
    for (const ViewerFrameBlock& frame : blocks.frames) {
        const std::string index = std::to_string(frame.index);
        write_data("arris-frame-" + index, frame.data, file);
        for (const auto& [mesh, pose] : frame.poses)
            write_data("arris-pose-" + std::to_string(mesh) + "-" + index, pose.data, file);
    }
    file.write(page.substr(marker + kDataMarker.size()));
    file.commit();
}

}  // namespace

void write_viewer(const std::string& run_directory, const ViewerOptions& options,
                  const std::vector<ObstacleRecord>& obstacles)
{
    if (!(options.frames_per_second > 0.0) || !std::isfinite(options.frames_per_second))
        throw InputError(run_directory + ": a viewer needs frames_per_second above 0");
    write_page(run_directory + "/viewer.html", "", pack_run(run_directory, options, obstacles), options);
}

void write_viewer_still(const std::string& path, std::string_view first_line, const ViewerStill& still)
{
    const ViewerOptions options{still.title};
    ViewerBlocks blocks;
    store_meshes(still.obstacles, options.most_bytes, 0.0, blocks);
    const std::size_t obstacles = blocks.meshes.size();
    store_meshes(still.marks, options.most_bytes, 0.0, blocks);
    for (std::size_t k = obstacles; k < blocks.meshes.size(); ++k) blocks.meshes[k].is_mark = true;
    const Frame frame = split_seams(still.frame);
    check_magnitudes(frame, path);
    ViewerTopology topology;
    store_topology(frame, topology, blocks);
    store_frame(frame, 0, 0.0, topology, blocks);
    write_page(path, first_line, blocks, options);
}

}  // namespace arris
