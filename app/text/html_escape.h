// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace arris {

/// Text that an HTML parser takes for exactly this text, in an element or in a quoted attribute: markup
/// characters become entities; control characters other than a line's end, which HTML has no way to write,
/// become U+FFFD.
std::string escape_html(std::string_view text);

}  // namespace arris
