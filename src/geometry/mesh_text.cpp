// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh_text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "geometry/input_error.h"

namespace arris {
namespace {

constexpr std::string_view kBlank = " \t\v\f";

std::string to_lower(std::string_view word)
{
    std::string lower(word);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return lower;
}

// Takes a line that ends with a line feed, a carriage return, or both.
std::string_view take_line(std::string_view& text)
{
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::string_view line = text.substr(0, end);
    const bool has_both = text.substr(end, 2) == "\r\n";
    text.remove_prefix(std::min(text.size(), end + (has_both ? 2 : 1)));
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

std::string_view trimmed(std::string_view line)
{
    const std::size_t begin = std::min(line.find_first_not_of(kBlank), line.size());
    line.remove_prefix(begin);
    return line.substr(0, line.find_last_not_of(kBlank) + 1);
}

template <std::size_t n>
bool is_in(const std::array<std::string_view, n>& words, std::string_view word)
{
    return std::find(words.begin(), words.end(), word) != words.end();
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

// A word that is a number, with a digit before its point; any other word unchanged.
std::string canonical_number(std::string_view word)
{
    if (parse_number(word).error != NumberError::None) return std::string(word);
    std::string number = without_fortran_exponent(word);
    const std::size_t first = std::min(number.find_first_not_of("+-"), number.size());
    if (number.substr(first, 1) == ".") number.insert(first, 1, '0');
    return number;
}

constexpr std::array<std::string_view, 3> kNumberKeywords = {"v", "vt", "vn"};
constexpr std::array<std::string_view, 3> kElementKeywords = {"f", "l", "p"};
constexpr std::array<std::string_view, 5> kNameKeywords = {"o", "g", "s", "usemtl", "mtllib"};

// One statement without its comment, its continued lines joined.
std::string canonical_statement(std::string_view statement)
{
    std::string_view rest = statement;
    std::string keyword = to_lower(take_word(rest));
    if (keyword == "fo") keyword = "f";  // the format's older name of a face
    const bool has_numbers = is_in(kNumberKeywords, keyword);
    if (has_numbers || is_in(kElementKeywords, keyword)) {
        std::string text = keyword;
        for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest))
            text.append(1, ' ').append(has_numbers ? canonical_number(word) : std::string(word));
        return text;
    }
    if (is_in(kNameKeywords, keyword)) return keyword.append(1, ' ').append(trimmed(rest));
    // The import library takes any statement that begins with such a letter for a vertex or an element.
    const bool looks_known = !keyword.empty() && std::strchr("vflp", keyword[0]) != nullptr;
    return std::string(looks_known ? "# " : "").append(statement);
}

constexpr std::array<std::string_view, 7> kStlKeywords = {"solid",   "facet",    "outer",   "vertex",
                                                          "endloop", "endfacet", "endsolid"};

// The part of a line "solid NAME" that is not the name: facets may follow in the same line.
std::string_view skip_name(std::string_view rest)
{
    const std::string lower = to_lower(rest);
    const std::size_t facet = lower.find("facet normal");
    return facet == std::string::npos ? std::string_view() : rest.substr(facet);
}

}  // namespace

std::string_view skip_byte_order_mark(std::string_view text)
{
    constexpr std::string_view kUtf8 = "\xef\xbb\xbf";
    const bool is_marked = text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff");
    // Characters of two bytes, one of which is zero.
    const auto is_zero = [&](std::size_t i) { return text[i] == '\0'; };
    const bool is_wide =
        text.size() >= 4 && is_zero(0) != is_zero(1) && is_zero(0) == is_zero(2) && is_zero(1) == is_zero(3);
    if (is_marked || is_wide) throw InputError("its text is in UTF-16 or UTF-32; allowed: ASCII or UTF-8");
    return text.substr(text.starts_with(kUtf8) ? kUtf8.size() : 0);
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

std::string canonical_obj(std::string_view bytes)
{
    bytes = skip_byte_order_mark(bytes);
    if (bytes.find('\0') != std::string_view::npos)
        throw InputError("not the text of an OBJ file (it holds a zero byte)");
    std::string text;
    text.reserve(bytes.size() + 1);
    while (!bytes.empty()) {
        std::string statement;
        std::size_t further_lines = 0;
        // A backslash at a line's end continues the statement; in a comment it means nothing.
        for (bool is_continued = true; is_continued && !bytes.empty();) {
            const std::string_view whole = take_line(bytes);
            std::string_view line = trimmed(whole.substr(0, whole.find('#')));
            is_continued = line.size() == trimmed(whole).size() && line.ends_with('\\');
            if (is_continued) line.remove_suffix(1);
            statement.append(line);
            if (is_continued && !bytes.empty()) {
                statement += ' ';
                ++further_lines;
            }
        }
        text += canonical_statement(statement);
        text.append(further_lines + 1, '\n');
    }
    return text;
}

bool is_text_stl(std::string_view bytes)
{
    constexpr std::size_t kHeader = 84, kFace = 50;  // of the binary form
    if (bytes.size() >= kHeader) {
        std::uint32_t count = 0;
        std::memcpy(&count, bytes.data() + 80, sizeof count);
        if (bytes.size() == kHeader + kFace * std::uint64_t{count}) return false;
    }
    std::string_view text = skip_byte_order_mark(bytes);
    text.remove_prefix(std::min(text.find_first_not_of(" \t\v\f\r\n"), text.size()));
    return to_lower(text.substr(0, 5)) == "solid" && text.find('\0') == std::string_view::npos;
}

std::string canonical_stl(std::string_view bytes)
{
    bytes = skip_byte_order_mark(bytes);
    std::string text;
    text.reserve(bytes.size() + 1);
    while (!bytes.empty()) {
        const std::string_view whole = take_line(bytes);
        std::string_view rest = whole.substr(0, whole.find('#'));
        for (std::string word = to_lower(take_word(rest)); !word.empty(); word = to_lower(take_word(rest))) {
            const bool is_keyword = is_in(kStlKeywords, word);
            if (!text.empty()) text += is_keyword ? '\n' : ' ';
            if (word == "facet") {
                text += "facet normal 0 0 0";
                std::string_view normal = rest;
                if (to_lower(take_word(normal)) != "normal") continue;
                for (int axis = 0; axis < 3; ++axis) take_word(normal);
                rest = normal;
            } else if (word == "solid" || word == "endsolid") {
                text += word;
                rest = skip_name(rest);
            } else {
                text += is_keyword ? word : canonical_number(word);
            }
        }
    }
    return text + "\n";
}

}  // namespace arris
