// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "geometry/cloth/cloth_mesh.h"
#include "geometry/cloth_input/face_faults.h"

namespace arris {

/// Outcome of `turn_charts`.
struct ChartTurns {
    int mirrored = 0, charts = 0;
    std::string wrong;  ///< why faces of one chart run in different directions, or have no area; else empty
};

/// Makes every face counter-clockwise in the material, by mirroring charts whose faces all are clockwise:
/// each about its own middle, or all of them as one. `mesh` is not sewn yet; `placed` has the same faces.
ChartTurns turn_charts(const PlacedFaces& placed, ClothMesh& mesh);

}  // namespace arris
