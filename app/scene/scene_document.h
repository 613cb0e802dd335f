// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace arris {

/// A TOML value and where it was written.
struct SceneValue {
    enum class Kind { Table, Array, Text, Integer, Number, Boolean, Date };

    Kind kind = Kind::Table;
    bool boolean = false;
    std::int64_t integer = 0;
    double number = 0.0;  ///< of an integer too
    std::string text;
    std::vector<SceneValue> items;                            ///< of an array
    std::vector<std::pair<std::string, SceneValue>> members;  ///< of a table, in the order of the file

    // Where it stands in its source: first character, and the one after its last. Lines and columns count
    // from 1.
    int source = 0;  ///< 0 the file, 1... the overrides
    int line = 1, column = 1, end_line = 1, end_column = 1;
    bool is_shown = false;  ///< stands behind its key, not under a [header], so that it can be quoted

    const SceneValue* member(std::string_view name) const;
    SceneValue* member(std::string_view name);
};

/// The bytes of a scene file. Throws InputError in one line: missing, no regular file, larger than 16 MiB.
std::string read_scene_text(const std::string& path);

/// A scene file's text as a tree, overrides applied; knows nothing of what the keys mean beyond which of them
/// are arrays of tables. Errors of everything that reads it are made here, so that all have one form.
class SceneDocument {
  public:
    /// Parses `text`, read from `path`. Throws InputError in one line: not UTF-8, not TOML.
    SceneDocument(const std::string& path, const std::string& text);

    /// Applies one "KEY=VALUE". KEY is a dotted scene key, elements of arrays of tables by index (the next
    /// free one appends); VALUE is TOML, and what is not TOML is a string. Throws InputError.
    void set(std::string_view assignment);

    const std::string& path() const { return path_; }
    const SceneValue& root() const { return root_; }

    /// The value at a dotted path ("pin.0.release"), or null.
    const SceneValue* find(std::string_view key) const;

    /// Throws the InputError `FILE:LINE: key = value: wrong; allowed: ALLOWED`. Where there is no value at
    /// `key` the line is that of the nearest table above it. `allowed` may be empty.
    [[noreturn]] void fail(std::string_view key, std::string_view wrong, std::string_view allowed = {}) const;

    /// "FILE:LINE: key = value", the beginning of errors and warnings; of an override "--set KEY=VALUE", and
    /// of what is below its key "--set KEY=VALUE: key = value".
    std::string describe(std::string_view key) const;

  private:
    /// A text that values were read from.
    struct Source {
        std::string text;
        std::string assignment;  ///< the "KEY=VALUE" of an override
    };

    const SceneValue& nearest(std::string_view key) const;
    std::string quote(const SceneValue& value) const;
    SceneValue override_value(std::string_view value, int source) const;

    std::string path_;
    std::vector<Source> sources_;
    SceneValue root_;
};

}  // namespace arris
