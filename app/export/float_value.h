// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string>

#include "geometry/input_error.h"

namespace arris {

/// The nearest float to a coordinate (m) of a frame's vertex. Throws InputError naming the exported file
/// `path`, frame and vertex if the value is beyond a float.
inline float float_value(const std::string& path, std::size_t frame, std::size_t vertex, double value)
{
    if (!(std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max())))
        throw InputError(
            fmt::format("{}: frame {}, vertex {}: {} m is beyond a float; allowed: up to 3.4e38 m", path,
                        frame, vertex, value));
    return static_cast<float>(value);
}

}  // namespace arris
