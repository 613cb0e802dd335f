// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "geometry/obstacle_input/deform/vertex_cache.h"

namespace arris {

/// open_vertex_cache for OBJ files with a number in their names.
std::unique_ptr<VertexCache> open_obj_sequence(const VertexCacheRequest& request);

/// list_cache_files for these. A path that is no pattern names itself.
std::vector<std::string> list_obj_sequence(const std::string& path);

}  // namespace arris
