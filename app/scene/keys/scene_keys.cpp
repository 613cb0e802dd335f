// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/keys/scene_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace arris {
namespace {

/// "cloth.folds[]" for "cloth.folds[].line"; "" for "title".
std::string_view parent_name(std::string_view name)
{
    const std::size_t dot = name.rfind('.');
    return dot == std::string_view::npos ? std::string_view() : name.substr(0, dot);
}

/// "obstacle.motion" for "obstacle[].motion", as it stands in a [header].
std::string header_name(std::string_view name)
{
    std::string header(name);
    for (std::size_t at = header.find("[]"); at != std::string::npos; at = header.find("[]"))
        header.erase(at, 2);
    return header;
}

std::string number_range(const SceneKey& key)
{
    const KeyRange& range = key.range;
    std::string words = range.excludes_least ? fmt::format("> {} and <= {}", range.least, range.greatest)
                                             : fmt::format("from {} to {}", range.least, range.greatest);
    if (!key.unit.empty()) words += fmt::format(" ({})", key.unit);
    return words;
}

std::string choice_words(const SceneKey& key)
{
    const std::vector<std::string_view> unbuilt = split_choices(key.unbuilt_choices);
    std::string words;
    for (const std::string_view word : split_choices(key.choices)) {
        if (std::find(unbuilt.begin(), unbuilt.end(), word) != unbuilt.end()) continue;
        words += fmt::format("{}\"{}\"", words.empty() ? "" : ", ", word);
    }
    return words;
}

}  // namespace

const SceneKey* find_scene_key(std::string_view name)
{
    for (const SceneKey& key : scene_keys())
        if (key.name == name) return &key;
    return nullptr;
}

std::vector<const SceneKey*> child_keys(std::string_view parent)
{
    std::vector<const SceneKey*> children;
    for (const SceneKey& key : scene_keys())
        if (parent_name(key.name) == parent) children.push_back(&key);
    return children;
}

std::string child_names(std::string_view parent)
{
    std::string names;
    for (const SceneKey* key : child_keys(parent))
        names += fmt::format("{}{}", names.empty() ? "" : ", ", leaf_name(key->name));
    return names;
}

std::string_view leaf_name(std::string_view name)
{
    return name.substr(name.rfind('.') + 1);  // npos + 1 is 0
}

std::vector<std::string_view> split_choices(std::string_view choices)
{
    std::vector<std::string_view> words;
    while (!choices.empty()) {
        const std::size_t end = std::min(choices.find('|'), choices.size());
        words.push_back(choices.substr(0, end));
        choices.remove_prefix(std::min(end + 1, choices.size()));
    }
    return words;
}

bool is_scene_name(std::string_view text)
{
    constexpr std::size_t kLongestName = 64;
    const auto is_letter = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    };
    const auto fits = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9'); };
    return !text.empty() && text.size() <= kLongestName && is_letter(text[0]) &&
           std::all_of(text.begin(), text.end(), fits);
}

std::string allowed_values(const SceneKey& key)
{
    switch (key.type) {
        case KeyType::Table:
            if (leaf_name(key.name) == "rotate") return "a table, { axis = [0, 0, 1], degrees = 45 }";
            if (key.may_repeat) return fmt::format("a table, [{0}], or tables, [[{0}]]", key.name);
            return fmt::format("a table, [{}]", header_name(key.name));
        case KeyType::Tables:
            return fmt::format("tables, [[{}]]", key.name);
        case KeyType::Number:
            return fmt::format("a number {}", number_range(key));
        case KeyType::Integer:
            return fmt::format("an integer {}", number_range(key));
        case KeyType::Boolean:
            return key.unbuilt_choices == "true" ? "false" : "true or false";
        case KeyType::Text:
            return fmt::format("a text of at most {} characters", key.range.greatest);
        case KeyType::Name:
            return "a letter or _, then at most 63 letters, digits or _";
        case KeyType::Path:
            return "the path of a file, relative to the scene file";
        case KeyType::Choice:
            return choice_words(key);
        case KeyType::Choices:
            return fmt::format("{} of {}", key.count > 0 ? "one or more" : "any", choice_words(key));
        case KeyType::Numbers:
            return fmt::format("{} numbers {}", key.count, number_range(key));
        case KeyType::Axis:
            return fmt::format("{} numbers {}, not all nearly 0", key.count, number_range(key));
        case KeyType::Integers:
            return fmt::format("{} integers {}", key.count, number_range(key));
        case KeyType::Indices:
            return fmt::format("{} or more different integers {}", key.count, number_range(key));
        case KeyType::Box:
            return fmt::format("[[u, v], [u, v]], least then greatest, numbers {}", number_range(key));
        case KeyType::Line:
            return fmt::format("two different points, [[u, v], [u, v]], numbers {}", number_range(key));
        case KeyType::Points:
            return fmt::format("{} or more points [x, y, z], numbers {}", key.count, number_range(key));
        case KeyType::Polygon:
            return fmt::format("{} or more corners [u, v], numbers {}", key.count, number_range(key));
        case KeyType::Polygons:
            return fmt::format("polygons [[u, v], [u, v], ...] of {} or more corners, numbers {}", key.count,
                               number_range(key));
        case KeyType::Join:
            return R"(two sides, [["front", 1, 2], ["back", 4, 3]]: of each its panel, and its first and )"
                   "last corner, or also one between; of a tie also a line, [\"front\", [u, v], [u, v]]";
    }
    return {};
}

int edit_distance(std::string_view a, std::string_view b)
{
    // Three rows of the dynamic-programming table: two back (for swaps), one back, and the current one.
    std::vector<int> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = static_cast<int>(j);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        before.swap(last);
        last.swap(row);
        row[0] = static_cast<int>(i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            const bool is_swap = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (is_swap) row[j] = std::min(row[j], before[j - 2] + 1);
        }
    }
    return row[b.size()];
}

std::string closest_key(std::string_view parent, std::string_view leaf)
{
    constexpr std::size_t kLongestWord = 64;  // longer words resemble no key
    if (leaf.size() > kLongestWord) return {};
    const SceneKey* closest = nullptr;
    int closest_distance = std::max(1, static_cast<int>(leaf.size()) / 3) + 1;
    for (const SceneKey* key : child_keys(parent)) {
        const int distance = edit_distance(leaf, leaf_name(key->name));
        if (distance < closest_distance) {
            closest = key;
            closest_distance = distance;
        }
    }
    if (closest) return std::string(leaf_name(closest->name));
    // A key farther below the same table first.
    const std::string below = parent.empty() ? "" : fmt::format("{}.", parent);
    for (const SceneKey& key : scene_keys())
        if (!below.empty() && key.name.starts_with(below) && leaf_name(key.name) == leaf)
            return std::string(key.name.substr(below.size()));
    // In another table: but what is wrong within one value is no key of another effect.
    for (const SceneKey& key : scene_keys())
        if (parent.find('.') == std::string_view::npos && leaf_name(key.name) == leaf)
            return std::string(key.name);
    return {};
}

std::string explain_unknown(std::string_view parent, std::string_view leaf)
{
    constexpr std::array kSizesOfWires = {"radius", "thickness", "diameter"};
    if (parent == "obstacle[]" &&
        std::find(kSizesOfWires.begin(), kSizesOfWires.end(), leaf) != kSizesOfWires.end())
        return "unknown key: obstacles, wires and nails too, have no thickness of their own; "
               "cloth.material.thickness is the distance that the cloth keeps from them";
    if (parent.empty() && leaf == "scene")
        return "unknown key: a file with it is a study, which `arris study` runs";
    const std::string meant = closest_key(parent, leaf);
    if (meant.empty()) return "unknown key";
    const SceneKey* key = find_scene_key(meant);
    const std::size_t list = meant.find("[]");
    if (key && key->type == KeyType::Table && list != std::string::npos)
        return fmt::format("unknown key, did you mean [{}], below its [[{}]]?", header_name(meant),
                           meant.substr(0, list));
    return fmt::format("unknown key, did you mean {}?", meant);
}

}  // namespace arris
