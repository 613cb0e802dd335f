// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace arris {

/// Largest coordinate allowed in an input, m. Larger ones suggest a wrong unit. The bound also keeps products
/// of two coordinates finite.
inline constexpr double kLargestCoordinate = 1e6;

}  // namespace arris
