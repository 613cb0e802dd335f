// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/gltf_file.h"

#include <fmt/format.h>

#include <assimp/IOStream.hpp>
#include <memory>
#include <utility>

#include "geometry/input_error.h"
#include "geometry/obstacle_input/gltf_check.h"
#include "geometry/obstacle_input/gltf_document.h"
#include "geometry/obstacle_input/gltf_positions.h"
#include "geometry/obstacle_input/mesh_folder_io.h"
#include "geometry/obstacle_input/obstacle_reply.h"

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

}  // namespace

GltfFile prepare_gltf(bool is_binary, std::string bytes, const std::filesystem::path& folder)
{
    try {
        GltfDocument document = read_gltf(is_binary, bytes);
        std::vector<std::string> warnings = check_gltf(document.json);
        const auto read = [&](const std::string& name) { return read_sibling(folder, name); };
        if (!write_positions_as_floats(document, read))
            return {std::move(bytes), is_binary, std::move(warnings)};
        return {write_glb(document), true, std::move(warnings)};
    } catch (const nlohmann::json::exception& error) {
        throw InputError(one_line(std::string("its JSON is no glTF: ") + error.what()));
    }
}

}  // namespace arris
