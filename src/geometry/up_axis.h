// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/vectors.h"

namespace arris {

/// The rotation that turns a file's upward axis ('x', 'y' or 'z') to +z: y by (x, y, z) -> (x, -z, y), x by
/// (-z, y, x).
inline Mat3 turn_to_z(char up)
{
    Mat3 turn = Mat3::Identity();
    if (up == 'y') turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    if (up == 'x') turn << 0, 0, -1, 0, 1, 0, 1, 0, 0;
    return turn;
}

}  // namespace arris
