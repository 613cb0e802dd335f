// SPDX-License-Identifier: GPL-3.0-or-later
// The page is the template of viewer/dist with inserted script elements that the browser does not execute:
// one JSON element that lists the frames, and one element per block of data (base64 of zlib), which the page
// decodes when the block is shown.
//
//     frame      x y z of every vertex | strain of every face | contact of every vertex, one bit
//     topology   vertices of every face | vertices of every EOL edge | EOL vertices on corners and points
//     mesh       per obstacle: x y z of every point | points of every face, wire segment | lone points
//
// A topology is stored where it changes. Numbers are stored as differences to their predecessor, first all
// high bytes, then all low bytes: interleaved bytes hardly deflate (positions of 10k vertices with wrinkles
// of 0.1 mm take 31 instead of 58 kB; smooth positions 10 instead of 56 kB).
#include "app/export/viewer_html.h"

#include <algorithm>
#include <bit>
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
#include "app/files/atomic_file.h"
#include "app/files/frame.h"
#include "app/files/frame_files.h"
#include "embedded/viewer_template.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

using nlohmann::ordered_json;

constexpr std::string_view kDataMarker = "<!-- ARRIS-DATA -->";
constexpr double kLevels = 65535.0;      // steps of a 16-bit number
constexpr double kLargestNumber = 1e18;  // the page squares numbers in single precision, up to 3e38
constexpr double kTypicalQuantile =
    0.99;  // of a frame's strains, so that a few thin faces do not determine the colour range

/// Data that is constant from frame to frame until the mesh changes.
struct Topology {
    std::size_t vertices = 0;
    std::vector<Face> faces;
    std::vector<std::array<int, 2>> eol_edges;
    std::vector<int> eol_corners;

    bool operator==(const Topology&) const = default;
};

struct TopologyBlock {
    std::size_t vertices, faces, edges, corners;
    Bytes data;
};

/// The mesh of an obstacle, in the obstacle's frame relative to `centre`.
struct MeshBlock {
    const ObstacleRecord* obstacle;
    Vec3 centre, size;  // centre and size of the bounding box, m
    Bytes data;
};

struct FrameBlock {
    std::int64_t index;
    int topology;
    Vec3 least, size;  // bounding box, m
    double least_strain, strain_range;
    Bytes data;
};

/// The blocks of the page. Frames are left out to keep their total size below a limit.
struct Blocks {
    std::map<int, TopologyBlock> topologies;
    int newest_topology = -1;
    std::vector<FrameBlock> frames;
    std::vector<MeshBlock> meshes;
    std::vector<std::string> left_out;  ///< names of obstacles that do not fit
    std::int64_t stride = 1;
    std::size_t mesh_bytes = 0;
    std::size_t bytes = 0;  ///< total size of all blocks
    double least_strain = std::numeric_limits<double>::infinity();
    double greatest_strain = -std::numeric_limits<double>::infinity();
    double typical_strain = 0.0;
};

Bytes packed_topology(const Topology& topology)
{
    Bytes raw;
    append_indices(topology.faces, topology.eol_edges, topology.eol_corners, raw);
    return deflated(raw);
}

MeshBlock make_mesh_block(const ObstacleRecord& obstacle)
{
    const ObstacleMesh& mesh = obstacle.mesh;
    Vec3 least = mesh.points.front(), greatest = least;
    for (const Vec3& point : mesh.points) {
        least = least.cwiseMin(point);
        greatest = greatest.cwiseMax(point);
    }
    MeshBlock block{&obstacle, (least + greatest) / 2.0, greatest - least, {}};
    Bytes raw;
    std::vector<std::uint32_t> numbers;
    for (int axis = 0; axis < 3; ++axis)
        for (const Vec3& point : mesh.points)
            numbers.push_back(
                std::bit_cast<std::uint32_t>(static_cast<float>(point[axis] - block.centre[axis])));
    append_planes(numbers, raw);
    append_indices(mesh.faces, mesh.segments, mesh.lone_points, raw);
    block.data = deflated(raw);
    return block;
}

/// Stores the obstacles that fit into half of `most_bytes`, in their order.
void store_meshes(const std::vector<ObstacleRecord>& obstacles, std::size_t most_bytes, Blocks& blocks)
{
    for (const ObstacleRecord& obstacle : obstacles) {
        MeshBlock block = make_mesh_block(obstacle);
        if (blocks.mesh_bytes + block.data.size() > most_bytes / 2) {
            blocks.left_out.push_back(obstacle.name);
            continue;
        }
        blocks.mesh_bytes += block.data.size();
        blocks.meshes.push_back(std::move(block));
    }
    blocks.bytes = blocks.mesh_bytes;
}

/// Quantises `value` to 65536 levels from `least` to `least + range`; 0 if `range` is 0.
std::uint16_t quantised(double value, double least, double range)
{
    if (!(range > 0.0)) return 0;
    return static_cast<std::uint16_t>(std::lround(std::clamp((value - least) / range, 0.0, 1.0) * kLevels));
}

Bytes packed_frame(const Frame& frame, const FrameBlock& block)
{
    Bytes raw;
    raw.reserve(6 * frame.world.size() + 2 * frame.faces.size() + frame.world.size() / 8 + 1);
    std::vector<std::uint16_t> numbers;
    for (int axis = 0; axis < 3; ++axis) {
        numbers.clear();
        for (const Vec3& x : frame.world)
            numbers.push_back(quantised(x[axis], block.least[axis], block.size[axis]));
        append_planes(numbers, raw);
    }
    numbers.clear();
    for (const double strain : frame.strain)
        numbers.push_back(quantised(strain, block.least_strain, block.strain_range));
    append_planes(numbers, raw);

    const std::size_t bits = raw.size();
    raw.resize(bits + (frame.contact.size() + 7) / 8, 0);
    for (std::size_t v = 0; v < frame.contact.size(); ++v)
        if (frame.contact[v]) raw[bits + v / 8] |= static_cast<std::uint8_t>(1 << (v % 8));
    return deflated(raw);
}

Topology topology_of(const Frame& frame)
{
    Topology topology;
    topology.vertices = frame.world.size();
    topology.faces = frame.faces;
    topology.eol_edges = frame.eol_edges;
    for (std::size_t v = 0; v < frame.eol.size(); ++v)
        if (frame.eol[v] == 2) topology.eol_corners.push_back(static_cast<int>(v));
    return topology;
}

FrameBlock make_frame_block(const Frame& frame, std::int64_t index, int topology)
{
    FrameBlock block{index, topology, frame.world[0], frame.world[0], 0.0, 0.0, {}};
    Vec3 greatest = frame.world[0];
    for (const Vec3& x : frame.world) {
        block.least = block.least.cwiseMin(x);
        greatest = greatest.cwiseMax(x);
    }
    block.size = greatest - block.least;
    const auto [least, most] = std::minmax_element(frame.strain.begin(), frame.strain.end());
    block.least_strain = *least;
    block.strain_range = *most - *least;
    block.data = packed_frame(frame, block);
    return block;
}

double typical_strain(std::vector<double> strains)
{
    const auto rank = static_cast<std::ptrdiff_t>(kTypicalQuantile * static_cast<double>(strains.size() - 1));
    std::nth_element(strains.begin(), strains.begin() + rank, strains.end());
    return strains[static_cast<std::size_t>(rank)];
}

/// Removes every second of the frames kept so far, except the run's last, and the topologies that are then
/// unused.
void thin(std::int64_t last, Blocks& blocks)
{
    blocks.stride *= 2;
    std::erase_if(blocks.frames, [&](const FrameBlock& frame) {
        return frame.index % blocks.stride != 0 && frame.index != last;
    });
    std::set<int> used;
    blocks.bytes = blocks.mesh_bytes;
    for (const FrameBlock& frame : blocks.frames) {
        used.insert(frame.topology);
        blocks.bytes += frame.data.size();
    }
    std::erase_if(blocks.topologies, [&](const auto& entry) { return !used.contains(entry.first); });
    for (const auto& [id, topology] : blocks.topologies) blocks.bytes += topology.data.size();
}

/// Stores the frame's topology unless it equals `current`, that of the previous frame; updates `current`.
void store_topology(const Frame& frame, Topology& current, Blocks& blocks)
{
    // A topology that thin() has removed is stored again where a later frame has it.
    Topology topology = topology_of(frame);
    if (topology == current && blocks.topologies.contains(blocks.newest_topology)) return;
    TopologyBlock block{topology.vertices, topology.faces.size(), topology.eol_edges.size(),
                        topology.eol_corners.size(), packed_topology(topology)};
    blocks.bytes += block.data.size();
    blocks.topologies.emplace(++blocks.newest_topology, std::move(block));
    current = std::move(topology);
}

void store_frame(const Frame& frame, std::int64_t index, Blocks& blocks)
{
    FrameBlock block = make_frame_block(frame, index, blocks.newest_topology);
    blocks.bytes += block.data.size();
    blocks.least_strain = std::min(blocks.least_strain, block.least_strain);
    blocks.greatest_strain = std::max(blocks.greatest_strain, block.least_strain + block.strain_range);
    blocks.typical_strain = std::max(blocks.typical_strain, typical_strain(frame.strain));
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
}

/// Reads the run's frames one by one.
Blocks pack_run(const std::string& run_directory, std::size_t most_bytes,
                const std::vector<ObstacleRecord>& obstacles)
{
    const std::int64_t last = count_frames(run_directory) - 1;
    if (last < 0)
        throw InputError(frames_directory(run_directory) + ": has no frames (cloth_00000.ply, ...)");

    Blocks blocks;
    store_meshes(obstacles, most_bytes, blocks);
    Topology topology;
    for (std::int64_t index = 0; index <= last; ++index) {
        if (index % blocks.stride != 0 && index != last) continue;
        const std::string path = frame_file(run_directory, index, "ply");
        const Frame frame = read_frame(path);
        check_magnitudes(frame, path);
        store_topology(frame, topology, blocks);
        store_frame(frame, index, blocks);
        while (blocks.bytes > most_bytes && blocks.stride <= last) thin(last, blocks);
    }
    return blocks;
}

ordered_json vector_json(const Vec3& v)
{
    return {v.x(), v.y(), v.z()};
}

/// Rows of the 3 x 4 matrix that maps a point of the obstacle's block to the world at `time`.
ordered_json placement_json(const MeshBlock& mesh, double time)
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

/// The obstacles. A moving obstacle has one placement per frame of the page, any other a single one.
ordered_json meshes_json(const Blocks& blocks, double frames_per_second)
{
    ordered_json result = ordered_json::array();
    for (const MeshBlock& mesh : blocks.meshes) {
        const ObstacleMesh& shape = mesh.obstacle->mesh;
        ordered_json placements = ordered_json::array();
        for (const FrameBlock& frame : blocks.frames) {
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
    }
    return result;
}

/// The metadata, which viewer/src/run.js reads first. It ignores unknown keys.
ordered_json meta(const Blocks& blocks, const ViewerOptions& options)
{
    ordered_json result = {{"format", 1},
                           {"title", options.title},
                           {"frames_per_second", options.frames_per_second},
                           {"run_frames", blocks.frames.back().index + 1},
                           {"stride", blocks.stride},
                           {"strain",
                            {{"least", blocks.least_strain},
                             {"greatest", blocks.greatest_strain},
                             {"typical", blocks.typical_strain}}}};
    result["topologies"] = ordered_json::array();
    for (const auto& [id, topology] : blocks.topologies)
        result["topologies"].push_back({{"id", id},
                                        {"vertices", topology.vertices},
                                        {"faces", topology.faces},
                                        {"edges", topology.edges},
                                        {"corners", topology.corners}});
    result["frames"] = ordered_json::array();
    for (const FrameBlock& frame : blocks.frames)
        result["frames"].push_back({{"index", frame.index},
                                    {"topology", frame.topology},
                                    {"least", vector_json(frame.least)},
                                    {"size", vector_json(frame.size)},
                                    {"strain", {frame.least_strain, frame.strain_range}}});
    result["meshes"] = meshes_json(blocks, options.frames_per_second);
    if (!blocks.left_out.empty()) result["left_out"] = blocks.left_out;
    return result;
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

void write_page(const Blocks& blocks, const ViewerOptions& options, AtomicFile& file)
{
    const std::string_view page = embedded::viewer_template();
    const std::size_t marker = page.find(kDataMarker);
    assert(marker != std::string_view::npos && "the viewer's template has no place for data");
    file.write(page.substr(0, marker));
    file.write("<script type=\"application/json\" id=\"arris-meta\">" + inert_json(meta(blocks, options)) +
               "</script>\n");
    for (const auto& [id, topology] : blocks.topologies)
        write_data("arris-topology-" + std::to_string(id), topology.data, file);
    for (std::size_t i = 0; i < blocks.meshes.size(); ++i)
        write_data("arris-mesh-" + std::to_string(i), blocks.meshes[i].data, file);
    for (const FrameBlock& frame : blocks.frames)
        write_data("arris-frame-" + std::to_string(frame.index), frame.data, file);
    file.write(page.substr(marker + kDataMarker.size()));
}

}  // namespace

void write_viewer(const std::string& run_directory, const ViewerOptions& options,
                  const std::vector<ObstacleRecord>& obstacles)
{
    if (!(options.frames_per_second > 0.0) || !std::isfinite(options.frames_per_second))
        throw InputError(run_directory + ": a viewer needs frames_per_second above 0");
    const Blocks blocks = pack_run(run_directory, options.most_bytes, obstacles);

    AtomicFile file(run_directory + "/viewer.html");
    write_page(blocks, options, file);
    file.commit();
}

}  // namespace arris
