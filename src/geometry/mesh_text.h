// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace arris {

/// Longest quotation from a file in a message, bytes: enough to locate the place.
inline constexpr std::size_t kLongestQuote = 40;

/// Removes the UTF-8 byte-order marks at the beginning of a text. Throws InputError, without the file's name,
/// for a text in UTF-16 or UTF-32.
std::string_view skip_byte_order_mark(std::string_view text);

enum class NumberError { None, NoNumber, TooLarge };

struct ParsedNumber {
    double value = 0.0;
    NumberError error = NumberError::None;
};

/// Reads a whole word as a number, correctly rounded. Allows a plus sign, a point at either end, and
/// Fortran's exponent letter D. Infinity and NaN are numbers.
ParsedNumber parse_number(std::string_view word);

/// Takes a line that ends with a line feed, a carriage return, or both. The line has no byte-order mark at
/// its beginning, and no blanks at either end.
std::string_view take_line(std::string_view& text);

/// Takes a word that blanks separate from the next; empty at the end of the line.
std::string_view take_word(std::string_view& line);

std::string to_lower(std::string_view word);

/// A text from a file for a message: at most its first 40 characters.
std::string excerpt(std::string_view text);

/// A number with its noun: "1 face", "2 faces", "2 vertices" (for the plural that is given).
std::string counted(long long count, std::string_view one, std::string_view many);

/// `text` on one line, control characters replaced by spaces, at most 500 bytes.
std::string one_line(std::string_view text);

}  // namespace arris
