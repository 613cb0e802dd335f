// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/text/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace arris {
namespace {

/// Code point and length in bytes of a UTF-8 character; length 0 if the bytes are not UTF-8.
struct CodePoint {
    std::uint32_t value = 0;
    std::size_t length = 0;
};

CodePoint decode(std::string_view text)
{
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
    const std::uint8_t lead = byte(0);
    if (lead < 0x80) return {lead, 1};
    const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if (lead < 0xc2 || lead > 0xf4 || text.size() < length) return {};
    std::uint32_t value = lead & (0xffu >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xc0) != 0x80) return {};
        value = value << 6 | (byte(i) & 0x3fu);
    }
    // Reject overlong forms, surrogates and values beyond Unicode.
    constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool is_surrogate = value >= 0xd800 && value <= 0xdfff;
    if (value < kLeast[length] || value > 0x10ffff || is_surrogate) return {};
    return {value, length};
}

bool is_control(std::uint32_t c)
{
    return c < 0x20 || (c >= 0x7f && c < 0xa0) || c == 0x2028 || c == 0x2029 || c == 0x200e || c == 0x200f ||
           (c >= 0x202a && c <= 0x202e) || (c >= 0x2066 && c <= 0x2069);
}

std::string escaped(std::uint32_t c)
{
    if (c == '\n') return "\\n";
    if (c == '\r') return "\\r";
    if (c == '\t') return "\\t";
    return fmt::format("\\u{:04x}", c);
}

}  // namespace

std::string printable(std::string_view text, std::size_t limit)
{
    std::string result;
    for (std::size_t count = 0; !text.empty(); ++count) {
        if (count == limit) return result + "…";
        const CodePoint c = decode(text);
        const std::size_t length = std::max<std::size_t>(c.length, 1);
        if (c.length == 0)
            result += fmt::format("\\x{:02x}", static_cast<std::uint8_t>(text[0]));
        else if (is_control(c.value))
            result += escaped(c.value);
        else
            result += text.substr(0, length);
        text.remove_prefix(length);
    }
    return result;
}

std::string printable(std::string_view text)
{
    return printable(text, std::numeric_limits<std::size_t>::max());
}

std::size_t find_invalid_utf8(std::string_view text)
{
    for (std::size_t i = 0; i < text.size();) {
        const CodePoint c = decode(text.substr(i));
        if (c.length == 0) return i;
        i += c.length;
    }
    return std::string_view::npos;
}

}  // namespace arris
