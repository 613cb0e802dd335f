// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/cloth/cloth_mesh.h"
#include "solver/model/scene.h"

namespace arris {

/// At time 0: moves cloth that is free of all obstacles but nearer to one than the stand-off out to it, as
/// far as it goes without passing anything (pins are not regarded: they move what they hold where they have
/// it). Returns how many vertices it moved. Bounded sweeps over the contacts; where cloth is wedged so that
/// they do not come to an end, it ends nearer than the stand-off, and the steps go on from there.
int clear_stand_off(const Scene& scene, ClothMesh& mesh);

}  // namespace arris
