// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/formats/gltf_positions.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/archive/iterators/binary_from_base64.hpp>
#include <boost/archive/iterators/dataflow_exception.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <string_view>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/formats/gltf_document.h"

namespace arris {
namespace {

using nlohmann::json;

constexpr int kFloat = 5126;

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
float number_at(const char* bytes, bool is_normalized)
{
    Number number;
    std::memcpy(&number, bytes, sizeof number);
    const float value = static_cast<float>(number);
    if (!is_normalized) return value;
    return std::max(value / static_cast<float>(std::numeric_limits<Number>::max()), -1.0f);
}

struct Component {
    std::size_t size;
    float (*read)(const char*, bool);
};

class PositionWriter {
  public:
    PositionWriter(GltfDocument& document, const SiblingReader& read_sibling)
        : document_(document), file_(document.json), read_sibling_(read_sibling)
    {
    }

    bool write()
    {
        const std::set<std::size_t> accessors = find_integers();
        if (accessors.empty()) return false;
        std::map<std::size_t, std::string> floats;
        for (const std::size_t a : accessors) floats[a] = decode(file_["accessors"][a], a);
        make_room();
        for (const auto& [a, bytes] : floats) store(file_["accessors"][a], bytes);
        file_["buffers"][0]["byteLength"] = document_.chunk.size();
        return true;
    }

  private:
    std::set<std::size_t> find_integers() const
    {
        std::set<std::size_t> found;
        for (const json& mesh : gltf_member(file_, "meshes"))
            for (const json& primitive : gltf_member(mesh, "primitives")) {
                const json& index = gltf_member(gltf_member(primitive, "attributes"), "POSITION");
                const json& accessor = gltf_element(file_, "accessors", index);
                if (gltf_member(accessor, "componentType") == kFloat) continue;
                const bool is_packed =
                    !gltf_member(gltf_member(primitive, "extensions"), "KHR_draco_mesh_compression")
                         .is_null();
                if (is_packed || !gltf_member(accessor, "sparse").is_null())
                    throw InputError(
                        fmt::format("accessor {}: positions that are integers are not read where they "
                                    "are sparse or compressed; allowed: floats (component type {})",
                                    index.get<std::size_t>(), kFloat));
                found.insert(index.get<std::size_t>());
            }
        return found;
    }

    static Component component_of(const json& type, std::size_t accessor)
    {
        if (type == 5120) return {1, number_at<std::int8_t>};
        if (type == 5121) return {1, number_at<std::uint8_t>};
        if (type == 5122) return {2, number_at<std::int16_t>};
        if (type == 5123) return {2, number_at<std::uint16_t>};
        throw InputError(one_line(
            fmt::format("accessor {}: its positions have component type {}; allowed: 5120 to 5123 and 5126",
                        accessor, type.dump())));
    }

    // Positions of an accessor as the bytes of floats.
    std::string decode(const json& accessor, std::size_t number)
    {
        if (gltf_member(accessor, "type") != "VEC3")
            throw InputError(fmt::format("accessor {}: its positions are no VEC3", number));
        const Component component = component_of(gltf_member(accessor, "componentType"), number);
        const json& view = gltf_element(file_, "bufferViews", gltf_member(accessor, "bufferView"));
        const std::string& buffer = buffer_bytes(gltf_member(view, "buffer"));
        const std::uint64_t count = whole_number(accessor, "count", 0);
        const std::uint64_t stride = whole_number(view, "byteStride", 3 * component.size);
        const std::uint64_t offset = whole_number(accessor, "byteOffset", 0);
        const std::uint64_t start = whole_number(view, "byteOffset", 0);
        const std::uint64_t length = whole_number(view, "byteLength", 0);
        const std::uint64_t needed = count == 0 ? 0 : offset + (count - 1) * stride + 3 * component.size;
        if (needed > length || start + length > buffer.size())
            throw InputError(
                fmt::format("accessor {}: its positions reach beyond the end of their buffer", number));
        const bool is_normalized = gltf_member(accessor, "normalized") == true;
        std::string floats(count * 3 * sizeof(float), '\0');
        for (std::uint64_t i = 0; i < count; ++i)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const char* at = buffer.data() + start + offset + i * stride + axis * component.size;
                const float value = component.read(at, is_normalized);
                std::memcpy(floats.data() + (3 * i + axis) * sizeof(float), &value, sizeof(float));
            }
        return floats;
    }

    const std::string& buffer_bytes(const json& index)
    {
        const json& uri = gltf_member(gltf_element(file_, "buffers", index), "uri");
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

    // Makes buffer 0 the binary chunk.
    void make_room()
    {
        json& buffers = file_["buffers"];
        if (!buffers[0].contains("uri")) return;
        for (json& view : file_["bufferViews"]) view["buffer"] = whole_number(view, "buffer", 0) + 1;
        buffers.insert(buffers.begin(), json::object({{"byteLength", 0}}));
    }

    void store(json& accessor, const std::string& floats)
    {
        document_.chunk.resize((document_.chunk.size() + sizeof(float) - 1) / sizeof(float) * sizeof(float),
                               '\0');
        json& views = file_["bufferViews"];
        views.push_back(
            {{"buffer", 0}, {"byteOffset", document_.chunk.size()}, {"byteLength", floats.size()}});
        document_.chunk += floats;
        accessor["bufferView"] = views.size() - 1;
        accessor["byteOffset"] = 0;
        accessor["componentType"] = kFloat;
        for (const char* name : {"normalized", "min", "max"}) accessor.erase(name);
    }

    GltfDocument& document_;
    json& file_;
    const SiblingReader& read_sibling_;
    std::map<std::size_t, std::string> buffers_;  // by index
};

}  // namespace

bool write_positions_as_floats(GltfDocument& document, const SiblingReader& read_sibling)
{
    return PositionWriter(document, read_sibling).write();
}

}  // namespace arris
