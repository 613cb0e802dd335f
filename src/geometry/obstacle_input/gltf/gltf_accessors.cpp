// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/gltf/gltf_accessors.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/archive/iterators/binary_from_base64.hpp>
#include <boost/archive/iterators/dataflow_exception.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/formats/mesh_file_limits.h"
#include "geometry/obstacle_input/gltf/gltf_document.h"

namespace arris {
namespace {

using nlohmann::json;

// Elements of an accessor: vertices of the largest mesh. An accessor without data costs no byte of the file.
constexpr std::uint64_t kMostElements = 3 * kMostFaces;

std::string decode_base64(std::string_view text)
{
    namespace it = boost::archive::iterators;
    using Decoder = it::transform_width<it::binary_from_base64<std::string_view::const_iterator>, 8, 6>;
    text = text.substr(0, text.find_last_not_of('=') + 1);
    const std::size_t size = text.size() * 6 / 8;
    try {
        // An incomplete last group holds no byte.
        std::string bytes;
        bytes.reserve(size);
        for (Decoder next(text.begin()); bytes.size() < size; ++next) bytes.push_back(*next);
        return bytes;
    } catch (const it::dataflow_exception&) {
        throw InputError("the data URI of a buffer is no base64");
    }
}

std::uint64_t whole_number(const json& object, const char* name, std::uint64_t otherwise)
{
    const json& value = gltf_member(object, name);
    if (value.is_null()) return otherwise;
    if (!value.is_number_unsigned() || value > std::numeric_limits<std::uint32_t>::max())
        throw InputError(one_line(
            fmt::format("its {} is {}; allowed: a whole number of at most 32 bits", name, value.dump())));
    return value;
}

template <class Number>
double number_at(const char* bytes, bool is_normalized)
{
    Number number;
    std::memcpy(&number, bytes, sizeof number);
    const auto value = static_cast<double>(number);
    if (!is_normalized || std::is_floating_point_v<Number>) return value;
    return std::max(value / static_cast<double>(std::numeric_limits<Number>::max()), -1.0);
}

struct Component {
    std::size_t size = 0;
    double (*read)(const char*, bool) = nullptr;
};

Component component_of(int type)
{
    switch (type) {
        case kGltfByte:
            return {1, number_at<std::int8_t>};
        case kGltfUnsignedByte:
            return {1, number_at<std::uint8_t>};
        case kGltfShort:
            return {2, number_at<std::int16_t>};
        case kGltfUnsignedShort:
            return {2, number_at<std::uint16_t>};
        case kGltfUnsignedInt:
            return {4, number_at<std::uint32_t>};
        default:
            return {4, number_at<float>};
    }
}

std::size_t columns_of(std::string_view type)
{
    return type == "SCALAR" ? 1 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
}

int component_type(const json& object, const std::vector<int>& allowed, const std::string& what)
{
    const json& type = gltf_member(object, "componentType");
    if (!type.is_number_integer() || std::find(allowed.begin(), allowed.end(), type) == allowed.end())
        throw InputError(one_line(fmt::format("{} has component type {}; allowed: {}", what, type.dump(),
                                              fmt::join(allowed, ", "))));
    return type;
}

}  // namespace

struct GltfAccessors::Layout {
    std::uint64_t count = 0;  ///< of elements
    std::size_t columns = 1;  ///< numbers of an element
    Component component;
    bool is_normalized = false;
};

GltfAccessors::GltfAccessors(const GltfDocument& document, SiblingReader read_sibling)
    : document_(document), read_sibling_(std::move(read_sibling))
{
}

std::vector<double> GltfAccessors::read(const json& index, const GltfForm& form, const std::string& what)
{
    const json& accessor = gltf_element(document_.json, "accessors", index);
    const std::string named = fmt::format("{}: its accessor {}", what, index.get<std::size_t>());
    if (const json& type = gltf_member(accessor, "type"); type != form.type)
        throw InputError(
            one_line(fmt::format("{} has type {}; allowed: {}", named, excerpt(type.dump()), form.type)));
    Layout layout;
    layout.columns = columns_of(form.type);
    layout.component = component_of(component_type(accessor, form.components, named));
    layout.count = whole_number(accessor, "count", 0);
    layout.is_normalized = gltf_member(accessor, "normalized") == true;
    if (layout.count > kMostElements)
        throw InputError(
            fmt::format("{} has {} elements; allowed: at most {}", named, layout.count, kMostElements));

    const json& view = gltf_member(accessor, "bufferView");
    std::vector<double> numbers;
    if (view.is_null())
        numbers.assign(layout.count * layout.columns, 0.0);
    else
        read_dense(view, whole_number(accessor, "byteOffset", 0), layout, numbers, named);
    if (const json& sparse = gltf_member(accessor, "sparse"); !sparse.is_null())
        apply_sparse(sparse, layout, numbers, named);
    for (std::size_t k = 0; k < numbers.size(); ++k)
        if (!std::isfinite(numbers[k]))
            throw InputError(fmt::format("{} holds {} in element {}; allowed: finite numbers", named,
                                         numbers[k], k / layout.columns));
    return numbers;
}

void GltfAccessors::read_dense(const json& index, std::uint64_t offset, const Layout& layout,
                               std::vector<double>& numbers, const std::string& what)
{
    const json& view = gltf_element(document_.json, "bufferViews", index);
    const std::string& bytes = buffer(gltf_member(view, "buffer"));
    const std::size_t element = layout.columns * layout.component.size;
    const std::uint64_t stride = whole_number(view, "byteStride", element);
    const std::uint64_t start = whole_number(view, "byteOffset", 0);
    const std::uint64_t length = whole_number(view, "byteLength", 0);
    const std::uint64_t needed = layout.count == 0 ? 0 : offset + (layout.count - 1) * stride + element;
    if (stride < element)
        throw InputError(fmt::format("{} has byteStride {}; allowed: at least {}, the size of an element",
                                     what, stride, element));
    if (needed > length || start + length > bytes.size())
        throw InputError(what + " reaches beyond the end of its buffer");
    numbers.resize(layout.count * layout.columns);
    for (std::uint64_t i = 0; i < layout.count; ++i) {
        const char* at = bytes.data() + start + offset + i * stride;
        for (std::size_t k = 0; k < layout.columns; ++k, at += layout.component.size)
            numbers[i * layout.columns + k] = layout.component.read(at, layout.is_normalized);
    }
}

void GltfAccessors::apply_sparse(const json& sparse, const Layout& layout, std::vector<double>& numbers,
                                 const std::string& what)
{
    const json &places = gltf_member(sparse, "indices"), &values = gltf_member(sparse, "values");
    Layout of_values = layout, of_places;
    of_places.count = of_values.count = whole_number(sparse, "count", 0);
    if (of_places.count > layout.count)
        throw InputError(fmt::format("{} has {} sparse elements; allowed: at most {}", what, of_places.count,
                                     layout.count));
    of_places.component =
        component_of(component_type(places, {kGltfUnsignedByte, kGltfUnsignedShort, kGltfUnsignedInt}, what));
    std::vector<double> indices, elements;
    read_dense(gltf_member(places, "bufferView"), whole_number(places, "byteOffset", 0), of_places, indices,
               what);
    read_dense(gltf_member(values, "bufferView"), whole_number(values, "byteOffset", 0), of_values, elements,
               what);
    for (std::size_t i = 0; i < indices.size(); ++i) {
        if (!(indices[i] < static_cast<double>(layout.count)))
            throw InputError(fmt::format("{} names element {} in a sparse index, but there are {}", what,
                                         indices[i], layout.count));
        std::copy_n(&elements[i * layout.columns], layout.columns,
                    &numbers[static_cast<std::size_t>(indices[i]) * layout.columns]);
    }
}

const std::string& GltfAccessors::buffer(const json& index)
{
    const json& uri = gltf_member(gltf_element(document_.json, "buffers", index), "uri");
    if (uri.is_null() && index == 0) return document_.chunk;
    const auto [found, is_new] = buffers_.try_emplace(index.get<std::size_t>());
    if (!is_new) return found->second;
    if (!uri.is_string())
        throw InputError(fmt::format("its buffer {} has no data", index.get<std::size_t>()));
    const std::string name = uri;
    if (!name.starts_with("data:")) return found->second = read_sibling_(name);
    constexpr std::string_view kMark = ";base64,";
    const std::size_t mark = name.find(kMark);
    if (mark == std::string::npos) throw InputError("the data URI of a buffer is no base64");
    return found->second = decode_base64(std::string_view(name).substr(mark + kMark.size()));
}

}  // namespace arris
