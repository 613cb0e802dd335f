// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace arris {

/// What has become something (an EOL vertex, a trace that gathers, a floor of squeezed cloth) stays so past
/// the limit at which it became so, so that it does not come and go: down to this share of a least value, up
/// to the limit over this share of a greatest one. A concept gives only its limit to enter.
inline constexpr double kStayRatio = 0.5;

}  // namespace arris
