// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "app/files/binary_stream.h"
#include "geometry/rigid_motion.h"

namespace arris {

void write_keyframes(BinaryWriter& out, const std::vector<Keyframe>& keyframes);
std::vector<Keyframe> read_keyframes(BinaryReader& in);

/// Whether keyframes, which may come from an untrusted file, are finite, in ascending order of time, and have
/// rotations.
bool are_sound(const std::vector<Keyframe>& keyframes);

}  // namespace arris
