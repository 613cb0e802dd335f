// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace arris {

/// The largest coordinate of an input, m: what is farther out is in the wrong unit, and products of two
/// coordinates stay finite.
inline constexpr double kLargestCoordinate = 1e6;

}  // namespace arris
