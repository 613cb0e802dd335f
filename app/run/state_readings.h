// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
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

/// 0 for each ordinary vertex, 1 for one on an edge or wire, 2 for one on a corner or point.
std::vector<std::uint8_t> eol_kinds(const State& state);

/// World positions and velocities of the probes' material points, in the order of `probes`.
std::vector<ProbeSample> sample_probes(const std::vector<Probe>& probes, const State& state);

}  // namespace arris
