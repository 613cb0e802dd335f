// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/gltf/gltf_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/gltf/gltf_document.h"
#include "geometry/obstacle_input/gltf/gltf_figure.h"
#include "geometry/obstacle_input/gltf/gltf_nodes.h"

namespace arris {
namespace {

using nlohmann::json;

constexpr std::size_t kLongestQuote = 60;

constexpr std::array<std::string_view, 2> kRead = {"KHR_draco_mesh_compression", "KHR_mesh_quantization"};

// Vendors whose extensions are known. Their extensions leave shapes as they are if their names go on as
// follows.
constexpr std::array<std::string_view, 14> kVendors = {"KHR",   "EXT",    "MSFT", "ADOBE",  "AGI",
                                                       "ASOBO", "CESIUM", "FB",   "GOOGLE", "MOZ",
                                                       "MX",    "NV",     "VRMC", "WEB3D"};
constexpr std::array<std::string_view, 12> kAppearances = {"materials", "texture",     "lights",  "light",
                                                           "image",     "environment", "xmp",     "audio",
                                                           "animation", "packing",     "sampler", "cameras"};
// Data that a reader of shapes does not need; the node that has MSFT_lod is the finest of its levels.
constexpr std::array<std::string_view, 10> kShapeless = {
    "FB_ngon_encoding",      "CESIUM_primitive_outline", "EXT_mesh_features",
    "EXT_instance_features", "EXT_structural_metadata",  "MSFT_lod",
    "KHR_techniques_webgl",  "KHR_interactivity",        "KHR_node_selectability",
    "KHR_node_hoverability"};

template <class Names>
bool is_in(const Names& names, std::string_view name)
{
    return std::find(names.begin(), names.end(), name) != names.end();
}

bool changes_no_shape(std::string_view name)
{
    if (is_in(kShapeless, name)) return true;
    const std::size_t vendor = name.find('_');
    if (vendor == std::string_view::npos || !is_in(kVendors, name.substr(0, vendor))) return false;
    if (name.find("displacement") != std::string_view::npos) return false;
    const std::string_view rest = name.substr(vendor + 1);
    return std::any_of(kAppearances.begin(), kAppearances.end(), [&](std::string_view word) {
        return rest.starts_with(word) && (rest.size() == word.size() || rest[word.size()] == '_');
    });
}

std::string quote(const json& value)
{
    const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
    return one_line(text.substr(0, kLongestQuote));
}

class GltfCheck {
  public:
    explicit GltfCheck(const json& file) : file_(file), is_packed_(is_packed_gltf(file)) {}

    std::vector<std::string> run()
    {
        for (const json& name : gltf_member(file_, "extensionsRequired")) check_required(quote(name));
        note_unknown(file_, "the file itself");
        for_each("scenes", "scene",
                 [&](const json& scene, const std::string& what) { note_unknown(scene, what); });
        const json& nodes = gltf_member(file_, "nodes");
        for (const std::size_t n : shown_gltf_nodes(file_)) check_node(nodes[n], fmt::format("node {}", n));
        for_each("meshes", "mesh",
                 [&](const json& mesh, const std::string& what) { check_mesh(mesh, what); });
        for_each("bufferViews", "buffer view",
                 [&](const json& view, const std::string& what) { check_view(view, what); });
        for_each("accessors", "accessor",
                 [&](const json& accessor, const std::string& what) { note_unknown(accessor, what); });
        return std::move(warnings_);
    }

  private:
    template <class Action>
    void for_each(const char* array, const char* what, Action action)
    {
        const json& elements = gltf_member(file_, array);
        for (std::size_t i = 0; i < elements.size(); ++i)
            if (elements.is_array()) action(elements[i], fmt::format("{} {}", what, i));
    }

    static void check_required(const std::string& name)
    {
        if (is_in(kRead, name) || changes_no_shape(name)) return;
        throw InputError(fmt::format(
            "it requires the glTF extension '{}', which is not read; allowed: {}, and extensions that "
            "change materials, textures or lights only",
            name, fmt::join(kRead, ", ")));
    }

    void note_unknown(const json& object, const std::string& what)
    {
        const json& extensions = gltf_member(object, "extensions");
        if (!extensions.is_object()) return;
        for (const auto& [name, unused] : extensions.items()) {
            const bool is_known = is_in(kRead, name) || changes_no_shape(name) || is_meshopt(name) ||
                                  name == "KHR_node_visibility";
            if (!is_known && unknown_.insert(name).second)
                warnings_.push_back(
                    fmt::format("the glTF extension '{}' (first at {}) is not read", quote(name), what));
        }
    }

    static bool is_meshopt(std::string_view name)
    {
        return name == "EXT_meshopt_compression" || name == "KHR_meshopt_compression";
    }

    void check_node(const json& node, const std::string& what)
    {
        const json& extensions = gltf_member(node, "extensions");
        if (!gltf_member(extensions, "EXT_mesh_gpu_instancing").is_null())
            throw InputError(what +
                             " places instances of its mesh (EXT_mesh_gpu_instancing), which are not read; "
                             "allowed: one node for each");
        if (gltf_member(gltf_member(extensions, "KHR_node_visibility"), "visible") == false)
            throw InputError(what +
                             " is hidden (KHR_node_visibility), which is not read; allowed: visible nodes");
        check_gltf_placement(node, what);
        if (is_packed_) check_packed(node, what);
        note_unknown(node, what);
    }

    // Skins and morph targets are not read in a file with compressed meshes. Targets move vertices by the
    // weights of the node, or else of its mesh.
    void check_packed(const json& node, const std::string& what)
    {
        const json& mesh = gltf_member(node, "mesh");
        if (mesh.is_null()) return;
        if (!gltf_member(node, "skin").is_null())
            warnings_.push_back(
                what +
                " has a skin, which is not applied in a file with compressed meshes: its mesh "
                "keeps the pose in which it is stored");
        const json& own = gltf_member(node, "weights");
        for (const json& weight :
             own.is_null() ? gltf_member(gltf_element(file_, "meshes", mesh), "weights") : own)
            if (weight != 0)
                throw InputError(
                    fmt::format("{} morphs its mesh (weight {}), which is not read in a file with "
                                "compressed meshes; allowed: weights 0",
                                what, quote(weight)));
    }

    void check_mesh(const json& mesh, const std::string& what)
    {
        note_unknown(mesh, what);
        const json& primitives = gltf_member(mesh, "primitives");
        for (std::size_t i = 0; i < primitives.size(); ++i)
            check_primitive(primitives[i], fmt::format("{}, primitive {}", what, i));
    }

    void check_primitive(const json& primitive, const std::string& what)
    {
        note_unknown(primitive, what);
        constexpr int kTriangleFan = 6;
        const json& mode = gltf_member(primitive, "mode");
        if (!mode.is_null() && (!mode.is_number_unsigned() || mode > kTriangleFan))
            throw InputError(
                fmt::format("{}: its mode is {}; allowed: 0 to {}", what, quote(mode), kTriangleFan));
        const bool is_packed =
            !gltf_member(gltf_member(primitive, "extensions"), "KHR_draco_mesh_compression").is_null();
        const json& position = gltf_member(gltf_member(primitive, "attributes"), "POSITION");
        if (position.is_null()) throw InputError(what + " has no positions");
        require_data(position, is_packed, what);
        require_form(position, "VEC3", {5120, 5121, 5122, 5123, 5126}, what);
        const json& indices = gltf_member(primitive, "indices");
        if (indices.is_null()) return;
        require_data(indices, is_packed, what);
        require_form(indices, "SCALAR", {5121, 5123, 5125}, what);
    }

    // Without its full type the import library takes numbers for others.
    void require_form(const json& index, const char* type, const std::vector<int>& components,
                      const std::string& what) const
    {
        const json& accessor = gltf_element(file_, "accessors", index);
        const std::string told = fmt::format("{}: its accessor {}", what, quote(index));
        if (const json& found = gltf_member(accessor, "type"); found != type)
            throw InputError(fmt::format("{} has type {}; allowed: {}", told, quote(found), type));
        const json& component = gltf_member(accessor, "componentType");
        if (std::find(components.begin(), components.end(), component) == components.end())
            throw InputError(fmt::format("{} has component type {}; allowed: {}", told, quote(component),
                                         fmt::join(components, ", ")));
        const json& view = gltf_member(accessor, "bufferView");
        if (view.is_null()) return;
        const json& stride = gltf_member(gltf_element(file_, "bufferViews", view), "byteStride");
        const int least = size_of(component) * (std::string_view(type) == "VEC3" ? 3 : 1);
        if (!stride.is_null() && (!stride.is_number_unsigned() || stride < least))
            throw InputError(fmt::format("{} has byteStride {}; allowed: at least {}, the size of an element",
                                         told, quote(stride), least));
    }

    static int size_of(const json& component)
    {
        if (component == 5120 || component == 5121) return 1;
        return component == 5122 || component == 5123 ? 2 : 4;
    }

    // Without a buffer view, numbers of an accessor are zero.
    void require_data(const json& index, bool is_packed, const std::string& what) const
    {
        const json& accessor = gltf_element(file_, "accessors", index);
        const bool has_data = is_packed || !gltf_member(accessor, "bufferView").is_null() ||
                              !gltf_member(accessor, "sparse").is_null();
        if (!has_data) throw InputError(fmt::format("{}: its accessor {} has no data", what, quote(index)));
    }

    // Uncompressed data, if any, are in the buffer that the view names.
    void check_view(const json& view, const std::string& what)
    {
        note_unknown(view, what);
        const json& extensions = gltf_member(view, "extensions");
        if (!extensions.is_object()) return;
        const json& index = gltf_member(view, "buffer");
        const json& buffer = gltf_element(file_, "buffers", index);
        // Buffer 0 may be the binary chunk of a .glb file.
        const bool is_empty = gltf_member(buffer, "uri").is_null() && index != 0;
        for (const auto& [name, unused] : extensions.items()) {
            const json& of_buffer = gltf_member(gltf_member(buffer, "extensions"), name.c_str());
            const bool is_fallback = gltf_member(of_buffer, "fallback") == true;
            if (is_meshopt(name) && (is_fallback || is_empty))
                throw InputError(fmt::format(
                    "{} is compressed ({}), which is not read; allowed: uncompressed data", what, name));
        }
    }

    const json& file_;
    bool is_packed_;
    std::set<std::string> unknown_;
    std::vector<std::string> warnings_;
};

}  // namespace

std::vector<std::string> check_gltf(const json& file)
{
    return GltfCheck(file).run();
}

}  // namespace arris
