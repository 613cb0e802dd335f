// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/gltf/gltf_positions.h"

#include <fmt/format.h>

#include <map>
#include <set>

#include "geometry/input_error.h"
#include "geometry/obstacle_input/gltf/gltf_accessors.h"
#include "geometry/obstacle_input/gltf/gltf_document.h"

namespace arris {
namespace {

using nlohmann::json;

class PositionWriter {
  public:
    PositionWriter(GltfDocument& document, const SiblingReader& read_sibling)
        : document_(document), file_(document.json), numbers_(document, read_sibling)
    {
    }

    bool write()
    {
        const std::set<std::size_t> accessors = find_integers();
        if (accessors.empty()) return false;
        std::map<std::size_t, std::string> floats;
        for (const std::size_t a : accessors) floats[a] = decode(a);
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
                if (gltf_member(accessor, "componentType") == kGltfSingle) continue;
                if (!gltf_member(gltf_member(primitive, "extensions"), "KHR_draco_mesh_compression")
                         .is_null())
                    throw InputError(
                        fmt::format("accessor {}: positions that are integers are not read where they "
                                    "are compressed; allowed: floats (component type {})",
                                    index.get<std::size_t>(), kGltfSingle));
                found.insert(index.get<std::size_t>());
            }
        return found;
    }

    // Positions of an accessor as the bytes of floats.
    std::string decode(std::size_t accessor)
    {
        const GltfForm form = {"VEC3", {kGltfByte, kGltfUnsignedByte, kGltfShort, kGltfUnsignedShort}};
        std::string floats;
        for (const double number : numbers_.read(accessor, form, "its positions")) {
            const auto value = static_cast<float>(number);
            floats.append(reinterpret_cast<const char*>(&value), sizeof value);
        }
        return floats;
    }

    // Makes buffer 0 the binary chunk.
    void make_room()
    {
        json& buffers = file_["buffers"];
        if (!buffers[0].contains("uri")) return;
        for (json& view : file_["bufferViews"]) view["buffer"] = view["buffer"].get<std::size_t>() + 1;
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
        accessor["componentType"] = kGltfSingle;
        for (const char* name : {"normalized", "min", "max", "sparse"}) accessor.erase(name);
    }

    GltfDocument& document_;
    json& file_;
    GltfAccessors numbers_;
};

}  // namespace

bool write_positions_as_floats(GltfDocument& document, const SiblingReader& read_sibling)
{
    return PositionWriter(document, read_sibling).write();
}

}  // namespace arris
