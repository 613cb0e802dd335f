// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/cloth/cloth_mesh.h"
#include "solver/model/scene.h"

namespace arris {

/// Moves cloth at time 0 out to the stand-off where it is nearer to an obstacle but free of all. Stops short
/// where it would pass through something. Returns the number of moved vertices. Pins are ignored here:
/// `attach_pins` places the vertices that they hold. The sweeps over the contacts are bounded: wedged cloth
/// may end nearer than the stand-off, and the steps start from there.
int clear_stand_off(const Scene& scene, ClothMesh& mesh);

}  // namespace arris
