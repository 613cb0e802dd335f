// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace arris {

/// Type of a key's value. Integers are accepted where a number is expected, not the other way round.
enum class KeyType {
    Table,   ///< [name], or an inline table
    Tables,  ///< [[name]], or an array of inline tables
    Number,
    Integer,
    Boolean,
    Text,
    Name,      ///< [A-Za-z_][A-Za-z0-9_]{0,63}
    Path,      ///< relative to the scene file's folder
    Choice,    ///< one of `choices`
    Choices,   ///< an array of different `choices`
    Numbers,   ///< an array of `count` numbers
    Integers,  ///< an array of `count` integers
    Indices,   ///< an array of at least `count` different integers
    Axis,      ///< an array of three numbers: a direction
    Box,       ///< [[u, v], [u, v]]: least and greatest corner
    Line,      ///< [[u, v], [u, v]]: two different points
    Points,    ///< an array of at least `count` points [x, y, z]
    Polygon,   ///< an array of at least `count` corners [u, v]
    Polygons,  ///< an array of polygons
    Join       ///< the two sides of a seam, each ["panel", corner, ..., corner] or ["panel", [u, v], ..., [u, v]]
};

/// Allowed values of a number, or of every number of an array. For a text, allowed numbers of characters.
struct KeyRange {
    double least = 0.0;
    double greatest = 0.0;
    bool excludes_least = false;
};

/// One key of a scene file. The table of these (scene_key_table.cpp) is the only list of keys: validation,
/// defaults, docs/scene.md and docs/scene.schema.json all come from it.
struct SceneKey {
    std::string_view name;  ///< dotted; elements of arrays of tables as "pin[]"
    KeyType type = KeyType::Table;
    std::string_view unit = {};
    KeyRange range = {};
    int count = 0;                  ///< entries of an array
    std::string_view choices = {};  ///< separated by '|'
    /// "": absent unless written; "required"; JSON text; or "(words)" where the default depends on other
    /// keys. A table with the default "{}" always exists; the absence of any other table switches its effect
    /// off.
    std::string_view fallback = {};
    std::string_view sentence = {};
    std::string_view unbuilt_choices = {};  ///< values not built yet, separated by '|'; "true" for a Boolean
    bool may_repeat = false;                ///< of a table: may be an array of tables, as well
};

inline constexpr std::string_view kRequired = "required";

/// All keys, each after its parent, in the order of docs/scene.md.
const std::vector<SceneKey>& scene_keys();

/// The key called `name` ("pin[].release"), or null. The root is "".
const SceneKey* find_scene_key(std::string_view name);

/// The keys directly below `parent` ("" the root, "cloth", "pin[]").
std::vector<const SceneKey*> child_keys(std::string_view parent);

/// Last components of the keys below `parent`, as "a, b, c", for error messages.
std::string child_names(std::string_view parent);

/// Last component: "release" of "pin[].release".
std::string_view leaf_name(std::string_view name);

/// Splits "a|b|c".
std::vector<std::string_view> split_choices(std::string_view choices);

/// Whether `text` is [A-Za-z_][A-Za-z0-9_]{0,63}.
bool is_scene_name(std::string_view text);

/// Description of the allowed values: "a number > 0 and <= 1000000 (s)".
std::string allowed_values(const SceneKey& key);

/// Suggestion for the unknown key `leaf` below `parent`: the nearest key below `parent` by edit distance,
/// else a key whose last component is `leaf`, farther below `parent` (relative to it) or, for a key of a
/// whole table, elsewhere; "" if there is none.
std::string closest_key(std::string_view parent, std::string_view leaf);

/// "unknown key", with a suggestion or an explanation where there is one.
std::string explain_unknown(std::string_view parent, std::string_view leaf);

/// Restricted Damerau-Levenshtein distance (insert, delete, replace, swap of neighbours) in bytes.
int edit_distance(std::string_view a, std::string_view b);

}  // namespace arris
