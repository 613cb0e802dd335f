// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/gltf/gltf_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <cstring>

#include "tests/geometry/imported_file.h"
#include "tests/geometry/mesh_files.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kSingle = 1e-6;

ObstacleMesh brick()
{
    return samples::box(Vec3::Zero(), Vec3(1, 2, 3));
}

std::string base64(const std::string& bytes)
{
    constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k <= bytes.size() ? kDigits[bits >> (18 - 6 * k) & 63u] : '=';
    }
    return text;
}

std::string data_uri(const std::string& bytes)
{
    return "data:application/octet-stream;base64," + base64(bytes);
}

template <class Number>
std::string raw(const std::vector<Number>& numbers)
{
    return std::string(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number));
}

// The JSON of the brick with its buffer in a data URI.
json brick_json()
{
    return json::parse(mesh_files::gltf_json(brick(), data_uri(mesh_files::gltf_buffer(brick()))));
}

std::string glb_of(const json& file, const std::string& chunk)
{
    const auto padded = [](std::string bytes, char by) {
        bytes.resize((bytes.size() + 3) / 4 * 4, by);
        return bytes;
    };
    const auto number = [](std::size_t n) {
        return raw(std::vector<std::uint32_t>{static_cast<std::uint32_t>(n)});
    };
    const std::string text = padded(file.dump(), ' '), binary = padded(chunk, '\0');
    return "glTF" + number(2) + number(28 + text.size() + binary.size()) + number(text.size()) + "JSON" +
           text + number(binary.size()) + std::string("BIN\0", 4) + binary;
}

// glTF is y up: (x, y, z) -> (x, -z, y).
void expect_brick(const ObstacleFile& file, double scale, double tolerance)
{
    EXPECT_EQ(file.mesh.points.size(), 8u);
    EXPECT_EQ(file.mesh.faces.size(), 12u);
    Eigen::AlignedBox3d bounds;
    for (const Vec3& p : file.mesh.points) bounds.extend(p);
    EXPECT_LT((bounds.min() - scale * Vec3(0, -3, 0)).norm(), tolerance);
    EXPECT_LT((bounds.max() - scale * Vec3(1, 0, 2)).norm(), tolerance);
    EXPECT_NEAR(volume_of(file.mesh), 6.0 * scale * scale * scale, 30 * tolerance);
}

template <class Number>
std::string integers(double scale, std::size_t stride)
{
    std::string bytes;
    for (const Vec3& p : brick().points) {
        std::string one;
        for (int axis = 0; axis < 3; ++axis)
            one += raw(std::vector<Number>{static_cast<Number>(std::lround(scale * p[axis]))});
        one.resize(stride, '\x55');
        bytes += one;
    }
    return bytes;
}

struct Quantized {
    const char* name;
    int component_type;
    std::string positions;
    std::size_t stride;
    bool is_normalized;
    double scale;  // of the brick in the file
};

json quantized_json(const Quantized& q)
{
    const std::size_t indices = 72;
    json file = brick_json();
    json& accessor = file["accessors"][0];
    accessor["componentType"] = q.component_type;
    accessor["normalized"] = q.is_normalized;
    accessor.erase("min");
    accessor.erase("max");
    json& views = file["bufferViews"];
    views[0]["byteLength"] = q.positions.size();
    views[0]["byteStride"] = q.stride;
    views[1]["byteOffset"] = q.positions.size();
    file["buffers"][0]["byteLength"] = q.positions.size() + indices;
    file["extensionsUsed"] = file["extensionsRequired"] = {"KHR_mesh_quantization"};
    return file;
}

TEST(GltfFile, IntegerPositionsAreRead)
{
    const std::string indices = mesh_files::gltf_buffer(brick()).substr(96);
    const Quantized cases[] = {
        {"short", 5122, integers<std::int16_t>(1000, 8), 8, false, 1000},
        {"unsigned short", 5123, integers<std::uint16_t>(20000, 8), 8, false, 20000},
        {"byte", 5120, integers<std::int8_t>(40, 4), 4, false, 40},
        {"unsigned byte", 5121, integers<std::uint8_t>(80, 4), 4, false, 80},
        {"normalized short", 5122, integers<std::int16_t>(32767 / 3.0, 8), 8, true, 1 / 3.0},
        {"normalized unsigned short", 5123, integers<std::uint16_t>(65535 / 3.0, 8), 8, true, 1 / 3.0},
        {"normalized byte", 5120, integers<std::int8_t>(42, 4), 4, true, 42 / 127.0},
        {"normalized unsigned byte", 5121, integers<std::uint8_t>(85, 4), 4, true, 1 / 3.0},
    };
    for (const Quantized& q : cases) {
        SCOPED_TRACE(q.name);
        const double tolerance = q.is_normalized ? 5e-5 : kSingle * q.scale;
        json file = quantized_json(q);
        file["buffers"][0]["uri"] = data_uri(q.positions + indices);
        const ObstacleFile found = imported("a.gltf", file.dump());
        expect_brick(found, q.scale, tolerance);
        EXPECT_THAT(found.warnings, IsEmpty());
        file["buffers"][0].erase("uri");
        expect_brick(imported("a.glb", glb_of(file, q.positions + indices)), q.scale, tolerance);
        // The scale of a node undoes that of the integers.
        file["nodes"][0]["scale"] = {1 / q.scale, 1 / q.scale, 1 / q.scale};
        expect_brick(imported("a.glb", glb_of(file, q.positions + indices)), 1.0, tolerance / q.scale);
    }
}

TEST(GltfFile, IntegersMayBeInAFileBesideTheMesh)
{
    const Quantized q = {"short", 5122, integers<std::int16_t>(1000, 8), 8, false, 1000};
    const std::filesystem::path folder =
        std::filesystem::path(::testing::TempDir()) / "arris_gltf_file_siblings";
    std::filesystem::create_directories(folder / "in");
    const std::string buffer = q.positions + mesh_files::gltf_buffer(brick()).substr(96);
    std::ofstream(folder / "in" / "buffer.bin", std::ios::binary) << buffer;
    std::ofstream(folder / "out.bin", std::ios::binary) << buffer;
    const auto import = [&](const std::string& uri) {
        json file = quantized_json(q);
        file["buffers"][0]["uri"] = uri;
        std::ofstream(folder / "in" / "a.gltf") << file.dump();
        return import_obstacle((folder / "in" / "a.gltf").string(), {}, {});
    };
    expect_brick(import("buffer.bin"), q.scale, kSingle * q.scale);
    EXPECT_THAT(error_of([&] { import("../out.bin"); }), HasSubstr("is not inside the mesh's own folder"));
    EXPECT_THAT(error_of([&] { import("missing.bin"); }), HasSubstr("'missing.bin' cannot be read"));
    EXPECT_THAT(error_of([&] { import("data:;base64,!!!!"); }), HasSubstr("is no base64"));
    std::filesystem::remove_all(folder);
}

TEST(GltfFile, ExtensionsOfTheAppearanceAreAllowed)
{
    for (const char* name :
         {"KHR_materials_unlit", "KHR_materials_transmission", "KHR_texture_transform", "KHR_texture_basisu",
          "EXT_texture_webp", "MSFT_texture_dds", "KHR_lights_punctual", "EXT_lights_image_based",
          "KHR_xmp_json_ld", "MSFT_lod", "FB_ngon_encoding", "EXT_mesh_features", "KHR_materials_variants"}) {
        json file = brick_json();
        file["extensionsUsed"] = file["extensionsRequired"] = {name};
        file["nodes"][0]["extensions"][name] = json::object();
        const ObstacleFile found = imported("a.gltf", file.dump());
        expect_brick(found, 1.0, kSingle);
        EXPECT_THAT(found.warnings, IsEmpty()) << name;
    }
}

TEST(GltfFile, RequiredExtensionsThatAreNotReadAreRefused)
{
    for (const char* name :
         {"EXT_no_such_thing", "EXT_mesh_gpu_instancing", "EXT_meshopt_compression", "KHR_gaussian_splatting",
          "KHR_lightsaber", "materials", "", "ACME_materials_glow", "KHR_materials_displacement"}) {
        json file = brick_json();
        file["extensionsUsed"] = file["extensionsRequired"] = {name};
        const std::string says = fmt::format("it requires the glTF extension '{}', which is not read", name);
        EXPECT_THAT(import_error("a.gltf", file.dump()), HasSubstr(says));
        file["buffers"][0].erase("uri");
        EXPECT_THAT(import_error("a.glb", glb_of(file, mesh_files::gltf_buffer(brick()))), HasSubstr(says));
    }
}

TEST(GltfFile, WhatTheImporterWouldMissIsRefused)
{
    const struct {
        const char* name;
        const char* patch;  // JSON merge patch of the brick's nodes, meshes, ...
        const char* says;
    } cases[] = {
        {"instances",
         R"({"nodes":[{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}}}]})",
         "node 0 places instances of its mesh (EXT_mesh_gpu_instancing)"},
        {"hidden node", R"({"nodes":[{"mesh":0,"extensions":{"KHR_node_visibility":{"visible":false}}}]})",
         "node 0 is hidden"},
        {"morphed node", R"({"nodes":[{"mesh":0,"weights":[0,0.5]}]})",
         "node 0 or its mesh: its weights is [0,0.5]; allowed: 0 finite numbers"},
        {"mode", R"({"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":7}]}]})",
         "its mode is 7; allowed: 0 to 6"},
        {"no positions", R"({"meshes":[{"primitives":[{"attributes":{"NORMAL":0},"indices":1}]}]})",
         "has no positions"},
        {"no accessor", R"({"meshes":[{"primitives":[{"attributes":{"POSITION":5},"indices":1}]}]})",
         "it names element 5 of its accessors, but there are 2"},
        {"no data", R"({"accessors":[{"componentType":5126,"count":8,"type":"VEC3"},
                                     {"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}]})",
         "mesh 0, primitive 0: its accessor 0 has no data"},
        {"type of positions", R"({"accessors":[{"bufferView":0,"componentType":5125,"count":8,"type":"VEC3"},
                                               {"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}]})",
         "its accessor 0 has component type 5125; allowed: 5120, 5121, 5122, 5123, 5126"},
        {"integers beyond their buffer",
         R"({"accessors":[{"bufferView":0,"componentType":5123,"count":99,"type":"VEC3"},
                                                          {"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}]})",
         "its positions: its accessor 0 reaches beyond the end of its buffer"},
        {"wrong types", R"({"meshes":[{"primitives":[3]}]})", "has no positions"},
        {"VEC2", R"({"accessors":[{"bufferView":0,"componentType":5126,"count":8,"type":"VEC2"},
                                  {"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}]})",
         "its accessor 0 has type VEC2; allowed: VEC3"},
        {"signed indices", R"({"accessors":[{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3"},
                                            {"bufferView":1,"componentType":5122,"count":36,"type":"SCALAR"}]})",
         "its accessor 1 has component type 5122; allowed: 5121, 5123, 5125"},
        {"stride", R"({"bufferViews":[{"buffer":0,"byteLength":96,"byteStride":4},
                                      {"buffer":0,"byteOffset":96,"byteLength":72}]})",
         "its accessor 0 has byteStride 4; allowed: at least 12, the size of an element"},
        {"stride 0", R"({"bufferViews":[{"buffer":0,"byteLength":96,"byteStride":0},
                                        {"buffer":0,"byteOffset":96,"byteLength":72}]})",
         "byteStride 0; allowed: at least 12"},
        {"matrix of 12", R"({"nodes":[{"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0]}]})",
         "node 0: its matrix is [1,0,0,0,0,1,0,0,0,0,1,0]; allowed: 16 finite numbers"},
        {"word in a matrix", R"({"nodes":[{"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,"x",0,0,1]}]})",
         "allowed: 16 finite numbers"},
        {"projection", R"({"nodes":[{"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,5,0,0,2]}]})",
         "the last row of its matrix is 0 0 0 2; allowed: 0 0 0 1"},
        {"translation of 2", R"({"nodes":[{"mesh":0,"translation":[5,0]}]})",
         "node 0: its translation is [5,0]; allowed: 3 finite numbers"},
        {"word in a translation", R"({"nodes":[{"mesh":0,"translation":["5",0,0]}]})", "3 finite numbers"},
        {"one scale", R"({"nodes":[{"mesh":0,"scale":2}]})", "its scale is 2; allowed: 3 finite numbers"},
        {"rotation of zeros", R"({"nodes":[{"mesh":0,"rotation":[0,0,0,0]}]})",
         "has length 0; allowed: a quaternion of length 1"},
        {"child of a shown node", R"({"nodes":[{"children":[1]},{"mesh":0,"scale":[1,1]}]})",
         "node 1: its scale"},
    };
    for (const auto& c : cases) {
        json file = brick_json();
        file.merge_patch(json::parse(c.patch));
        EXPECT_THAT(import_error("a.gltf", file.dump()), HasSubstr(c.says)) << c.name;
    }
    json packed = brick_json();
    packed["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0}};
    expect_brick(imported("a.gltf", packed.dump()), 1.0, kSingle);  // its uncompressed data are there
    packed["buffers"][0]["extensions"]["EXT_meshopt_compression"]["fallback"] = true;
    EXPECT_THAT(import_error("a.gltf", packed.dump()), HasSubstr("buffer view 0 is compressed"));
}

TEST(GltfFile, WhatIsLegalIsRead)
{
    const std::pair<const char*, const char*> cases[] = {
        {"weights of a node precede those of its mesh",
         R"({"nodes":[{"mesh":0,"weights":[0]}],
             "meshes":[{"weights":[1],"primitives":[{"attributes":{"POSITION":0},"indices":1,
                                                     "targets":[{"POSITION":0}]}]}]})"},
        {"node that no scene shows", R"({"nodes":[{"mesh":0},{"mesh":0,"weights":[1],"scale":"x"}]})"},
        {"node of another scene", R"({"scenes":[{"nodes":[0]},{"nodes":[1]}],
                                      "nodes":[{"mesh":0},{"mesh":0,"scale":[1]}]})"},
        {"matrix", R"({"nodes":[{"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}]})"},
        {"rounded rotation", R"({"nodes":[{"mesh":0,"rotation":[0,0,0,0.9998]}]})"},
        {"whole numbers", R"({"nodes":[{"mesh":0,"translation":[0,0,0],"scale":[1,1,1]}]})"},
        {"stride of an element", R"({"bufferViews":[{"buffer":0,"byteLength":96,"byteStride":12},
                                                    {"buffer":0,"byteOffset":96,"byteLength":72}]})"},
    };
    for (const auto& [name, patch] : cases) {
        SCOPED_TRACE(name);
        json file = brick_json();
        file.merge_patch(json::parse(patch));
        expect_brick(imported("a.gltf", file.dump()), 1.0, kSingle);
    }
}

TEST(GltfFile, JsonThatNestsDeeplyIsRefused)
{
    const auto nested = [](std::size_t levels) {
        std::string text = brick_json().dump();
        const std::string extras = ",\"extras\":" + std::string(levels, '[') + std::string(levels, ']');
        return text.insert(text.size() - 1, extras);
    };
    expect_brick(imported("a.gltf", nested(100)), 1.0, kSingle);
    EXPECT_THAT(import_error("a.gltf", nested(200'000)), HasSubstr("nests deeper than 200 levels"));
}

TEST(GltfFile, ReferencesArePercentEncoded)
{
    const std::filesystem::path folder =
        std::filesystem::path(::testing::TempDir()) / "arris_gltf_file_percent";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "my buf\u00e9.bin", std::ios::binary) << mesh_files::gltf_buffer(brick());
    const auto import = [&](const std::string& uri) {
        json file = brick_json();
        file["buffers"][0]["uri"] = uri;
        std::ofstream(folder / "a.gltf") << file.dump();
        return import_obstacle((folder / "a.gltf").string(), {}, {});
    };
    for (const char* uri : {"my%20buf%C3%A9.bin", "my buf%c3%a9.bin", "my buf\u00e9.bin"})
        expect_brick(import(uri), 1.0, kSingle);
    EXPECT_THAT(error_of([&] { import("%2e%2e/x.bin"); }), HasSubstr("the mesh's own folder"));
    EXPECT_THAT(error_of([&] { import("100%.bin"); }), HasSubstr("100%.bin"));
    std::filesystem::remove_all(folder);
}

TEST(GltfFile, UnknownExtensionsAreToldOf)
{
    json file = brick_json();
    file["nodes"][0]["extensions"]["ACME_bent"] = json::object();
    file["meshes"][0]["primitives"][0]["extensions"]["ACME_bent"] = json::object();
    const ObstacleFile found = imported("a.gltf", file.dump());
    expect_brick(found, 1.0, kSingle);
    EXPECT_THAT(found.warnings, ElementsAre("the glTF extension 'ACME_bent' (first at node 0) is not read"));
    const std::pair<const char*, const char*> places[] = {
        {R"({"extensions":{"ACME_bent":{}}})", "first at the file itself"},
        {R"({"scenes":[{"nodes":[0],"extensions":{"ACME_bent":{}}}]})", "first at scene 0"},
        {R"({"meshes":[{"extensions":{"ACME_bent":{}},"primitives":[{"attributes":{"POSITION":0},"indices":1}]}]})",
         "first at mesh 0"},
    };
    for (const auto& [patch, says] : places) {
        json other = brick_json();
        other.merge_patch(json::parse(patch));
        EXPECT_THAT(imported("a.gltf", other.dump()).warnings, ElementsAre(HasSubstr(says)));
    }
}

TEST(GltfFile, SparsePositionsAreApplied)
{
    // The brick's last point, (1, 2, 3), is moved from (1, 2, 9), where the buffer has it.
    ObstacleMesh moved = brick();
    int last = 0;
    for (std::size_t p = 0; p < moved.points.size(); ++p)
        if (moved.points[p] == Vec3(1, 2, 3)) last = static_cast<int>(p);
    moved.points[last].z() = 9;
    const std::string buffer = mesh_files::gltf_buffer(moved) +
                               raw(std::vector<std::uint16_t>{static_cast<std::uint16_t>(last), 0}) +
                               raw(std::vector<float>{1, 2, 3});
    json file = json::parse(mesh_files::gltf_json(moved, data_uri(buffer)));
    const std::size_t end = 168;
    file["buffers"][0]["byteLength"] = end + 16;
    file["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", end}, {"byteLength", 2}});
    file["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", end + 4}, {"byteLength", 12}});
    file["accessors"][0]["sparse"] = {{"count", 1},
                                      {"indices", {{"bufferView", 2}, {"componentType", 5123}}},
                                      {"values", {{"bufferView", 3}}}};
    expect_brick(imported("a.gltf", file.dump()), 1.0, kSingle);
}

// The brick as the encoder of Draco 1.5 writes it, without quantization.
constexpr const char* kDracoBrick =
    "RFJBQ08CAgEBAAAACAwACwAAA2+rFAEBEAH/AAABAAkDAAAAAAAAAAAAAAAAAEBAAAAAAAAAAEAAAEBAAAAAAAAAAEAAAAAA"
    "AACAPwAAAEAAAAAAAACAPwAAAEAAAEBAAACAPwAAAAAAAEBAAAAAAAAAAAAAAAAAAACAPwAAAAAAAAAA";

TEST(GltfFile, DracoMeshesAreRead)
{
    json file = brick_json();
    for (json& accessor : file["accessors"]) accessor.erase("bufferView");
    file["bufferViews"] = json::array({{{"buffer", 0}, {"byteLength", 132}}});
    file["buffers"] = json::array(
        {{{"byteLength", 132}, {"uri", std::string("data:application/octet-stream;base64,") + kDracoBrick}}});
    json& primitive = file["meshes"][0]["primitives"][0];
    primitive["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0},
                                                             {"attributes", {{"POSITION", 0}}}};
    file["extensionsUsed"] = file["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    expect_brick(imported("a.gltf", file.dump()), 1.0, kSingle);

    // Its skins and morph targets are compressed, too.
    json skinned = file;
    skinned["skins"] = {{{"joints", {0}}}};
    skinned["nodes"][0]["skin"] = 0;
    const ObstacleFile found = imported("a.gltf", skinned.dump());
    expect_brick(found, 1.0, kSingle);
    EXPECT_THAT(found.warnings, ElementsAre(HasSubstr("node 0 has a skin, which is not applied")));
    file["nodes"][0]["weights"] = {0.5};
    EXPECT_THAT(import_error("a.gltf", file.dump()), HasSubstr("node 0 morphs its mesh (weight 0.5)"));
}

// Four points of a square, drawn in every way, with and without indices.
TEST(GltfFile, EveryModeIsRead)
{
    const struct {
        const char* name;
        int mode;
        std::size_t faces, segments, points;
    } cases[] = {{"points", 0, 0, 0, 4},     {"lines", 1, 0, 2, 0},          {"line loop", 2, 0, 4, 0},
                 {"line strip", 3, 0, 3, 0}, {"triangle strip", 5, 2, 0, 0}, {"triangle fan", 6, 2, 0, 0}};
    const std::string buffer = raw(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}) +
                               raw(std::vector<std::uint16_t>{0, 1, 2, 3});
    for (const auto& c : cases)
        for (const bool has_indices : {false, true}) {
            json primitive = {{"attributes", {{"POSITION", 0}}}, {"mode", c.mode}};
            if (has_indices) primitive["indices"] = 1;
            const json file = {
                {"asset", {{"version", "2.0"}}},
                {"scene", 0},
                {"scenes", {{{"nodes", {0}}}}},
                {"nodes", {{{"mesh", 0}}}},
                {"meshes", {{{"primitives", {primitive}}}}},
                {"accessors",
                 {{{"bufferView", 0}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}},
                  {{"bufferView", 1}, {"componentType", 5123}, {"count", 4}, {"type", "SCALAR"}}}},
                {"bufferViews",
                 {{{"buffer", 0}, {"byteLength", 48}},
                  {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", 8}}}},
                {"buffers", {{{"byteLength", 56}, {"uri", data_uri(buffer)}}}}};
            SCOPED_TRACE(fmt::format("{}, {}", c.name, has_indices));
            const ObstacleFile found = imported("a.gltf", file.dump());
            EXPECT_EQ(found.mesh.faces.size(), c.faces);
            EXPECT_EQ(found.mesh.segments.size(), c.segments);
            EXPECT_EQ(found.mesh.lone_points.size(), c.points);
        }
}

}  // namespace
}  // namespace arris
