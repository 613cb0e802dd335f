// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/keys/scene_document.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <tuple>

#include "app/scene/keys/scene_keys.h"
#include "app/text/printable.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

constexpr std::uintmax_t kMaxFileBytes = 16 << 20;
constexpr std::size_t kMaxShownCharacters = 60;  // of a value in an error message
constexpr std::size_t kMaxShownOverride = 120;   // of KEY=VALUE in an error message

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

// ---- from text to a tree

SceneValue to_scene_value(const toml::node& node, int source);

void add_members(const toml::table& table, int source, SceneValue& value)
{
    // toml++ sorts members by name, but the first error to report is the first one in the file.
    std::vector<std::tuple<toml::source_index, toml::source_index, std::string, const toml::node*>> members;
    for (const auto& [key, node] : table)
        members.emplace_back(key.source().begin.line, key.source().begin.column, std::string(key.str()),
                             &node);
    std::sort(members.begin(), members.end());
    for (const auto& [line, column, name, node] : members)
        value.members.emplace_back(name, to_scene_value(*node, source));
}

void set_content(const toml::node& node, int source, SceneValue& value)
{
    using Kind = SceneValue::Kind;
    if (const toml::table* table = node.as_table()) {
        add_members(*table, source, value);
    } else if (const toml::array* array = node.as_array()) {
        value.kind = Kind::Array;
        for (const toml::node& item : *array) value.items.push_back(to_scene_value(item, source));
    } else if (const auto* text = node.as_string()) {
        value.kind = Kind::Text;
        value.text = text->get();
    } else if (const auto* integer = node.as_integer()) {
        value.kind = Kind::Integer;
        value.integer = integer->get();
        value.number = static_cast<double>(integer->get());
    } else if (const auto* number = node.as_floating_point()) {
        value.kind = Kind::Number;
        value.number = number->get();
    } else if (const auto* boolean = node.as_boolean()) {
        value.kind = Kind::Boolean;
        value.boolean = boolean->get();
    } else {
        value.kind = Kind::Date;
    }
}

/// Whether a node is written after "key =", not under a [header].
bool is_inline(const toml::node& node)
{
    if (const toml::table* table = node.as_table()) return table->is_inline();
    const toml::array* array = node.as_array();
    return !array || array->empty() || !array->is_array_of_tables() || is_inline(*array->get(0));
}

SceneValue to_scene_value(const toml::node& node, int source)
{
    const toml::source_region& region = node.source();
    SceneValue value;
    set_content(node, source, value);
    value.source = source;
    value.line = std::max<int>(1, static_cast<int>(region.begin.line));
    value.column = static_cast<int>(region.begin.column);
    value.end_line = static_cast<int>(region.end.line);
    value.end_column = static_cast<int>(region.end.column);
    value.is_shown = is_inline(node);
    return value;
}

// ---- files

/// What to write instead of text that the parser refuses with `error`.
std::string_view allowed_toml(std::string_view error)
{
    const auto says = [&](std::string_view words) { return error.find(words) != std::string_view::npos; };
    if (says("as array-of-tables") || (says("existing array") && says("as table")))
        return "[[name]] with two brackets above every one of several tables with this name";
    if (says("escape sequence") || says("unicode scalar"))
        return "in double quotes \\\\ for a backslash; or single quotes, as in 'C:\\meshes\\table.obj'";
    return "TOML 1.0, text in quotes, a digit before a number's point";
}

SceneValue parse_file(const std::string& path, std::string_view text)
{
    if (const std::size_t bad = find_invalid_utf8(text); bad != std::string_view::npos) {
        const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(bad), '\n');
        throw InputError(fmt::format("{}:{}: is not UTF-8 text; allowed: TOML", printable(path), line));
    }
    try {
        return to_scene_value(toml::parse(text), 0);
    } catch (const toml::parse_error& error) {
        throw InputError(fmt::format("{}:{}: is not TOML: {}; allowed: {}", printable(path),
                                     std::max<toml::source_index>(1, error.source().begin.line),
                                     printable(error.description(), 200), allowed_toml(error.description())));
    }
}

// ---- overrides

constexpr std::string_view kOverrideKey = "x = ";  // makes an override's VALUE a TOML document

/// The value of `text`, "x = VALUE". Nothing if it is not TOML or has more than one value.
std::optional<SceneValue> parse_override(const std::string& text, int source)
{
    try {
        const SceneValue table = to_scene_value(toml::parse(text), source);
        if (table.members.size() == 1 && table.members[0].first == "x") return table.members[0].second;
    } catch (const toml::parse_error&) {
        return std::nullopt;  // the caller decides whether the value is an unquoted string
    }
    return std::nullopt;
}

/// Whether `value` is an unquoted string, rather than a misspelt array, table or quoted string.
bool is_bare_word(std::string_view value)
{
    const bool is_control_free =
        std::none_of(value.begin(), value.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; });
    return !value.empty() && is_control_free &&
           std::string_view("[{\"'").find(value[0]) == std::string_view::npos;
}

[[noreturn]] void refuse_override(std::string_view assignment, std::string_view wrong,
                                  std::string_view allowed)
{
    throw InputError(
        fmt::format("--set {}: {}; allowed: {}", printable(assignment, kMaxShownOverride), wrong, allowed));
}

/// Nothing if `text` is not an index in digits.
std::optional<std::size_t> parse_index(std::string_view text)
{
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return index;
}

/// Byte offset of a line and a column. toml++ counts both from 1, columns in characters.
std::size_t byte_of_place(std::string_view text, int line, int column)
{
    std::size_t byte = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
    for (int i = 1; i < line; ++i) byte = std::min(text.find('\n', byte), text.size() - 1) + 1;
    for (int i = 1; i < column && byte < text.size(); ++i) {
        ++byte;
        while (byte < text.size() && (static_cast<unsigned char>(text[byte]) & 0xc0) == 0x80) ++byte;
    }
    return byte;
}

std::vector<std::string_view> split_key(std::string_view key)
{
    std::vector<std::string_view> parts;
    for (std::size_t begin = 0; begin <= key.size();) {
        const std::size_t end = std::min(key.find('.', begin), key.size());
        parts.push_back(key.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

/// Walks down the tree along an override's key and makes missing tables.
class OverrideWalk {
  public:
    OverrideWalk(SceneValue& root, std::string_view assignment, int source)
        : value_(&root), assignment_(assignment), source_(source)
    {
    }

    SceneValue& to(std::string_view key)
    {
        for (const std::string_view part : split_key(key)) {
            if (is_list_)
                enter_element(part);
            else
                enter_member(part);
        }
        return *value_;
    }

  private:
    void enter_member(std::string_view part)
    {
        const std::string name = name_.empty() ? std::string(part) : fmt::format("{}.{}", name_, part);
        const SceneKey* parent = find_scene_key(name_);
        const bool is_element = name_.ends_with("[]");
        if (parent && !is_element && parent->type != KeyType::Table)
            refuse_override(assignment_, fmt::format("{} has no keys below it", name_),
                            allowed_values(*parent));
        const SceneKey* key = find_scene_key(name);
        if (!key) refuse_unknown(part);
        require(SceneValue::Kind::Table);
        if (!value_->member(part)) value_->members.emplace_back(std::string(part), made(key->type));
        value_ = value_->member(part);
        name_ = name;
        const bool is_repeated = key->may_repeat && value_->kind == SceneValue::Kind::Array;
        is_list_ = key->type == KeyType::Tables || is_repeated;
    }

    void enter_element(std::string_view part)
    {
        require(SceneValue::Kind::Array);
        const std::size_t count = value_->items.size();
        const std::optional<std::size_t> index = parse_index(part);
        if (!index || *index > count)
            refuse_override(assignment_, fmt::format("{} is not an index of {}", printable(part), name_),
                            count == 0 ? "0" : fmt::format("0 to {}, where {} appends", count, count));
        if (*index == count) value_->items.push_back(made(KeyType::Table));
        value_ = &value_->items[*index];
        if (!find_scene_key(name_)->may_repeat) name_ += "[]";
        is_list_ = false;
    }

    [[noreturn]] void refuse_unknown(std::string_view part) const
    {
        const std::string meant = closest_key(name_, part);
        refuse_override(assignment_,
                        fmt::format("unknown key {}{}", printable(part, kMaxShownCharacters),
                                    meant.empty() ? "" : fmt::format(", did you mean {}?", meant)),
                        child_names(name_));
    }

    /// Refuses an override below a value of another kind, which has no member or element to enter.
    void require(SceneValue::Kind kind) const
    {
        if (value_->kind == kind) return;
        const SceneKey* key = find_scene_key(name_);
        refuse_override(assignment_,
                        fmt::format("line {} of the file gives {} another type", value_->line, name_),
                        key ? allowed_values(*key) : "a table");
    }

    SceneValue made(KeyType type) const
    {
        SceneValue value;
        value.kind = type == KeyType::Tables ? SceneValue::Kind::Array : SceneValue::Kind::Table;
        value.source = source_;
        return value;
    }

    SceneValue* value_;
    std::string_view assignment_;
    int source_;
    std::string name_;
    bool is_list_ = false;
};

}  // namespace

const SceneValue* SceneValue::member(std::string_view name) const
{
    for (const auto& [key, value] : members)
        if (key == name) return &value;
    return nullptr;
}

SceneValue* SceneValue::member(std::string_view name)
{
    return const_cast<SceneValue*>(std::as_const(*this).member(name));
}

std::string read_scene_text(const std::string& path, std::string_view allowed)
{
    namespace fs = std::filesystem;
    const auto refuse = [&](std::string_view why) {
        throw InputError(fmt::format("{}: {}", printable(path), why));
    };
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status)) refuse(error ? error.message() : "No such file or directory");
    if (fs::is_directory(status)) refuse(fmt::format("is a directory; allowed: {}", allowed));
    if (!fs::is_regular_file(status)) refuse(fmt::format("is not a regular file; allowed: {}", allowed));
    const std::uintmax_t size = fs::file_size(path, error);
    if (error) refuse(error.message());
    if (size > kMaxFileBytes)
        refuse(fmt::format("is {} bytes long; allowed: a file of at most {} bytes", size, kMaxFileBytes));
    std::ifstream stream(path, std::ios::binary);
    if (!stream) refuse(std::strerror(errno));
    std::string text(size, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(size));
    if (stream.bad() || static_cast<std::uintmax_t>(stream.gcount()) != size)
        refuse("could not be read to its end");
    return text;
}

SceneDocument::SceneDocument(const std::string& path, const std::string& text)
    : path_(path), sources_{{text, {}}}, root_(parse_file(path, text))
{
}

SceneValue SceneDocument::override_value(std::string_view value, int source) const
{
    const auto& [text, assignment] = sources_[static_cast<std::size_t>(source)];
    if (std::optional<SceneValue> parsed = parse_override(text, source)) return *parsed;
    if (!is_bare_word(value))
        refuse_override(assignment, value.empty() ? "has no value" : "the value is not TOML",
                        "KEY=VALUE, the value as in a scene file (a bare word is a string)");
    SceneValue word;
    word.kind = SceneValue::Kind::Text;
    word.text = value;
    word.source = source;
    word.column = static_cast<int>(kOverrideKey.size()) + 1;
    word.end_column = word.column + static_cast<int>(value.size());
    word.is_shown = true;
    return word;
}

void SceneDocument::set(std::string_view assignment)
{
    const std::size_t equals = assignment.find('=');
    if (equals == std::string_view::npos || equals == 0)
        refuse_override(assignment, "is not an assignment", "KEY=VALUE");
    if (find_invalid_utf8(assignment) != std::string_view::npos)
        refuse_override(assignment, "is not UTF-8", "UTF-8");
    const std::string_view key = assignment.substr(0, equals), value = assignment.substr(equals + 1);
    const int source = static_cast<int>(sources_.size());
    sources_.push_back({std::string(kOverrideKey) + std::string(value), std::string(assignment)});
    OverrideWalk(root_, assignment, source).to(key) = override_value(value, source);
}

const SceneValue* SceneDocument::find(std::string_view key) const
{
    const SceneValue* value = &root_;
    for (const std::string_view part : split_key(key)) {
        if (value->kind == SceneValue::Kind::Array) {
            const std::optional<std::size_t> index = parse_index(part);
            value = index && *index < value->items.size() ? &value->items[*index] : nullptr;
        } else {
            value = value->member(part);
        }
        if (!value) return nullptr;
    }
    return value;
}

const SceneValue& SceneDocument::nearest(std::string_view key) const
{
    while (!key.empty()) {
        if (const SceneValue* value = find(key)) return *value;
        key = key.substr(0, key.rfind('.') == std::string_view::npos ? 0 : key.rfind('.'));
    }
    return root_;
}

std::string SceneDocument::quote(const SceneValue& value) const
{
    const std::string& text = sources_[static_cast<std::size_t>(value.source)].text;
    const std::size_t begin = byte_of_place(text, value.line, value.column);
    const std::size_t end = byte_of_place(text, value.end_line, value.end_column);
    std::string written = text.substr(begin, std::max(end, begin) - begin);
    std::replace(written.begin(), written.end(), '\n', ' ');
    std::erase(written, '\r');
    return printable(written, kMaxShownCharacters);
}

std::string SceneDocument::describe(std::string_view key) const
{
    const SceneValue& near = nearest(key);
    const std::string& assignment = sources_[static_cast<std::size_t>(near.source)].assignment;
    const std::string place = near.source == 0
                                  ? fmt::format("{}:{}", printable(path_), near.line)
                                  : fmt::format("--set {}", printable(assignment, kMaxShownOverride));
    if (assignment.starts_with(fmt::format("{}=", key))) return place;  // contains key and value
    const SceneValue* value = find(key);
    const std::string shown = printable(key, 2 * kMaxShownCharacters);
    if (!value || !value->is_shown) return fmt::format("{}: {}", place, shown);
    return fmt::format("{}: {} = {}", place, shown, quote(*value));
}

void SceneDocument::fail(std::string_view key, std::string_view wrong, std::string_view allowed) const
{
    std::string line = fmt::format("{}: {}", describe(key), wrong);
    if (!allowed.empty()) line += fmt::format("; allowed: {}", allowed);
    throw InputError(line);
}

}  // namespace arris
