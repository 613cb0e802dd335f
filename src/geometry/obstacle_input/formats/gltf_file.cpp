// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/formats/gltf_file.h"

#include <fmt/format.h>

#include <assimp/IOStream.hpp>
#include <memory>
#include <utility>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/formats/gltf_check.h"
#include "geometry/obstacle_input/formats/gltf_document.h"
#include "geometry/obstacle_input/formats/gltf_positions.h"
#include "geometry/obstacle_input/formats/mesh_folder_io.h"
#include "geometry/obstacle_input/formats/percent_code.h"

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

}  // namespace

GltfFile prepare_gltf(bool is_binary, std::string bytes, const std::filesystem::path& folder)
{
    try {
        GltfDocument document = read_gltf(is_binary, bytes);
        std::vector<std::string> warnings = check_gltf(document.json);
        const bool is_decoded = decode_references(document.json);
        const auto read = [&](const std::string& name) { return read_sibling(folder, name); };
        const bool is_written = write_positions_as_floats(document, read);
        if (is_written || (is_decoded && is_binary)) return {write_glb(document), true, std::move(warnings)};
        if (is_decoded) bytes = document.json.dump();
        return {std::move(bytes), is_binary, std::move(warnings)};
    } catch (const nlohmann::json::exception& error) {
        throw InputError(one_line(std::string("its JSON is no glTF: ") + error.what()));
    }
}

}  // namespace arris
