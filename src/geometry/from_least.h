// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>

namespace arris {

/// The corners of a face, in their order, from the least one on: one spelling of each face.
template <typename Corner>
std::array<Corner, 3> from_least(std::array<Corner, 3> face)
{
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    return face;
}

}  // namespace arris
