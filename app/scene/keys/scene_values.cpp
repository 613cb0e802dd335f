// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/keys/scene_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "app/scene/keys/scene_key_kinds.h"
#include "app/scene/keys/scene_keys.h"
#include "app/text/printable.h"

namespace arris {
namespace {

using Json = nlohmann::ordered_json;
using Kind = SceneValue::Kind;

std::string join(std::string_view path, std::string_view leaf)
{
    return path.empty() ? std::string(leaf) : fmt::format("{}.{}", path, leaf);
}

/// Checks one value against its key. `path` is the value's position in the scene, such as "pin.0.release".
struct Check {
    const SceneDocument& document;
    const SceneKey& key;
    const std::string& path;

    [[noreturn]] void fail(std::string_view wrong) const { document.fail(path, wrong, allowed_values(key)); }

    double number(const SceneValue& value) const
    {
        if (value.kind != Kind::Number && value.kind != Kind::Integer) fail("is not a number");
        if (!std::isfinite(value.number)) fail("is not finite");
        const bool is_below =
            key.range.excludes_least ? value.number <= key.range.least : value.number < key.range.least;
        if (is_below || value.number > key.range.greatest) fail("is out of range");
        return value.number;
    }

    std::int64_t integer(const SceneValue& value) const
    {
        if (value.kind != Kind::Integer) fail("is not an integer");
        number(value);
        return value.integer;
    }

    const std::string& text(const SceneValue& value) const
    {
        if (value.kind != Kind::Text) fail("is not a text");
        return value.text;
    }

    const std::vector<SceneValue>& items(const SceneValue& value) const
    {
        if (value.kind != Kind::Array) fail("is not an array");
        return value.items;
    }

    const std::vector<SceneValue>& items(const SceneValue& value, int count) const
    {
        if (value.kind != Kind::Array)
            fail(fmt::format("is not an array, such as {}", count == 2 ? "[1, 2]" : "[1, 2, 3]"));
        if (static_cast<int>(value.items.size()) != count) fail("has the wrong number of entries");
        return value.items;
    }

    /// Requires an array of arrays. `example` is a correct value for the error message.
    const std::vector<SceneValue>& points(const SceneValue& value, std::string_view example) const
    {
        const auto is_array = [](const SceneValue& item) { return item.kind == Kind::Array; };
        if (!is_array(value) || !std::all_of(value.items.begin(), value.items.end(), is_array))
            fail(fmt::format("is not an array of points, such as {}", example));
        return value.items;
    }

    Json point(const SceneValue& value, int width) const
    {
        Json result = Json::array();
        for (const SceneValue& item : items(value, width)) result.push_back(number(item));
        return result;
    }
};

Json complete_text(const Check& check, const SceneValue& value)
{
    const std::string& text = check.text(value);
    const auto length = static_cast<double>(
        std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
    if (length > check.key.range.greatest) check.fail(fmt::format("has {} characters", length));
    if (length < check.key.range.least) check.fail("is empty");
    if (check.key.type == KeyType::Path && text.find('\0') != std::string::npos)
        check.fail("contains a zero byte");
    return text;
}

Json complete_name(const Check& check, const SceneValue& value)
{
    const std::string& text = check.text(value);
    if (!is_scene_name(text)) check.fail("is not a name");
    return text;
}

Json complete_choice(const Check& check, const SceneValue& value)
{
    const auto is_one_of = [&](std::string_view choices) {
        const auto all = split_choices(choices);
        return std::find(all.begin(), all.end(), value.text) != all.end();
    };
    check.text(value);
    if (is_one_of(check.key.unbuilt_choices))
        check.fail(fmt::format("\"{}\" is not built yet in this version", value.text));
    if (!is_one_of(check.key.choices))
        check.fail(check.key.type == KeyType::Choice
                       ? std::string("is not one of the choices")
                       : fmt::format("\"{}\" is not one of the choices", printable(value.text, 60)));
    return value.text;
}

Json complete_choices(const Check& check, const SceneValue& value)
{
    std::set<std::string> seen;
    Json result = Json::array();
    for (const SceneValue& item : check.items(value)) {
        result.push_back(complete_choice(check, item));
        if (!seen.insert(item.text).second) check.fail(fmt::format("names \"{}\" twice", item.text));
    }
    if (static_cast<int>(result.size()) < check.key.count) check.fail("is empty");
    return result;
}

Json complete_axis(const Check& check, const SceneValue& value)
{
    constexpr double kShortestAxis = 1e-9;  // shorter vectors would lose their direction when squared
    Json result = check.point(value, check.key.count);
    const bool is_short = std::all_of(result.begin(), result.end(), [](const Json& component) {
        return std::abs(component.get<double>()) < kShortestAxis;
    });
    if (is_short) check.fail("has no direction");
    return result;
}

/// A correct box or line for the error message. Where a single point was written, the box of that point.
std::string example_corners(const Check& check, const SceneValue& value)
{
    if (check.key.type == KeyType::Line) return "[[0.5, 0], [0.5, 1]]";
    const auto is_number = [](const SceneValue& item) {
        return (item.kind == Kind::Number || item.kind == Kind::Integer) && std::isfinite(item.number);
    };
    const std::vector<SceneValue>& items = value.items;
    if (items.size() != 2 || !std::all_of(items.begin(), items.end(), is_number)) return "[[0, 0], [0, 1]]";
    return fmt::format("[[{0}, {1}], [{0}, {1}]] for this point alone", items[0].number, items[1].number);
}

Json complete_corners(const Check& check, const SceneValue& value)
{
    check.points(value, example_corners(check, value));
    Json result = Json::array();
    for (const SceneValue& corner : check.items(value, 2)) result.push_back(check.point(corner, 2));
    if (check.key.type == KeyType::Line && result[0] == result[1]) check.fail("is a point, not a line");
    for (int axis = 0; axis < 2 && check.key.type == KeyType::Box; ++axis)
        if (result[0][axis] > result[1][axis]) check.fail("has its least corner above its greatest");
    return result;
}

Json complete_points(const Check& check, const SceneValue& value)
{
    Json result = Json::array();
    for (const SceneValue& point : check.points(value, "[[0, 0, 0], [1, 0, 0]]"))
        result.push_back(check.point(point, 3));
    if (static_cast<int>(result.size()) < check.key.count) check.fail("has too few points");
    return result;
}

/// Errors name the corner, as polygons may be long.
Json complete_polygon(const Check& check, const SceneValue& value)
{
    Json result = Json::array();
    for (const SceneValue& corner : check.points(value, "[[0, 0], [1, 0], [0.5, 0.9]]")) {
        const std::string path = fmt::format("{}.{}", check.path, result.size());
        result.push_back(Check{check.document, check.key, path}.point(corner, 2));
    }
    if (static_cast<int>(result.size()) < check.key.count) check.fail("has too few corners");
    return result;
}

Json complete_polygons(const Check& check, const SceneValue& value)
{
    Json result = Json::array();
    for (const SceneValue& polygon : check.items(value)) {
        const std::string path = fmt::format("{}.{}", check.path, result.size());
        result.push_back(complete_polygon({check.document, check.key, path}, polygon));
    }
    return result;
}

/// Sides are by corners of a panel, or by places within it, whose range differs.
Json complete_join(const Check& check, const SceneValue& value)
{
    SceneKey places = check.key;
    places.range = kAnyNumber;
    Json result = Json::array();
    for (const SceneValue& side : check.items(value)) {
        const std::string path = fmt::format("{}.{}", check.path, result.size());
        const Check part{check.document, check.key, path};
        const std::vector<SceneValue>& items = part.items(side);
        const bool is_line = items.size() >= 3 && items[1].kind == Kind::Array;
        if (!is_line && items.size() != 3 && items.size() != 4) part.fail("has the wrong number of entries");
        Json json = Json::array({complete_name(part, items[0])});
        for (std::size_t k = 1; k < items.size(); ++k)
            json.push_back(is_line ? Check{check.document, places, path}.point(items[k], 2)
                                   : Json(part.integer(items[k])));
        result.push_back(std::move(json));
    }
    if (result.size() != 2) check.fail("has the wrong number of sides");
    return result;
}

Json complete_boolean(const Check& check, const SceneValue& value)
{
    if (value.kind != Kind::Boolean) check.fail("is not a boolean");
    if (value.boolean && check.key.unbuilt_choices == "true") check.fail("is not built yet in this version");
    return value.boolean;
}

Json complete_integers(const Check& check, const SceneValue& value)
{
    Json result = Json::array();
    for (const SceneValue& item : check.items(value, check.key.count)) result.push_back(check.integer(item));
    return result;
}

/// Errors name the entry, as the array may be long.
Json complete_indices(const Check& check, const SceneValue& value)
{
    std::set<std::int64_t> seen;
    Json result = Json::array();
    for (const SceneValue& item : check.items(value)) {
        const std::string path = fmt::format("{}.{}", check.path, result.size());
        const Check entry{check.document, check.key, path};
        result.push_back(entry.integer(item));
        if (!seen.insert(item.integer).second) entry.fail("is there twice");
    }
    if (static_cast<int>(result.size()) < check.key.count) check.fail("is empty");
    return result;
}

Json complete_table(const SceneDocument& document, const SceneValue* value, std::string_view name,
                    const std::string& path);

Json complete_tables(const Check& check, const SceneValue& value)
{
    if (value.kind != Kind::Array) check.fail("is not an array of tables");
    const std::string element_name = fmt::format("{}{}", check.key.name, check.key.may_repeat ? "" : "[]");
    Json result = Json::array();
    if (check.key.may_repeat && value.items.empty()) check.fail("is empty");
    for (std::size_t i = 0; i < value.items.size(); ++i) {
        const std::string path = fmt::format("{}.{}", check.path, i);
        if (value.items[i].kind != Kind::Table) Check{check.document, check.key, path}.fail("is not a table");
        result.push_back(complete_table(check.document, &value.items[i], element_name, path));
    }
    return result;
}

Json complete_value(const Check& check, const SceneValue& value)
{
    switch (check.key.type) {
        case KeyType::Table:
            if (check.key.may_repeat && value.kind == Kind::Array) return complete_tables(check, value);
            if (value.kind != Kind::Table) check.fail("is not a table");
            return complete_table(check.document, &value, check.key.name, check.path);
        case KeyType::Tables:
            return complete_tables(check, value);
        case KeyType::Number:
            return check.number(value);
        case KeyType::Integer:
            return check.integer(value);
        case KeyType::Boolean:
            return complete_boolean(check, value);
        case KeyType::Text:
        case KeyType::Path:
            return complete_text(check, value);
        case KeyType::Name:
            return complete_name(check, value);
        case KeyType::Choice:
            return complete_choice(check, value);
        case KeyType::Choices:
            return complete_choices(check, value);
        case KeyType::Numbers:
            return check.point(value, check.key.count);
        case KeyType::Axis:
            return complete_axis(check, value);
        case KeyType::Integers:
            return complete_integers(check, value);
        case KeyType::Indices:
            return complete_indices(check, value);
        case KeyType::Box:
        case KeyType::Line:
            return complete_corners(check, value);
        case KeyType::Points:
            return complete_points(check, value);
        case KeyType::Polygon:
            return complete_polygon(check, value);
        case KeyType::Polygons:
            return complete_polygons(check, value);
        case KeyType::Join:
            return complete_join(check, value);
    }
    return {};
}

/// The default of a key; null if it depends on other keys.
Json default_value(const SceneDocument& document, const SceneKey& key, const std::string& path)
{
    if (key.fallback == "{}") return complete_table(document, nullptr, key.name, path);
    return key.fallback.starts_with('(') ? Json() : Json::parse(key.fallback);
}

void refuse_unknown_keys(const SceneDocument& document, const SceneValue& table, std::string_view name,
                         const std::string& path)
{
    for (const auto& [leaf, value] : table.members) {
        if (find_scene_key(join(name, leaf))) continue;
        document.fail(join(path, leaf), explain_unknown(name, leaf), child_names(name));
    }
}

/// `value` is null for a table that always exists and is not written.
Json complete_table(const SceneDocument& document, const SceneValue* value, std::string_view name,
                    const std::string& path)
{
    if (value) refuse_unknown_keys(document, *value, name, path);
    Json result = Json::object();
    for (const SceneKey* key : child_keys(name)) {
        const std::string leaf(leaf_name(key->name));
        const std::string key_path = join(path, leaf);
        const SceneValue* written = value ? value->member(leaf) : nullptr;
        if (written)
            result[leaf] = complete_value({document, *key, key_path}, *written);
        else if (key->fallback == kRequired)
            document.fail(key_path, "is required and missing", allowed_values(*key));
        else if (!key->fallback.empty())
            result[leaf] = default_value(document, *key, key_path);
    }
    return result;
}

}  // namespace

nlohmann::ordered_json complete_scene(const SceneDocument& document)
{
    return complete_table(document, &document.root(), "", "");
}

}  // namespace arris
