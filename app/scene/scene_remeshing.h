// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "app/scene/scene_json.h"
#include "geometry/cloth/cloth_mesh.h"
#include "solver/model/remeshing.h"

namespace arris {

/// Reads the table [remesh] of a complete scene. `step`: of time, s. `cloth`: the first mesh.
Remeshing to_remeshing(const nlohmann::ordered_json& table, double step, const ClothMesh& cloth);

}  // namespace arris
