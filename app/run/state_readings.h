// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "app/files/csv_table.h"
#include "app/files/frame.h"
#include "app/scene/parts/run_config.h"
#include "physics/forces/energies.h"
#include "solver/model/state.h"

namespace arris {

/// Converts a state to a frame. `elements` belong to the state's mesh.
Frame make_frame(const std::vector<MovingObstacle>& obstacles, const State& state,
                 const ClothElements& elements, const Terms& terms);

/// World positions and velocities of the probes' material points, in the order of `probes`.
std::vector<ProbeSample> sample_probes(const std::vector<Probe>& probes, const State& state);

}  // namespace arris
