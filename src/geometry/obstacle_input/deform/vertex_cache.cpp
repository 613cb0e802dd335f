// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/deform/vertex_cache.h"

#include <fmt/format.h>

#include <filesystem>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/deform/gltf_cache.h"
#include "geometry/obstacle_input/deform/obj_sequence.h"
#include "geometry/obstacle_input/deform/point_file.h"
#include "geometry/obstacle_input/deform/usda_cache.h"

namespace arris {

namespace {

std::string extension_of(const std::string& path)
{
    return to_lower(std::filesystem::path(path).extension().string());
}

}  // namespace

bool is_usd_file(const std::string& path)
{
    const std::string extension = extension_of(path);
    return extension == ".usda" || extension == ".usd" || extension == ".usdc" || extension == ".usdz";
}

bool is_gltf_file(const std::string& path)
{
    const std::string extension = extension_of(path);
    return extension == ".gltf" || extension == ".glb";
}

std::vector<std::string> list_cache_files(const std::string& path)
{
    return extension_of(path) == ".obj" ? list_obj_sequence(path) : std::vector<std::string>{path};
}

SampleRange find_sample_range(const VertexCacheRequest& request, std::size_t samples)
{
    const auto refuse = [&](const std::string& why) { throw InputError(request.path + ": " + why); };
    const std::size_t end = samples - 1;
    const std::size_t first = request.first ? static_cast<std::size_t>(*request.first) : 0;
    const std::size_t last = request.last ? static_cast<std::size_t>(*request.last) : end;
    if (first > end || last > end)
        refuse(fmt::format("has no sample {}; allowed: 0 to {}", first > end ? first : last, end));
    if (last < first) refuse(fmt::format("last = {} is before first = {}", last, first));
    return {first, last - first + 1};
}

std::unique_ptr<VertexCache> open_vertex_cache(const VertexCacheRequest& request)
{
    const std::string extension = extension_of(request.path);
    if (extension == ".mdd") return open_mdd(request);
    if (extension == ".pc2") return open_pc2(request);
    if (extension == ".obj") return open_obj_sequence(request);
    if (is_usd_file(request.path)) return open_usda(request);
    if (is_gltf_file(request.path)) return open_gltf(request);
    throw InputError(fmt::format(
        "{}: unknown format '{}' of positions in time; allowed: .mdd, .pc2, .usda, .gltf, .glb, or .obj with "
        "%d in place of a number",
        request.path, one_line(extension)));
}

}  // namespace arris
