// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "geometry/obstacle_input/deform/vertex_cache.h"

namespace arris {

/// open_vertex_cache for one kind of file.
std::unique_ptr<VertexCache> open_mdd(const VertexCacheRequest& request);
std::unique_ptr<VertexCache> open_pc2(const VertexCacheRequest& request);

}  // namespace arris
