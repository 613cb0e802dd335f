// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/formats/percent_code.h"

#include <charconv>

namespace arris {

std::string percent_decoded(std::string_view reference)
{
    std::string text;
    while (!reference.empty()) {
        unsigned code = 0;
        const std::string_view digits = reference.substr(1, 2);
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
        const bool is_code =
            reference[0] == '%' && digits.size() == 2 && error == std::errc() && end == digits.data() + 2;
        text += is_code ? static_cast<char>(code) : reference[0];
        reference.remove_prefix(is_code ? 3 : 1);
    }
    return text;
}

}  // namespace arris
