// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/deform/vertex_cache.h"

#include <fmt/format.h>

#include <filesystem>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/deform/obj_sequence.h"
#include "geometry/obstacle_input/deform/point_file.h"

namespace arris {

namespace {

std::string extension_of(const std::string& path)
{
    return to_lower(std::filesystem::path(path).extension().string());
}

}  // namespace

std::vector<std::string> list_cache_files(const std::string& path)
{
    return extension_of(path) == ".obj" ? list_obj_sequence(path) : std::vector<std::string>{path};
}

std::unique_ptr<VertexCache> open_vertex_cache(const VertexCacheRequest& request)
{
    const std::string extension = extension_of(request.path);
    if (extension == ".mdd") return open_mdd(request);
    if (extension == ".pc2") return open_pc2(request);
    if (extension == ".obj") return open_obj_sequence(request);
    throw InputError(
        fmt::format("{}: unknown format '{}' of positions in time; allowed: .mdd, .pc2, or .obj with %d in "
                    "place of a number",
                    request.path, one_line(extension)));
}

}  // namespace arris
