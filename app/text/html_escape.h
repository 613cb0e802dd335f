// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace arris {

/// Escapes `text` for an HTML element or a quoted attribute. Markup characters become entities. Control
/// characters other than a line feed become U+FFFD, since HTML cannot represent them.
std::string escape_html(std::string_view text);

}  // namespace arris
