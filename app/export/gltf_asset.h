// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/export/float_value.h"
#include "app/text/version.h"
#include "geometry/vectors.h"

namespace arris {

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie in memory");

// Numbers of glTF 2.0: component types, modes of primitives, targets of buffer views.
inline constexpr int kGltfFloat = 5126, kGltfUnsigned = 5125;              // component types
inline constexpr int kGltfPoints = 0, kGltfLines = 1, kGltfTriangles = 4;  // primitive modes
inline constexpr int kGltfVertexArray = 34962, kGltfIndexArray = 34963;    // targets of buffer views

using Float3 = std::array<float, 3>;

/// `value`, of `vertex` in a frame, as floats. Throws InputError naming `path` if it is too large for them.
inline Float3 to_float3(const std::string& path, std::size_t frame, std::size_t vertex, const Vec3& value)
{
    const auto at = [&](int k) { return float_value(path, frame, vertex, value[k]); };
    return {at(0), at(1), at(2)};
}

inline std::string_view bytes_of(const std::vector<Float3>& values)
{
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Float3)};
}

/// The vertices of cells, one after the other.
std::vector<std::uint32_t> to_indices(const auto& cells)
{
    std::vector<std::uint32_t> indices;
    for (const auto& cell : cells)
        for (const int v : cell) indices.push_back(static_cast<std::uint32_t>(v));
    return indices;
}

struct GltfBounds {
    Float3 min, max;
};

/// `positions` must not be empty.
inline GltfBounds find_gltf_bounds(const std::vector<Float3>& positions)
{
    GltfBounds bounds{positions.front(), positions.front()};
    for (const Float3& x : positions)
        for (int k = 0; k < 3; ++k) {
            bounds.min[k] = std::min(bounds.min[k], x[k]);
            bounds.max[k] = std::max(bounds.max[k], x[k]);
        }
    return bounds;
}

/// The shape of a mesh in the first frame, and its differences from that in the others: morph targets.
struct GltfShapes {
    nlohmann::ordered_json attributes, targets = nlohmann::ordered_json::array(),
                                       names = nlohmann::ordered_json::array();
};

/// A glTF file as it is put together: its JSON, and the arrays that are known before frames are streamed.
struct GltfAsset {
    nlohmann::ordered_json json = {
        {"asset", {{"version", "2.0"}, {"generator", std::string("arris ") + kVersion}}}};
    std::string fixed;
    std::uint64_t streamed = 0;     ///< bytes after the fixed arrays
    std::size_t streamed_view = 0;  ///< the buffer view of them

    /// Adds bytes of the fixed arrays; returns the view's index.
    template <class Value>
    std::size_t add_view(const std::vector<Value>& values, int target)
    {
        nlohmann::ordered_json view = {
            {"buffer", 0}, {"byteOffset", fixed.size()}, {"byteLength", values.size() * sizeof(Value)}};
        if (target != 0) view["target"] = target;
        fixed.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
        return append("bufferViews", std::move(view));
    }

    /// Adds an array of values of `type` ("SCALAR", "VEC3", ...); returns the accessor's index.
    template <class Value>
    std::size_t add(const char* type, int component, const std::vector<Value>& values, int target = 0)
    {
        return append("accessors", {{"bufferView", add_view(values, target)},
                                    {"componentType", component},
                                    {"count", values.size()},
                                    {"type", type}});
    }

    /// As add, with the bounds that glTF requires of positions.
    std::size_t add_positions(const std::vector<Float3>& positions)
    {
        const std::size_t index = add("VEC3", kGltfFloat, positions, kGltfVertexArray);
        set_bounds(index, find_gltf_bounds(positions));
        return index;
    }

    /// Opens the view of streamed arrays, all of vectors.
    void begin_streamed()
    {
        streamed_view = append("bufferViews", {{"buffer", 0}, {"byteStride", sizeof(Float3)}});
    }

    /// Sets the size of that view, and its place behind the fixed arrays, when all are known.
    void end_streamed()
    {
        nlohmann::ordered_json& view = json["bufferViews"][streamed_view];
        view["byteLength"] = streamed;
        view["target"] = kGltfVertexArray;
        view["byteOffset"] = fixed.size();
    }

    /// Describes shapes of `frame_count` frames that are streamed next, for each frame the attributes of
    /// `names` in their order, each of `count` vectors. `positions(i)` are those of frame i, less the first.
    template <class Positions>
    GltfShapes add_shapes(std::size_t frame_count, std::size_t count,
                          std::initializer_list<const char*> names, const Positions& positions)
    {
        GltfShapes shapes;
        for (std::size_t i = 0; i < frame_count; ++i) {
            nlohmann::ordered_json attribute;
            for (const char* name : names) {
                attribute[name] = append("accessors", {{"bufferView", streamed_view},
                                                       {"byteOffset", streamed},
                                                       {"componentType", kGltfFloat},
                                                       {"count", count},
                                                       {"type", "VEC3"}});
                streamed += count * sizeof(Float3);
            }
            set_bounds(attribute["POSITION"], find_gltf_bounds(positions(i)));
            if (i == 0) {
                shapes.attributes = attribute;
                continue;
            }
            shapes.targets.push_back(attribute);
            shapes.names.push_back("frame " + std::to_string(i));
        }
        return shapes;
    }

    /// Adds a mesh of `primitives`, which `shapes` morph.
    std::size_t add_mesh(const std::string& name, nlohmann::ordered_json primitives, const GltfShapes& shapes)
    {
        if (shapes.targets.empty()) return append("meshes", {{"name", name}, {"primitives", primitives}});
        for (nlohmann::ordered_json& primitive : primitives) primitive["targets"] = shapes.targets;
        return append("meshes", {{"name", name},
                                 {"primitives", primitives},
                                 {"weights", std::vector<double>(shapes.targets.size(), 0.0)},
                                 {"extras", {{"targetNames", shapes.names}}}});
    }

    void set_bounds(std::size_t accessor, const GltfBounds& bounds)
    {
        json["accessors"][accessor]["min"] = bounds.min;
        json["accessors"][accessor]["max"] = bounds.max;
    }

    /// Adds to a list of the JSON; returns the item's index.
    std::size_t append(const char* list, nlohmann::ordered_json item)
    {
        json[list].push_back(std::move(item));
        return json[list].size() - 1;
    }

    /// Moves `path` of a node: accessors of times (s) and of values.
    void add_channel(std::size_t times, std::size_t output, std::size_t node, const char* path)
    {
        nlohmann::ordered_json& animation = json["animations"][0];
        animation["name"] = "run";
        animation["samplers"].push_back({{"input", times}, {"output", output}, {"interpolation", "LINEAR"}});
        animation["channels"].push_back(
            {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
    }
};

}  // namespace arris
