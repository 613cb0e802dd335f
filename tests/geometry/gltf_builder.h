// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// Writes a glTF 2 file part by part, from the format's description.
struct GltfBuilder {
    nlohmann::json json = {{"asset", {{"version", "2.0"}}},
                           {"scene", 0},
                           {"scenes", {{{"nodes", nlohmann::json::array()}}}},
                           {"buffers", {{{"byteLength", 0}}}}};
    std::string chunk;

    /// Appends an element to an array of the document; returns its index.
    std::size_t add(const char* array, const nlohmann::json& element)
    {
        json[array].push_back(element);
        return json[array].size() - 1;
    }

    void show(std::size_t node) { json["scenes"][0]["nodes"].push_back(node); }

    template <class Number>
    std::size_t add_view(const std::vector<Number>& numbers)
    {
        chunk.resize((chunk.size() + 3) / 4 * 4, '\0');
        const std::size_t offset = chunk.size(), length = numbers.size() * sizeof(Number);
        chunk.append(reinterpret_cast<const char*>(numbers.data()), length);
        json["buffers"][0]["byteLength"] = chunk.size();
        return add("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", length}});
    }

    /// An accessor of numbers.
    template <class Number>
    std::size_t add_numbers(const char* type, const std::vector<Number>& numbers, bool is_normalized = false)
    {
        const std::map<std::string, std::size_t> columns = {
            {"SCALAR", 1}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
        nlohmann::json accessor = {{"bufferView", add_view(numbers)},
                                   {"componentType", component_type(Number())},
                                   {"count", numbers.size() / columns.at(type)},
                                   {"type", type}};
        if (is_normalized) accessor["normalized"] = true;
        return add("accessors", accessor);
    }

    std::size_t add_points(const std::vector<Vec3>& points)
    {
        std::vector<float> numbers;
        Vec3 low = points.at(0), high = low;
        for (const Vec3& p : points) {
            for (const double c : p) numbers.push_back(static_cast<float>(c));
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
        const std::size_t accessor = add_numbers("VEC3", numbers);
        json["accessors"][accessor]["min"] = {low.x(), low.y(), low.z()};
        json["accessors"][accessor]["max"] = {high.x(), high.y(), high.z()};
        return accessor;
    }

    /// A mesh of one primitive of triangles.
    std::size_t add_mesh(const std::vector<Vec3>& points, const std::vector<std::uint16_t>& corners,
                         nlohmann::json attributes = nlohmann::json::object())
    {
        attributes["POSITION"] = add_points(points);
        const std::size_t indices = add_numbers("SCALAR", corners);
        return add("meshes", {{"primitives", {{{"attributes", attributes}, {"indices", indices}}}}});
    }

    /// A sampler of the last animation, and a channel that it moves.
    std::size_t animate(std::size_t node, const char* path, const std::vector<float>& times,
                        const std::vector<float>& values, const char* interpolation = "LINEAR")
    {
        if (!json.contains("animations")) add("animations", {{"name", "walk"}});
        nlohmann::json& animation = json["animations"].back();
        const std::string what = path;
        const char* type = what == "weights" ? "SCALAR" : what == "rotation" ? "VEC4" : "VEC3";
        const std::size_t input = add_numbers("SCALAR", times), output = add_numbers(type, values);
        animation["samplers"].push_back(
            {{"input", input}, {"output", output}, {"interpolation", interpolation}});
        animation["channels"].push_back(
            {{"sampler", animation["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
        return animation["channels"].size() - 1;
    }

    /// The document as a reader has it: whole numbers are unsigned.
    nlohmann::json parsed() const { return nlohmann::json::parse(json.dump()); }

    std::string glb() const
    {
        std::string text = json.dump(), binary = chunk;
        text.resize((text.size() + 3) / 4 * 4, ' ');
        binary.resize((binary.size() + 3) / 4 * 4, '\0');
        const auto number = [](std::size_t n) {
            const auto word = static_cast<std::uint32_t>(n);
            return std::string(reinterpret_cast<const char*>(&word), sizeof word);
        };
        return "glTF" + number(2) + number(28 + text.size() + binary.size()) + number(text.size()) + "JSON" +
               text + number(binary.size()) + std::string("BIN\0", 4) + binary;
    }

  private:
    static int component_type(std::int8_t) { return 5120; }
    static int component_type(std::uint8_t) { return 5121; }
    static int component_type(std::int16_t) { return 5122; }
    static int component_type(std::uint16_t) { return 5123; }
    static int component_type(std::uint32_t) { return 5125; }
    static int component_type(float) { return 5126; }
};

/// Four points of a tetrahedron, and its faces.
inline const std::vector<Vec3> kTetrahedron = {{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, 0.5, 1}};
inline const std::vector<std::uint16_t> kTetrahedronCorners = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

/// A tetrahedron with a skin of two joints: node 0 at the origin, and node 1, its child at x = 1, which the
/// animation turns from 0 to 90 degrees about z in a second. Vertex 0 follows the first joint, vertex 1 the
/// second, the others both alike. Node 2 has the mesh, and a placement that does nothing.
inline GltfBuilder make_bent_tetrahedron()
{
    GltfBuilder file;
    const std::size_t joints =
        file.add_numbers("VEC4", std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0});
    const std::size_t weights =
        file.add_numbers("VEC4", std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 0.5, 0.5, 0, 0, 0.5, 0.5, 0, 0});
    const std::size_t mesh =
        file.add_mesh(kTetrahedron, kTetrahedronCorners, {{"JOINTS_0", joints}, {"WEIGHTS_0", weights}});
    std::vector<float> inverse = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,
                                  1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1};
    const std::size_t root = file.add("nodes", {{"children", {1}}});
    const std::size_t tip = file.add("nodes", {{"translation", {1, 0, 0}}});
    file.add("skins", {{"joints", {root, tip}}, {"inverseBindMatrices", file.add_numbers("MAT4", inverse)}});
    const std::size_t body = file.add("nodes", {{"mesh", mesh}, {"skin", 0}, {"translation", {50, 60, 70}}});
    file.show(root);
    file.show(body);
    const float half = std::sqrt(0.5F);
    file.animate(tip, "rotation", {0, 1}, {0, 0, 0, 1, 0, 0, half, half});
    return file;
}

}  // namespace arris
