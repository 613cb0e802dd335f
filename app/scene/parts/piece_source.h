// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "app/scene/keys/scene_document.h"
#include "geometry/input_error.h"

namespace arris {

/// A piece of cloth as the scene has it.
struct PieceSource {
    const SceneDocument& document;
    const nlohmann::ordered_json& json;
    std::string key;                            ///< "cloth", or "cloth.1"
    int vertices_before = 0, faces_before = 0;  ///< of the cloths before it

    std::string at(const std::string& leaf) const { return key + "." + leaf; }

    /// Path of the file that `leaf` names, which is relative to the scene's folder.
    std::string file(const std::string& leaf) const
    {
        const std::filesystem::path name(json[leaf].get<std::string>());
        return (std::filesystem::path(document.path()).parent_path() / name).string();
    }
};

/// Runs `build` and reports an InputError of it as an error of the piece's `leaf`.
template <typename Build>
auto blame(const PieceSource& piece, const std::string& leaf, const Build& build)
{
    try {
        return build();
    } catch (const InputError& error) {
        const std::string key = piece.at(leaf);
        piece.document.fail(piece.document.find(key) ? key : piece.key, error.what());
    }
}

}  // namespace arris
