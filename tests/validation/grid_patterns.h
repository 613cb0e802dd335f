// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "geometry/cloth_input/cloth_grid.h"

namespace arris {

inline constexpr std::array kPatterns = {GridPattern::Diagonal, GridPattern::Alternating, GridPattern::Cross,
                                         GridPattern::Unstructured};

/// The pattern's name in scene files.
inline const char* name_of(GridPattern pattern)
{
    constexpr std::array kNames = {"diagonal", "alternating", "cross", "unstructured"};
    return kNames[static_cast<std::size_t>(pattern)];
}

}  // namespace arris
