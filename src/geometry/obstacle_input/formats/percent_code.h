// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace arris {

/// A reference (URI) without its percent-encoding (RFC 3986, 2.1): "my%20file" names "my file". A percent
/// sign that two hexadecimal digits do not follow stays.
std::string percent_decoded(std::string_view reference);

}  // namespace arris
