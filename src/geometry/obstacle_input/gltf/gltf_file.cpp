// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/gltf/gltf_file.h"

#include <fmt/format.h>

#include <assimp/IOStream.hpp>
#include <initializer_list>
#include <memory>
#include <utility>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/formats/mesh_folder_io.h"
#include "geometry/obstacle_input/formats/percent_code.h"
#include "geometry/obstacle_input/gltf/gltf_check.h"
#include "geometry/obstacle_input/gltf/gltf_document.h"
#include "geometry/obstacle_input/gltf/gltf_positions.h"

namespace arris {
namespace {

std::string read_sibling(const std::filesystem::path& folder, const std::string& name)
{
    const std::string no_main;
    MeshFolderIo files("", no_main, folder);
    const std::unique_ptr<Assimp::IOStream> stream(files.Open(name.c_str(), "rb"));
    if (stream == nullptr)
        throw InputError(files.refusals().empty() ? fmt::format("'{}' cannot be read", one_line(name))
                                                  : one_line(files.refusals().front()));
    std::string bytes(stream->FileSize(), '\0');
    stream->Read(bytes.data(), 1, bytes.size());
    return bytes;
}

// References of buffers to other files are percent-encoded, which the import library does not know. Returns
// whether any was.
bool decode_references(nlohmann::json& file)
{
    bool is_changed = false;
    if (!gltf_member(file, "buffers").is_array()) return false;
    for (nlohmann::json& buffer : file["buffers"]) {
        const nlohmann::json& uri = gltf_member(buffer, "uri");
        if (!uri.is_string()) continue;
        const std::string name = uri;
        if (name.starts_with("data:") || name.find('%') == std::string::npos) continue;
        buffer["uri"] = percent_decoded(name);
        is_changed = true;
    }
    return is_changed;
}

/// Removes members from each object of an array, if both are there. Returns whether there was any.
bool remove_members(nlohmann::json& owner, const char* array, std::initializer_list<const char*> names)
{
    bool is_changed = false;
    if (!gltf_member(owner, array).is_array()) return is_changed;
    for (nlohmann::json& object : owner[array])
        for (const char* name : names)
            if (object.is_object() && object.erase(name) > 0) is_changed = true;
    return is_changed;
}

/// Takes away what moves vertices, which the import library does not need: damaged skins crash it. Returns
/// whether there was any.
bool remove_motion(nlohmann::json& file)
{
    bool is_changed = file.erase("animations") + file.erase("skins") > 0;
    is_changed = remove_members(file, "nodes", {"skin", "weights"}) || is_changed;
    is_changed = remove_members(file, "meshes", {"weights"}) || is_changed;
    if (!gltf_member(file, "meshes").is_array()) return is_changed;
    for (nlohmann::json& mesh : file["meshes"])
        is_changed = remove_members(mesh, "primitives", {"targets"}) || is_changed;
    return is_changed;
}

/// A file that is checked, with references to other files as they are named.
GltfDocument read_checked(bool is_binary, std::string_view bytes, std::vector<std::string>& warnings,
                          bool& is_decoded)
{
    GltfDocument document = read_gltf(is_binary, bytes);
    warnings = check_gltf(document.json);
    is_decoded = decode_references(document.json);
    return document;
}

SiblingReader reader_in(const std::filesystem::path& folder)
{
    return [folder](const std::string& name) { return read_sibling(folder, name); };
}

[[noreturn]] void refuse(const nlohmann::json::exception& error)
{
    throw InputError(one_line(std::string("its JSON is no glTF: ") + error.what()));
}

}  // namespace

GltfFile prepare_gltf(bool is_binary, std::string bytes, const std::filesystem::path& folder)
{
    try {
        GltfFile file;
        bool is_decoded = false;
        GltfDocument document = read_checked(is_binary, bytes, file.warnings, is_decoded);
        if (is_posed_gltf(document.json) && !is_packed_gltf(document.json)) {
            GltfAccessors accessors(document, reader_in(folder));
            const GltfFigure figure(document.json, accessors);
            figure.place(figure.rest(), file.vertices);
        }
        const bool is_stripped = remove_motion(document.json);
        const bool is_written = write_positions_as_floats(document, reader_in(folder));
        const bool is_changed = is_decoded || is_stripped || is_written;
        file.is_binary = is_binary || is_written;
        if (is_changed)
            file.bytes = file.is_binary ? write_glb(document) : document.json.dump();
        else
            file.bytes = std::move(bytes);
        return file;
    } catch (const nlohmann::json::exception& error) {
        refuse(error);
    }
}

GltfMotion read_gltf_motion(bool is_binary, std::string_view bytes, const std::filesystem::path& folder,
                            const std::optional<std::string>& animation)
{
    try {
        std::vector<std::string> warnings;
        bool is_decoded = false;
        const GltfDocument document = read_checked(is_binary, bytes, warnings, is_decoded);
        GltfAccessors accessors(document, reader_in(folder));
        GltfFigure figure(document.json, accessors);
        GltfAnimation motion(document.json, animation, figure, accessors);
        return {std::move(figure), std::move(motion)};
    } catch (const nlohmann::json::exception& error) {
        refuse(error);
    }
}

}  // namespace arris
