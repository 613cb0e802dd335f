// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

// For .cpp files of this folder only: the JSON library is slow to compile.
namespace arris {

/// The JSON of a glTF 2 file, and its binary chunk (empty if the file has none).
struct GltfDocument {
    nlohmann::json json;
    std::string chunk;
};

/// Takes a .gltf or .glb file apart. Throws InputError, without the file's name, for chunks that reach beyond
/// the file's end, and for JSON that is not well formed or nests deeper than 200 levels.
GltfDocument read_gltf(bool is_binary, std::string_view bytes);

/// The bytes of a .glb file.
std::string write_glb(const GltfDocument& document);

/// A member of an object, or null where the object or the member is missing.
const nlohmann::json& gltf_member(const nlohmann::json& object, const char* name);

/// An element of an array of the document, such as "accessors". Throws InputError, without the file's name,
/// if `index` is not a whole number in the array's range.
const nlohmann::json& gltf_element(const nlohmann::json& json, const char* array,
                                   const nlohmann::json& index);

}  // namespace arris
