// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh_text.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "geometry/input_error.h"

namespace arris {
namespace {

// The last is the end-of-file mark of old editors.
constexpr std::string_view kBlank = " \t\v\f\x1a";
constexpr std::string_view kMark = "\xef\xbb\xbf";  // UTF-8 byte-order mark

std::string_view trimmed(std::string_view line)
{
    line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
    return line.substr(0, line.find_last_not_of(kBlank) + 1);
}

// A Fortran number as others write it: 1.5D+00 is 1.5e+00.
std::string without_fortran_exponent(std::string_view word)
{
    std::string number(word);
    const std::size_t letter = number.find_first_of("dD");
    const bool is_number = number.find_first_not_of("+-.0123456789dD") == std::string::npos;
    if (letter != std::string::npos && is_number) number[letter] = 'e';
    return number;
}

}  // namespace

std::string_view skip_byte_order_mark(std::string_view text)
{
    const bool is_marked = text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff");
    // Characters of two bytes, one of which is zero.
    const auto is_zero = [&](std::size_t i) { return text[i] == '\0'; };
    const bool is_wide =
        text.size() >= 4 && is_zero(0) != is_zero(1) && is_zero(0) == is_zero(2) && is_zero(1) == is_zero(3);
    if (is_marked || is_wide) throw InputError("its text is in UTF-16 or UTF-32; allowed: ASCII or UTF-8");
    while (text.starts_with(kMark)) text.remove_prefix(kMark.size());
    return text;
}

ParsedNumber parse_number(std::string_view word)
{
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    const std::string digits = without_fortran_exponent(word);
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::invalid_argument || end != digits.data() + digits.size())
        return {0.0, NumberError::NoNumber};
    if (error == std::errc()) return {value, NumberError::None};
    // from_chars does not tell a number too small for double precision, which is zero, from one too large.
    value = std::strtod(digits.c_str(), nullptr);
    return {value, std::isfinite(value) ? NumberError::None : NumberError::TooLarge};
}

std::string_view take_line(std::string_view& text)
{
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    std::string_view line = trimmed(text.substr(0, end));
    const bool has_both = text.substr(end, 2) == "\r\n";
    text.remove_prefix(std::min(text.size(), end + (has_both ? 2 : 1)));
    // Files that are joined have a mark in front of each part.
    while (line.starts_with(kMark)) line = trimmed(line.substr(kMark.size()));
    return line;
}

std::string_view take_word(std::string_view& line)
{
    const std::size_t begin = std::min(line.find_first_not_of(kBlank), line.size());
    const std::size_t end = std::min(line.find_first_of(kBlank, begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

std::string to_lower(std::string_view word)
{
    std::string lower(word);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return lower;
}

std::string excerpt(std::string_view text)
{
    std::string quote(text.substr(0, kLongestQuote));
    if (quote.size() < text.size()) quote += "...";
    return quote;
}

std::string counted(long long count, std::string_view one, std::string_view many)
{
    return std::to_string(count).append(1, ' ').append(count == 1 ? one : many);
}

std::string one_line(std::string_view text)
{
    constexpr std::size_t kLongestLine = 500;
    std::string line(text.substr(0, kLongestLine));
    for (char& c : line)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    if (line.size() < text.size()) line += "...";
    return line;
}

}  // namespace arris
