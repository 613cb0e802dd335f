// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/text/shell_word.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/text/printable.h"

namespace arris {

std::string shell_word(std::string_view text)
{
    const auto is_plain = [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || byte >= 0x80 ||
               std::string_view("/._-+=:,@%").find(c) != std::string_view::npos;
    };
    if (!text.empty() && std::all_of(text.begin(), text.end(), is_plain)) return printable(text);
    std::string word = "'";
    for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return printable(word + "'");
}

std::string resume_command(std::string_view program, std::string_view directory)
{
    return fmt::format("{} resume {}", shell_word(program), shell_word(directory));
}

}  // namespace arris
