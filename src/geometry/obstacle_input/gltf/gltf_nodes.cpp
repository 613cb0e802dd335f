// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/gltf/gltf_nodes.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <vector>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/gltf/gltf_document.h"
#include "geometry/tolerances.h"

namespace arris {
namespace {

using nlohmann::json;

std::optional<std::size_t> index_of(const json& value, const json& elements)
{
    if (!value.is_number_unsigned() || value.get<std::size_t>() >= elements.size()) return std::nullopt;
    return value.get<std::size_t>();
}

}  // namespace

std::set<std::size_t> shown_gltf_nodes(const json& file)
{
    const json& nodes = gltf_member(file, "nodes");
    const json& scenes = gltf_member(file, "scenes");
    std::set<std::size_t> shown;
    if (!scenes.is_array() || scenes.empty()) {
        for (std::size_t n = 0; n < nodes.size(); ++n) shown.insert(n);
        return shown;
    }
    const auto scene = index_of(gltf_member(file, "scene"), scenes);
    std::vector<const json*> lists = {&gltf_member(scenes[scene.value_or(0)], "nodes")};
    // Each node's children are taken once, also where nodes refer to each other in a circle.
    for (std::size_t next = 0; next < lists.size(); ++next)
        for (const json& value : *lists[next])
            if (const auto n = index_of(value, nodes); n && shown.insert(*n).second)
                lists.push_back(&gltf_member(nodes[*n], "children"));
    return shown;
}

std::vector<double> gltf_numbers(const json& node, const char* name, std::size_t count,
                                 const std::string& what)
{
    const json& value = gltf_member(node, name);
    if (value.is_null()) return {};
    bool is_right = value.is_array() && value.size() == count;
    std::vector<double> numbers;
    for (std::size_t k = 0; is_right && k < count; ++k) {
        is_right = value[k].is_number() && std::isfinite(value[k].get<double>());
        if (is_right) numbers.push_back(value[k].get<double>());
    }
    if (!is_right)
        throw InputError(fmt::format("{}: its {} is {}; allowed: {} finite numbers", what, name,
                                     one_line(excerpt(value.dump())), count));
    return numbers;
}

void check_gltf_placement(const json& node, const std::string& what)
{
    const std::vector<double> matrix = gltf_numbers(node, "matrix", 16, what);
    const std::vector<double> rotation = gltf_numbers(node, "rotation", 4, what);
    gltf_numbers(node, "translation", 3, what);
    gltf_numbers(node, "scale", 3, what);
    if (!matrix.empty()) {
        // Columns follow each other.
        const double wrong =
            std::abs(matrix[3]) + std::abs(matrix[7]) + std::abs(matrix[11]) + std::abs(matrix[15] - 1.0);
        if (wrong > kThreeDigits)
            throw InputError(fmt::format("{}: the last row of its matrix is {} {} {} {}; allowed: 0 0 0 1",
                                         what, matrix[3], matrix[7], matrix[11], matrix[15]));
    }
    if (!rotation.empty()) {
        const double length =
            std::hypot(std::hypot(rotation[0], rotation[1]), std::hypot(rotation[2], rotation[3]));
        if (!(std::abs(length - 1.0) <= kThreeDigits))
            throw InputError(fmt::format(
                "{}: its rotation {} {} {} {} has length {:.3g}; allowed: a quaternion of length 1", what,
                rotation[0], rotation[1], rotation[2], rotation[3], length));
    }
}

}  // namespace arris
