// SPDX-License-Identifier: GPL-3.0-or-later
//
// A .glb is a JSON chunk, which says where every array lies, then a chunk of arrays. The JSON holds bounds of
// all positions, so frames are read twice: for bounds, then to write them.
//
//     header | JSON | fixed arrays | shape of frame 0 | frame 1 - frame 0 | frame 2 - frame 0 | ...
//
// Fixed arrays are indices, material coordinates, times, weights and all of the obstacles.
// At frame i only one of n - 1 weights is not 0. The n (n - 1) weights of the animation are stored sparsely.
#include "app/export/export_gltf.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>

#include "app/export/float_value.h"
#include "app/export/gltf_asset.h"
#include "app/files/atomic_file.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

using Json = nlohmann::ordered_json;
using Float4 = std::array<float, 4>;

constexpr std::uint64_t kMostBytes = std::numeric_limits<std::uint32_t>::max();  // of a file and of a count

/// Positions and normals of one frame, or their differences from the first frame's.
struct Shape {
    std::vector<Float3> positions, normals;
};

/// Means of the normals of the faces around each vertex, by area.
std::vector<Vec3> find_normals(const Frame& frame)
{
    std::vector<Vec3> normals(frame.world.size(), Vec3::Zero());
    for (const Face& face : frame.faces) {
        const Vec3 &a = frame.world[face[0]], &b = frame.world[face[1]], &c = frame.world[face[2]];
        for (const int v : face) normals[v] += (b - a).cross(c - a);
    }
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
        for (std::size_t v = 0; v < frame.world.size(); ++v) {
            shape.positions.push_back(
                to_floats(i, v, i == 0 ? frame.world[v] : frame.world[v] - first_.world[v]));
            shape.normals.push_back(to_floats(i, v, i == 0 ? normals[v] : normals[v] - normals_[v]));
        }
        return shape;
    }

  private:
    Float3 to_floats(std::size_t i, std::size_t v, const Vec3& value) const
    {
        Float3 floats;
        for (int k = 0; k < 3; ++k) floats[k] = float_value(path_, i, v, value[k]);
        return floats;
    }

    const std::string& path_;
    const FrameSource& frames_;
    Frame first_;
    std::vector<Vec3> normals_;
};

std::string_view bytes_of(const std::vector<Float3>& values)
{
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Float3)};
}

std::vector<std::uint32_t> to_indices(const auto& cells)
{
    std::vector<std::uint32_t> indices;
    for (const auto& cell : cells)
        for (const int v : cell) indices.push_back(static_cast<std::uint32_t>(v));
    return indices;
}

/// Describes the shapes of all frames, which are streamed behind the fixed arrays; returns the cloth's mesh.
std::size_t add_cloth_mesh(GltfAsset& asset, const Shapes& shapes, std::size_t frame_count,
                           std::size_t material)
{
    const Frame& first = shapes.first();
    std::vector<std::array<float, 2>> uv;
    for (const Vec2& X : first.material) uv.push_back({static_cast<float>(X[0]), static_cast<float>(X[1])});
    const std::size_t indices = asset.add("SCALAR", kGltfUnsigned, to_indices(first.faces), kGltfIndexArray);
    const std::size_t uvs = asset.add("VEC2", kGltfFloat, uv, kGltfVertexArray);

    const std::size_t shape_bytes = first.world.size() * sizeof(Float3);
    const std::size_t view = asset.append("bufferViews", {{"buffer", 0}, {"byteStride", sizeof(Float3)}});
    Json targets = Json::array(), names = Json::array(), attributes;
    for (std::size_t i = 0; i < frame_count; ++i) {
        Json attribute;
        for (const char* name : {"POSITION", "NORMAL"}) {
            attribute[name] = asset.append("accessors", {{"bufferView", view},
                                                         {"byteOffset", asset.streamed},
                                                         {"componentType", kGltfFloat},
                                                         {"count", first.world.size()},
                                                         {"type", "VEC3"}});
            asset.streamed += shape_bytes;
        }
        asset.set_bounds(attribute["POSITION"], find_gltf_bounds(shapes.read(i).positions));
        if (i == 0) {
            attributes = attribute;
            continue;
        }
        targets.push_back(attribute);
        names.push_back(fmt::format("frame {}", i));
    }
    asset.json["bufferViews"][view]["byteLength"] = asset.streamed;
    asset.json["bufferViews"][view]["target"] = kGltfVertexArray;

    attributes["TEXCOORD_0"] = uvs;
    Json primitive = {{"attributes", attributes}, {"indices", indices}, {"material", material}};
    if (targets.empty()) return asset.append("meshes", {{"name", "cloth"}, {"primitives", {primitive}}});
    primitive["targets"] = std::move(targets);
    return asset.append("meshes", {{"name", "cloth"},
                                   {"primitives", {primitive}},
                                   {"weights", std::vector<double>(frame_count - 1, 0.0)},
                                   {"extras", {{"targetNames", names}}}});
}

void animate_weights(GltfAsset& asset, std::size_t frame_count, std::size_t times, std::size_t node)
{
    std::vector<std::uint32_t> places;
    const std::size_t targets = frame_count - 1;
    for (std::size_t i = 1; i < frame_count; ++i)
        places.push_back(static_cast<std::uint32_t>(i * targets + (i - 1)));
    const std::vector<float> ones(targets, 1.0F);
    const std::size_t weights = asset.append(
        "accessors",
        {{"componentType", kGltfFloat},
         {"count", frame_count * targets},
         {"type", "SCALAR"},
         {"sparse",
          {{"count", targets},
           {"indices", {{"bufferView", asset.add_view(places, 0)}, {"componentType", kGltfUnsigned}}},
           {"values", {{"bufferView", asset.add_view(ones, 0)}}}}}});
    asset.add_channel(times, weights, node, "weights");
}

/// The mesh of an obstacle, in its frame; null if it has no points.
Json add_obstacle_mesh(GltfAsset& asset, const std::string& path, const ObstacleRecord& obstacle,
                       std::size_t material)
{
    const ObstacleMesh& mesh = obstacle.mesh;
    if (mesh.points.empty()) return nullptr;
    std::vector<Float3> points;
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        const auto at = [&](int k) {
            return float_value(path + ": " + obstacle.name, 0, v, mesh.points[v][k]);
        };
        points.push_back({at(0), at(1), at(2)});
    }
    const std::size_t positions = asset.add_positions(points);
    std::vector<std::array<int, 1>> lone_points;
    for (const int v : mesh.lone_points) lone_points.push_back({v});
    Json primitives = Json::array();
    const auto add = [&](int mode, const auto& cells) {
        if (cells.empty()) return;
        const std::size_t indices = asset.add("SCALAR", kGltfUnsigned, to_indices(cells), kGltfIndexArray);
        primitives.push_back({{"attributes", {{"POSITION", positions}}},
                              {"indices", indices},
                              {"mode", mode},
                              {"material", material}});
    };
    add(kGltfTriangles, mesh.faces);
    add(kGltfLines, mesh.segments);
    add(kGltfPoints, lone_points);
    if (primitives.empty()) return nullptr;
    return asset.append("meshes", {{"name", obstacle.name}, {"primitives", primitives}});
}

Float4 to_floats(const Eigen::Quaterniond& q)
{
    return {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z()),
            static_cast<float>(q.w())};
}

std::size_t add_obstacle(GltfAsset& asset, const std::string& path, const ObstacleRecord& obstacle,
                         std::size_t frame_count, double frames_per_second, std::size_t times,
                         std::size_t material)
{
    std::vector<Float3> translations;
    std::vector<Float4> rotations;
    Eigen::Quaterniond previous = Eigen::Quaterniond::Identity();
    for (std::size_t i = 0; i < count_obstacle_frames(obstacle, frame_count); ++i) {
        const Placement place = obstacle.at(static_cast<double>(i) / frames_per_second);
        Eigen::Quaterniond turned(place.rotation);
        turned.normalize();
        if (turned.dot(previous) < 0.0)
            turned.coeffs() = -turned.coeffs();  // the same rotation, the shorter arc
        previous = turned;
        rotations.push_back(to_floats(turned));
        Float3 x;
        for (int k = 0; k < 3; ++k)
            x[k] = float_value(path + ": " + obstacle.name, i, 0, place.translation[k]);
        translations.push_back(x);
    }
    Json node = {{"name", obstacle.name}, {"translation", translations.at(0)}, {"rotation", rotations.at(0)}};
    const Json mesh = add_obstacle_mesh(asset, path, obstacle, material);
    if (!mesh.is_null()) node["mesh"] = mesh;
    const std::size_t index = asset.append("nodes", node);
    if (translations.size() > 1) {
        asset.add_channel(times, asset.add("VEC3", kGltfFloat, translations), index, "translation");
        asset.add_channel(times, asset.add("VEC4", kGltfFloat, rotations), index, "rotation");
    }
    return index;
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
    // An animation of one frame would move nothing.
    const std::size_t times = frame_count > 1 ? add_times(asset, frame_count, options.frames_per_second) : 0;
    if (frame_count > 1) animate_weights(asset, frame_count, times, cloth);
    if (!obstacles.empty()) {
        const std::size_t material = add_material(asset, "obstacles", {0.5, 0.5, 0.5, 1.0});
        for (const ObstacleRecord& obstacle : obstacles)
            children.push_back(
                add_obstacle(asset, path, obstacle, frame_count, options.frames_per_second, times, material));
    }
    constexpr double kPi = 3.14159265358979323846;
    const Eigen::Quaterniond z_to_y(Eigen::AngleAxisd(-0.5 * kPi, Vec3::UnitX()));
    const std::size_t root =
        asset.append("nodes", {{"name", "arris"}, {"rotation", to_floats(z_to_y)}, {"children", children}});
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
    const std::uint64_t shape_bytes = 2 * shapes.first().world.size() * sizeof(Float3);
    const auto require_size = [&](std::uint64_t bytes) {
        if (bytes > kMostBytes)
            throw InputError(
                fmt::format("{}: {} frames of {} vertices make {} bytes; allowed: {} (export fewer frames, "
                            "or a coarser --grid)",
                            path, frames.count, shapes.first().world.size(), bytes, kMostBytes));
    };
    require_size(frames.count * shape_bytes);
    require_size(frames.count * frames.count);  // weights are counted by 32 bits, too
    GltfAsset asset = make_asset(path, shapes, frames.count, options, obstacles);

    // The streamed shapes lie behind the fixed arrays, whose size is known only now.
    const std::uint64_t array_bytes = asset.fixed.size() + asset.streamed;
    for (Json& view : asset.json["bufferViews"])
        if (!view.contains("byteOffset")) view["byteOffset"] = asset.fixed.size();
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
    file.commit();
}

}  // namespace arris
