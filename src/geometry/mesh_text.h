// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace arris {

/// Removes the UTF-8 byte-order mark at the beginning of a text. Throws InputError, without the file's name,
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

/// An OBJ file in the one spelling that the readers of cloth and obstacles need: keywords in lower case at
/// the beginning of a line, words separated by one space, each statement on one line, line feeds only.
/// Continued and commented lines leave empty lines, so lines keep their numbers. Numbers begin with a digit,
/// as the import library (assimp 5.2) requires. Throws InputError, without the file's name, for bytes that
/// are no text and for UTF-16.
std::string canonical_obj(std::string_view bytes);

/// Whether the bytes are those of a text STL file: they begin with "solid" in any case, hold no zero byte,
/// and their length is not that of a binary file. Throws InputError for UTF-16.
bool is_text_stl(std::string_view bytes);

/// A text STL file in the one spelling that the import library needs: words in lower case, one space between
/// words, one keyword a line. Leaves out names of solids, and normals, which obstacles do not use.
std::string canonical_stl(std::string_view bytes);

}  // namespace arris
