// SPDX-License-Identifier: GPL-3.0-or-later
// When a vertex ceases to be EOL. While material flows over a fold it has two velocities there, one a side;
// an ordinary vertex has their mean, and the cloth loses energy. So an EOL vertex that no longer presses is
// not let go for that alone: cloth that lifts off an edge keeps its fold, through which it flows, until the
// fold has opened or is far from the edge.
#pragma once

#include "geometry/patch_quality.h"
#include "solver/eol_coordinates.h"
#include "solver/scene.h"
#include "solver/state.h"

namespace arris {

/// Steps without pressing, before which no vertex is let go: contact that chatters is still contact.
inline constexpr int kIdleSteps = 3;

/// Whether EOL vertex `entry`, at `place` in its obstacle's frame, does not press and can be let go: at no
/// more cost than a thousandth of the kinetic energy of the faces around it (relative to the obstacle), or
/// when it is more than a cell from its feature.
bool can_let_go(const Scene& scene, const State& state, const ClothStars& stars, int entry,
                const EolCoordinates& at, const Vec3& place);

}  // namespace arris
