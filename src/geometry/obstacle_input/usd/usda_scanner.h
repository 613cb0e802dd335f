// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/obstacle_input/formats/input_file.h"

namespace arris {

/// A place in a text.
struct UsdPlace {
    std::uint64_t offset = 0;  ///< bytes
    std::uint64_t line = 1;
};

/// What skip_value has passed.
struct UsdSkipped {
    std::size_t groups = 0;   ///< groups directly inside a bracket: the points of an array of points
    bool is_blocked = false;  ///< the value is None
};

/// Reads the words and brackets of a USD text in blocks, without recursion. Blanks and comments between them
/// are skipped. Throws InputError, one line with path and line, for text of another form.
class UsdScanner {
  public:
    explicit UsdScanner(const InputFile& file, const UsdPlace& place = {});

    /// The next character that is neither blank nor comment, which stays; 0 at the end.
    char next();
    /// The place of the character that `next` gives.
    UsdPlace place();

    bool take(char mark);     ///< whether it was next
    void require(char mark);  ///< throws if it is not next

    /// A name with `.` and `:` in it, or a number or keyword.
    std::string take_word();
    /// A quoted text without its quotes; escapes stay.
    std::string take_text();
    double take_number();
    /// Appends `count` numbers in parentheses.
    void take_tuple(std::size_t count, std::vector<double>& numbers);

    /// Skips a word, text, path, asset or group.
    UsdSkipped skip_value();

    [[noreturn]] void refuse(const std::string& why) const;

  private:
    char look(std::size_t ahead = 0);
    void advance();
    void fill(std::size_t ahead);
    void skip_blanks();
    /// Skips a text, path or asset, if it is next; `text` gets its beginning.
    bool skip_quoted(std::string* text);
    UsdSkipped skip_group();
    std::string take_characters(std::string_view also);

    const InputFile& file_;
    std::string block_;
    std::size_t at_ = 0;              // in the block
    std::uint64_t block_offset_ = 0;  // in the file
    std::uint64_t line_ = 1;
};

}  // namespace arris
