// SPDX-License-Identifier: GPL-3.0-or-later
//
// A .glb is a JSON chunk, which says where every array lies, then a chunk of arrays. The JSON holds bounds of
// all positions, so frames are read twice: for bounds, then to write them.
//
//     header | JSON | fixed arrays | shape of frame 0 | frame 1 - frame 0 | frame 2 - frame 0 | ...
//
// Fixed arrays are indices, material coordinates, times, weights and the points of rigid obstacles. Behind
// the cloth's shapes are those of each obstacle that deforms, in the same way. At frame i only one of n - 1
// weights is not 0. The n (n - 1) weights of the animation are stored sparsely.
#include "app/export/export_gltf.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>

#include "app/export/gltf_asset.h"
#include "app/export/gltf_obstacle.h"
#include "app/files/atomic_file.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kMostBytes = std::numeric_limits<std::uint32_t>::max();  // of a file and of a count

/// Positions and normals of one frame, or their differences from the first frame's.
struct Shape {
    std::vector<Float3> positions, normals;
};

/// For each material point the mean of the normals of the faces around its vertex, by area.
std::vector<Vec3> find_normals(const Frame& frame)
{
    std::vector<Vec3> normals(frame.world.size(), Vec3::Zero());
    for (const Face& face : frame.faces) {
        const Vec3 &a = frame.world[face[0]], &b = frame.world[face[1]], &c = frame.world[face[2]];
        for (const int v : face) normals[v] += (b - a).cross(c - a);
    }
    for (const int v : frame.seam_vertices) normals.push_back(normals[v]);
    for (Vec3& normal : normals) {
        normal.stableNormalize();
        if (!(normal.squaredNorm() > 0.5))
            normal = Vec3::UnitZ();  // faces of no area: any unit vector is valid
    }
    return normals;
}

/// Reads shapes of frames of one mesh.
class Shapes {
  public:
    Shapes(const std::string& path, const FrameSource& frames)
        : path_(path), frames_(frames), first_(frames.read(0))
    {
        if (first_.world.empty() || first_.faces.empty())
            throw InputError(path + ": frame 0 has no faces; allowed: at least one");
        normals_ = find_normals(first_);
    }

    const Frame& first() const { return first_; }

    /// Frame 0 itself, or the difference of frame i from frame 0.
    Shape read(std::size_t i) const
    {
        const Frame frame = i == 0 ? first_ : frames_.read(i);
        if (frame.world.size() != first_.world.size() || frame.faces != first_.faces)
            throw InputError(
                fmt::format("{}: frame {} has another mesh than frame 0; allowed: one mesh", path_, i));
        const std::vector<Vec3> normals = find_normals(frame);
        Shape shape;
        const std::size_t n = frame.world.size();
        for (std::size_t p = 0; p < normals.size(); ++p) {
            const std::size_t v = p < n ? p : static_cast<std::size_t>(frame.seam_vertices[p - n]);
            shape.positions.push_back(
                to_float3(path_, i, v, i == 0 ? frame.world[v] : frame.world[v] - first_.world[v]));
            shape.normals.push_back(to_float3(path_, i, v, i == 0 ? normals[p] : normals[p] - normals_[p]));
        }
        return shape;
    }

  private:
    const std::string& path_;
    const FrameSource& frames_;
    Frame first_;
    std::vector<Vec3> normals_;
};

/// Describes the shapes of all frames, which are streamed behind the fixed arrays; returns the cloth's mesh.
std::size_t add_cloth_mesh(GltfAsset& asset, const Shapes& shapes, std::size_t frame_count,
                           std::size_t material)
{
    const Frame& first = shapes.first();
    std::vector<std::array<float, 2>> uv;
    for (const Vec2& X : first.own_material())
        uv.push_back({static_cast<float>(X[0]), static_cast<float>(X[1])});
    const std::size_t indices =
        asset.add("SCALAR", kGltfUnsigned, to_indices(first.corners()), kGltfIndexArray);
    const std::size_t uvs = asset.add("VEC2", kGltfFloat, uv, kGltfVertexArray);

    asset.begin_streamed();
    GltfShapes described = asset.add_shapes(frame_count, uv.size(), {"POSITION", "NORMAL"},
                                            [&](std::size_t i) { return shapes.read(i).positions; });
    described.attributes["TEXCOORD_0"] = uvs;
    const Json primitive = {
        {"attributes", described.attributes}, {"indices", indices}, {"material", material}};
    return asset.add_mesh("cloth", Json::array({primitive}), described);
}

/// Adds the weights of all targets at the time of each frame.
std::size_t add_weights(GltfAsset& asset, std::size_t frame_count)
{
    std::vector<std::uint32_t> places;
    const std::size_t targets = frame_count - 1;
    for (std::size_t i = 1; i < frame_count; ++i)
        places.push_back(static_cast<std::uint32_t>(i * targets + (i - 1)));
    const std::vector<float> ones(targets, 1.0F);
    return asset.append(
        "accessors",
        {{"componentType", kGltfFloat},
         {"count", frame_count * targets},
         {"type", "SCALAR"},
         {"sparse",
          {{"count", targets},
           {"indices", {{"bufferView", asset.add_view(places, 0)}, {"componentType", kGltfUnsigned}}},
           {"values", {{"bufferView", asset.add_view(ones, 0)}}}}}});
}

std::size_t add_times(GltfAsset& asset, std::size_t frame_count, double frames_per_second)
{
    std::vector<float> times;
    for (std::size_t i = 0; i < frame_count; ++i)
        times.push_back(static_cast<float>(static_cast<double>(i) / frames_per_second));
    const std::size_t index = asset.add("SCALAR", kGltfFloat, times);
    asset.json["accessors"][index]["min"] = {times.front()};
    asset.json["accessors"][index]["max"] = {times.back()};
    return index;
}

std::size_t add_material(GltfAsset& asset, const char* name, const std::array<double, 4>& colour)
{
    return asset.append("materials",
                        {{"name", name},
                         {"pbrMetallicRoughness",
                          {{"baseColorFactor", colour}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.9}}},
                         {"doubleSided", true}});
}

GltfAsset make_asset(const std::string& path, const Shapes& shapes, std::size_t frame_count,
                     const GltfOptions& options, const std::vector<ObstacleRecord>& obstacles)
{
    GltfAsset asset;
    const std::size_t cloth_material = add_material(asset, "cloth", {0.55, 0.12, 0.10, 1.0});
    const std::size_t mesh = add_cloth_mesh(asset, shapes, frame_count, cloth_material);
    const std::size_t cloth = asset.append("nodes", {{"name", "cloth"}, {"mesh", mesh}});
    Json children = {cloth};
    GltfTimeline timeline{frame_count, options.frames_per_second};
    if (frame_count > 1) {  // an animation of one frame would move nothing
        timeline.times = add_times(asset, frame_count, options.frames_per_second);
        timeline.weights = add_weights(asset, frame_count);
        asset.add_channel(timeline.times, timeline.weights, cloth, "weights");
    }
    if (!obstacles.empty()) {
        const std::size_t material = add_material(asset, "obstacles", {0.5, 0.5, 0.5, 1.0});
        for (const ObstacleRecord& obstacle : obstacles)
            children.push_back(add_gltf_obstacle(asset, path, obstacle, timeline, material));
    }
    constexpr double kPi = 3.14159265358979323846;
    const Eigen::Quaterniond z_to_y(Eigen::AngleAxisd(-0.5 * kPi, Vec3::UnitX()));
    const std::size_t root =
        asset.append("nodes", {{"name", "arris"}, {"rotation", to_float4(z_to_y)}, {"children", children}});
    Json scene = {{"nodes", {root}}};
    if (!options.title.empty()) scene["name"] = options.title;
    asset.append("scenes", scene);
    asset.json["scene"] = 0;
    return asset;
}

void append_number(std::string& bytes, std::uint64_t value)
{
    const auto number = static_cast<std::uint32_t>(value);
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

}  // namespace

void write_gltf(const std::string& path, const FrameSource& frames, const GltfOptions& options,
                const std::vector<ObstacleRecord>& obstacles)
{
    const Shapes shapes(path, frames);
    std::uint64_t vertices = shapes.first().world.size(), shape_bytes = 2 * vertices * sizeof(Float3);
    for (const ObstacleRecord& obstacle : obstacles)
        if (obstacle.is_deforming()) {
            vertices += obstacle.mesh.points.size();
            shape_bytes += obstacle.mesh.points.size() * sizeof(Float3);
        }
    const auto require_size = [&](std::uint64_t bytes) {
        if (bytes > kMostBytes)
            throw InputError(
                fmt::format("{}: {} frames of {} vertices make {} bytes; allowed: {} (export fewer frames, "
                            "or a coarser --grid)",
                            path, frames.count, vertices, bytes, kMostBytes));
    };
    require_size(frames.count * shape_bytes);
    require_size(frames.count * frames.count);  // weights are counted by 32 bits, too
    GltfAsset asset = make_asset(path, shapes, frames.count, options, obstacles);

    asset.end_streamed();
    const std::uint64_t array_bytes = asset.fixed.size() + asset.streamed;
    asset.json["buffers"] = {{{"byteLength", array_bytes}}};
    std::string text = asset.json.dump(-1, ' ', false, Json::error_handler_t::replace);
    text.resize((text.size() + 3) / 4 * 4, ' ');

    constexpr std::uint64_t kHeaderBytes = 12, kChunkBytes = 8;
    const std::uint64_t bytes = kHeaderBytes + kChunkBytes + text.size() + kChunkBytes + array_bytes;
    require_size(bytes);
    std::string header = "glTF";
    append_number(header, 2);  // version
    append_number(header, bytes);
    append_number(header, text.size());
    header += "JSON" + text;
    append_number(header, array_bytes);
    header += std::string("BIN\0", 4);

    AtomicFile file(path);
    file.write(header);
    file.write(asset.fixed);
    for (std::size_t i = 0; i < frames.count; ++i) {
        const Shape shape = shapes.read(i);
        file.write(bytes_of(shape.positions));
        file.write(bytes_of(shape.normals));
    }
    for (const ObstacleRecord& obstacle : obstacles)
        write_gltf_poses(file, path, obstacle, {frames.count, options.frames_per_second});
    file.commit();
}

}  // namespace arris
