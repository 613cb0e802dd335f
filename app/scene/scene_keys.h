// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace arris {

/// What a key's value must be. Integers are accepted where a number is expected, not the other way round.
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
    Axis,      ///< an array of three numbers: a direction
    Box,       ///< [[u, v], [u, v]]: least and greatest corner
    Line,      ///< [[u, v], [u, v]]: two different points
    Points     ///< an array of at least `count` points [x, y, z]
};

/// Allowed values of a number, or of every number of an array. Text: bounds count characters.
struct KeyRange {
    double least = 0.0;
    double greatest = 0.0;
    bool excludes_least = false;
};

/// One key of a scene file. This table is the one place that knows the keys: it validates scenes, fills in
/// defaults, and docs/scene.md and docs/scene.schema.json are generated from it.
struct SceneKey {
    std::string_view name;  ///< dotted; elements of arrays of tables as "pin[]"
    KeyType type = KeyType::Table;
    std::string_view unit = {};
    KeyRange range = {};
    int count = 0;                  ///< of an array: how many
    std::string_view choices = {};  ///< separated by '|'
    /// "" absent unless written, "required", JSON text, or "(words)" where the value depends on other keys.
    /// A table with the default "{}" is always there; one that is absent switches its effect off.
    std::string_view fallback = {};
    std::string_view sentence = {};
    bool is_built = true;                   ///< false: a key of a part that is not built yet in this version
    std::string_view unbuilt_choices = {};  ///< values not built yet, separated by '|'; "true" of a Boolean
};

inline constexpr std::string_view kRequired = "required";

/// All keys, each after its parent, in the order of documents.
const std::vector<SceneKey>& scene_keys();

/// The key called `name` ("pin[].release"), or null. The root is "".
const SceneKey* find_scene_key(std::string_view name);

/// The keys directly below `parent` ("" the root, "cloth", "pin[]").
std::vector<const SceneKey*> child_keys(std::string_view parent);

/// Their last components, "a, b, c", for a person who looks for one.
std::string child_names(std::string_view parent);

/// Last component: "release" of "pin[].release".
std::string_view leaf_name(std::string_view name);

/// Whether the key and all its parents are built.
bool is_built(const SceneKey& key);

/// Splits "a|b|c".
std::vector<std::string_view> split_choices(std::string_view choices);

/// Whether `text` is [A-Za-z_][A-Za-z0-9_]{0,63}.
bool is_scene_name(std::string_view text);

/// What is allowed, in words: "a number > 0, <= 1e+06 (s)".
std::string allowed_values(const SceneKey& key);

/// The key a person who wrote `leaf` below `parent` probably meant, by edit distance among its siblings, else
/// a key of that very name elsewhere; "" where nothing is near.
std::string closest_key(std::string_view parent, std::string_view leaf);

/// Restricted Damerau-Levenshtein distance (insert, delete, replace, swap of neighbours) in bytes.
int edit_distance(std::string_view a, std::string_view b);

}  // namespace arris
