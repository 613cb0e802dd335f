// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace arris {

/// A TOML value and its position in the text.
struct SceneValue {
    enum class Kind { Table, Array, Text, Integer, Number, Boolean, Date };

    Kind kind = Kind::Table;
    bool boolean = false;
    std::int64_t integer = 0;
    double number = 0.0;  ///< also set for an integer
    std::string text;
    std::vector<SceneValue> items;  ///< entries of an array
    std::vector<std::pair<std::string, SceneValue>>
        members;  ///< entries of a table, in the order of the file

    // Position in the source: the first character, and the character after the last one. Lines and columns
    // count from 1.
    int source = 0;  ///< 0: the file; k > 0: the k-th override
    int line = 1, column = 1, end_line = 1, end_column = 1;
    bool is_shown = false;  ///< written after "key =", not under a [header]: error messages quote the value

    const SceneValue* member(std::string_view name) const;
    SceneValue* member(std::string_view name);
};

/// Reads a scene file, or another text that `allowed` names. Throws InputError if it is missing, not a
/// regular file, or larger than 16 MiB.
std::string read_scene_text(const std::string& path, std::string_view allowed = "a scene file (TOML)");

/// The tree of a scene file with overrides applied. Of the meaning of keys it uses only which of them are
/// tables and arrays of tables. All errors about a scene are thrown through fail(), so that they have one
/// form.
class SceneDocument {
  public:
    /// Parses `text`, read from `path`. Throws InputError if it is not UTF-8 or not TOML.
    SceneDocument(const std::string& path, const std::string& text);

    /// Applies an override "KEY=VALUE". KEY is a dotted scene key, with elements of arrays of tables by
    /// index; the next free index appends. VALUE is TOML, or else a string. Throws InputError.
    void set(std::string_view assignment);

    const std::string& path() const { return path_; }
    const SceneValue& root() const { return root_; }

    /// The value at a dotted path ("pin.0.release"), or null.
    const SceneValue* find(std::string_view key) const;

    /// Throws InputError with `FILE:LINE: key = value: WRONG; allowed: ALLOWED`. If `key` has no value, LINE
    /// is that of the nearest table above the key. `allowed` may be empty.
    [[noreturn]] void fail(std::string_view key, std::string_view wrong, std::string_view allowed = {}) const;

    /// The beginning of errors and warnings: "FILE:LINE: key = value"; for an override "--set KEY=VALUE", and
    /// for a value below the override's key "--set KEY=VALUE: key = value".
    std::string describe(std::string_view key) const;

  private:
    /// A text from which values were read.
    struct Source {
        std::string text;
        std::string assignment;  ///< "KEY=VALUE"; empty for the file
    };

    const SceneValue& nearest(std::string_view key) const;
    std::string quote(const SceneValue& value) const;
    SceneValue override_value(std::string_view value, int source) const;

    std::string path_;
    std::vector<Source> sources_;
    SceneValue root_;
};

}  // namespace arris
