// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "app/files/binary_stream.h"
#include "solver/model/state.h"

namespace arris {

/// The state of a simulation in a checkpoint. What is read may be invalid (checkpoint_defect.h), but is not
/// longer than the file.
void write_state(BinaryWriter& out, const State& state);
State read_state(BinaryReader& in);

}  // namespace arris
