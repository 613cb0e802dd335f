// SPDX-License-Identifier: GPL-3.0-or-later
// The page is the template of viewer/dist with two kinds of inert script elements put in: one JSON element
// that lists the frames, and one element a block of data (base64 of zlib), which the page decodes when it
// shows it.
//
//     frame      x y z of every vertex | strain of every face | contact of every vertex, one bit
//     topology   vertices of every face | vertices of every EOL edge | EOL vertices on corners and points
//
// A topology is stored where it changes. Numbers are differences to their predecessor, first all high bytes,
// then all low ones: a mix of the two hardly deflates (positions of 10k vertices with wrinkles of 0.1 mm: 31
// instead of 58 kB; smooth ones 10 instead of 56).
#include "app/viewer_html.h"

#include <zlib.h>

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

#include "app/atomic_file.h"
#include "app/frame.h"
#include "app/frame_files.h"
#include "embedded/viewer_template.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

using Bytes = std::vector<std::uint8_t>;
using nlohmann::ordered_json;

constexpr std::string_view kDataMarker = "<!-- ARRIS-DATA -->";
constexpr double kLevels = 65535.0;        // of a 16-bit number
constexpr double kLargestNumber = 1e18;    // the page squares numbers in single precision, up to 3e38
constexpr double kTypicalQuantile = 0.99;  // of a frame's strains: a few slivers do not wash out the colours

/// What stays the same from frame to frame until the mesh changes.
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

struct FrameBlock {
    std::int64_t index;
    int topology;
    Vec3 least, size;  // bounding box, m
    double least_strain, strain_range;
    Bytes data;
};

/// What the page is made of: blocks that stay below a number of bytes, by leaving out frames if need be.
struct Blocks {
    std::map<int, TopologyBlock> topologies;
    int newest_topology = -1;
    std::vector<FrameBlock> frames;
    std::int64_t stride = 1;
    std::size_t bytes = 0;
    double least_strain = std::numeric_limits<double>::infinity();
    double greatest_strain = -std::numeric_limits<double>::infinity();
    double typical_strain = 0.0;
};

Bytes deflated(const Bytes& raw)
{
    uLongf size = compressBound(raw.size());
    Bytes result(size);
    if (compress2(result.data(), &size, raw.data(), raw.size(), Z_DEFAULT_COMPRESSION) != Z_OK)
        throw std::runtime_error("viewer.html: zlib ran out of memory");
    result.resize(size);
    result.shrink_to_fit();  // many are kept: their size is what counts, not its bound
    return result;
}

/// Differences of successive numbers modulo 65536, first the high bytes of all, then the low ones.
void append_planes(const std::vector<std::uint16_t>& numbers, Bytes& out)
{
    for (const int shift : {8, 0}) {
        unsigned previous = 0;
        for (const unsigned number : numbers) {
            out.push_back(static_cast<std::uint8_t>((number - previous) >> shift));
            previous = number;
        }
    }
}

/// An unsigned number for a signed difference, small where that is small: 0, -1, 1, -2, ... become 0, 1, 2,
/// 3, ...
std::uint32_t zigzag(std::int32_t difference)
{
    return (static_cast<std::uint32_t>(difference) << 1) ^ static_cast<std::uint32_t>(difference >> 31);
}

Bytes packed_topology(const Topology& topology)
{
    std::vector<std::uint32_t> numbers;
    std::int32_t previous = 0;
    const auto append = [&](int vertex) {
        numbers.push_back(zigzag(vertex - previous));
        previous = vertex;
    };
    for (const Face& face : topology.faces) std::for_each(face.begin(), face.end(), append);
    for (const auto& edge : topology.eol_edges) std::for_each(edge.begin(), edge.end(), append);
    std::for_each(topology.eol_corners.begin(), topology.eol_corners.end(), append);

    Bytes raw;
    for (int shift = 24; shift >= 0; shift -= 8)
        for (const std::uint32_t number : numbers) raw.push_back(static_cast<std::uint8_t>(number >> shift));
    return deflated(raw);
}

/// `value` on a scale of 65536 steps from `least` to `least + range`; 0 where the range is.
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

/// Leaves out every second of the frames kept so far, never the run's last, and the topologies only those
/// used.
void thin(std::int64_t last, Blocks& blocks)
{
    blocks.stride *= 2;
    std::erase_if(blocks.frames, [&](const FrameBlock& frame) {
        return frame.index % blocks.stride != 0 && frame.index != last;
    });
    std::set<int> used;
    blocks.bytes = 0;
    for (const FrameBlock& frame : blocks.frames) {
        used.insert(frame.topology);
        blocks.bytes += frame.data.size();
    }
    std::erase_if(blocks.topologies, [&](const auto& entry) { return !used.contains(entry.first); });
    for (const auto& [id, topology] : blocks.topologies) blocks.bytes += topology.data.size();
}

/// Stores the frame's topology unless it is that of the frame before, `current`, which becomes this one.
void store_topology(const Frame& frame, Topology& current, Blocks& blocks)
{
    // One that thinning threw out is stored again where a later frame has it.
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

/// Refuses what the page's single precision cannot hold.
void check_magnitudes(const Frame& frame, const std::string& path)
{
    if (frame.faces.empty()) throw InputError(path + ": no faces to show");
    for (const Vec3& x : frame.world)
        if (x.cwiseAbs().maxCoeff() > kLargestNumber)
            throw InputError(path + ": a vertex further away than a page can show");
    for (const double strain : frame.strain)
        if (std::abs(strain) > kLargestNumber)
            throw InputError(path + ": a strain larger than a page can show");
}

/// Reads the run's frames one by one.
Blocks pack_frames(const std::string& run_directory, std::size_t most_bytes)
{
    const std::int64_t last = count_frames(run_directory) - 1;
    if (last < 0) throw InputError(frames_directory(run_directory) + ": no frames (cloth_00000.ply, ...)");

    Blocks blocks;
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

/// What viewer/src/run.js reads first. Keys it does not know it leaves alone.
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
    return result;
}

/// JSON that no HTML parser takes for markup: `<` occurs in strings only, where \u003c means the same.
std::string inert_json(const ordered_json& json)
{
    std::string result;
    for (const char c : json.dump(-1, ' ', true, ordered_json::error_handler_t::replace))
        c == '<' ? result.append("\\u003c") : result.append(1, c);
    return result;
}

std::string base64(const Bytes& bytes)
{
    static constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string result;
    result.reserve(4 * ((bytes.size() + 2) / 3));
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            result.push_back(k <= count ? kDigits[group >> (18 - 6 * k) & 63U] : '=');
    }
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
    for (const FrameBlock& frame : blocks.frames)
        write_data("arris-frame-" + std::to_string(frame.index), frame.data, file);
    file.write(page.substr(marker + kDataMarker.size()));
}

}  // namespace

void write_viewer(const std::string& run_directory, const ViewerOptions& options)
{
    if (!(options.frames_per_second > 0.0) || !std::isfinite(options.frames_per_second))
        throw InputError(run_directory + ": a viewer needs frames_per_second above 0");
    const Blocks blocks = pack_frames(run_directory, options.most_bytes);

    AtomicFile file(run_directory + "/viewer.html");
    write_page(blocks, options, file);
    file.commit();
}

}  // namespace arris
