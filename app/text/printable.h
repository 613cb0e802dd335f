// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace arris {

/// Makes `text` safe for one line of a terminal: control characters, line and paragraph separators and
/// bidirectional marks become escapes (\n, \u001b); bytes that are not UTF-8 become \xNN.
std::string printable(std::string_view text);

/// printable(text), cut after `limit` characters with an ellipsis.
std::string printable(std::string_view text, std::size_t limit);

/// Offset of the first byte of `text` that is not UTF-8; npos if all bytes are.
std::size_t find_invalid_utf8(std::string_view text);

}  // namespace arris
