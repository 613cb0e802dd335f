// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace arris {

/// Replaces each {{name}} of a page by its HTML in one pass, so that inserted text is not searched again. The
/// page must name no other parts.
std::string fill_template(std::string_view page, const std::map<std::string_view, std::string>& parts);

}  // namespace arris
