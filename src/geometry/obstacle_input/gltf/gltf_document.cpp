// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/gltf/gltf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"

namespace arris {
namespace {

// Bytes of a GLB file before its first chunk, and of a chunk before its content.
constexpr std::size_t kGlbHeader = 12;
constexpr std::size_t kGlbChunkHeader = 8;

constexpr std::uint32_t kJsonChunk = 0x4e4f534a;
constexpr std::uint32_t kBinaryChunk = 0x004e4942;

std::uint32_t number_at(std::string_view bytes, std::size_t offset)
{
    std::uint32_t number = 0;
    std::memcpy(&number, bytes.data() + offset, sizeof number);
    return number;
}

void check_glb(std::string_view bytes)
{
    if (bytes.size() < kGlbHeader || !bytes.starts_with("glTF")) throw InputError("not a GLB file");
    if (const auto version = number_at(bytes, 4); version != 2)
        throw InputError(fmt::format("glTF version {}; allowed: 2", version));
    const auto length = number_at(bytes, 8);
    if (length > bytes.size())
        throw InputError(
            fmt::format("truncated: its header says {} bytes, but the file has {}", length, bytes.size()));
    bytes = bytes.substr(0, length);  // bytes after the declared length are ignored
    for (std::size_t at = kGlbHeader; at < bytes.size();) {
        if (bytes.size() - at < kGlbChunkHeader)
            throw InputError(fmt::format("truncated: a chunk's header at byte {}", at));
        const auto chunk = number_at(bytes, at);
        if (chunk > bytes.size() - at - kGlbChunkHeader)
            throw InputError(fmt::format("truncated: the chunk at byte {} says {} bytes, but {} are left", at,
                                         chunk, bytes.size() - at - kGlbChunkHeader));
        at += kGlbChunkHeader + chunk;
    }
}

void append(std::string& bytes, std::uint32_t number)
{
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

std::size_t padded(std::size_t size)
{
    return (size + 3) / 4 * 4;
}

// Readers call themselves for each level.
constexpr int kDeepest = 200;

nlohmann::json parse(std::string_view text)
{
    const auto require_depth = [](int depth, nlohmann::json::parse_event_t, nlohmann::json&) {
        if (depth > kDeepest) throw InputError(fmt::format("its JSON nests deeper than {} levels", kDeepest));
        return true;
    };
    // Some writers fill up the chunk with zeros instead of spaces.
    text = text.substr(0, text.find_last_not_of('\0') + 1);
    try {
        nlohmann::json json = nlohmann::json::parse(text, require_depth);
        if (!json.is_object()) throw InputError("its JSON is no object");
        return json;
    } catch (const nlohmann::json::parse_error& error) {
        throw InputError(
            one_line(fmt::format("cannot be imported: reading its JSON failed near byte {}", error.byte)));
    }
}

}  // namespace

GltfDocument read_gltf(bool is_binary, std::string_view bytes)
{
    if (!is_binary) return {parse(bytes), {}};
    check_glb(bytes);
    GltfDocument document;
    bytes = bytes.substr(0, number_at(bytes, 8));
    for (std::size_t at = kGlbHeader; at < bytes.size(); at += kGlbChunkHeader + number_at(bytes, at)) {
        const std::string_view content = bytes.substr(at + kGlbChunkHeader, number_at(bytes, at));
        const std::uint32_t type = number_at(bytes, at + 4);
        if (type == kJsonChunk && document.json.is_null()) document.json = parse(content);
        if (type == kBinaryChunk && document.chunk.empty()) document.chunk = content;
    }
    if (document.json.is_null()) throw InputError("it has no JSON chunk");
    return document;
}

std::string write_glb(const GltfDocument& document)
{
    std::string json = document.json.dump();
    json.resize(padded(json.size()), ' ');
    const std::size_t chunk = padded(document.chunk.size());
    std::string bytes = "glTF";
    append(bytes, 2);
    append(bytes, static_cast<std::uint32_t>(kGlbHeader + 2 * kGlbChunkHeader + json.size() + chunk));
    append(bytes, static_cast<std::uint32_t>(json.size()));
    append(bytes, kJsonChunk);
    bytes += json;
    append(bytes, static_cast<std::uint32_t>(chunk));
    append(bytes, kBinaryChunk);
    bytes += document.chunk;
    bytes.resize(padded(bytes.size()), '\0');
    return bytes;
}

const nlohmann::json& gltf_member(const nlohmann::json& object, const char* name)
{
    static const nlohmann::json kNone;
    if (!object.is_object()) return kNone;
    const auto found = object.find(name);
    return found == object.end() ? kNone : *found;
}

const nlohmann::json& gltf_element(const nlohmann::json& json, const char* array, const nlohmann::json& index)
{
    const nlohmann::json& elements = gltf_member(json, array);
    if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= elements.size())
        throw InputError(one_line(fmt::format("it names element {} of its {}, but there are {}", index.dump(),
                                              array, elements.size())));
    return elements[index.get<std::size_t>()];
}

}  // namespace arris
