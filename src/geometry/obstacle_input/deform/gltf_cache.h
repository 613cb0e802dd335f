// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "geometry/obstacle_input/deform/vertex_cache.h"

namespace arris {

/// open_vertex_cache for glTF files.
std::unique_ptr<VertexCache> open_gltf(const VertexCacheRequest& request);

}  // namespace arris
