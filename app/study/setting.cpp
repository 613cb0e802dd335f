// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/setting.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <iterator>
#include <string_view>

namespace arris {
namespace {

constexpr const char* kResolution = "cloth.resolution";

// A basic string of TOML.
std::string quote(const std::string& text)
{
    std::string quoted = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\')
            quoted += std::string("\\") + c;
        else if (byte < 0x20 || byte == 0x7f)
            quoted += fmt::format("\\u{:04x}", byte);
        else
            quoted += c;
    }
    return quoted + "\"";
}

std::string to_toml(const SceneValue& value)
{
    switch (value.kind) {
        case SceneValue::Kind::Text:
            return quote(value.text);
        case SceneValue::Kind::Integer:
            return fmt::format("{}", value.integer);
        case SceneValue::Kind::Number:
            return fmt::format("{}", value.number);
        case SceneValue::Kind::Boolean:
            return value.boolean ? "true" : "false";
        case SceneValue::Kind::Array: {
            std::vector<std::string> items;
            std::transform(value.items.begin(), value.items.end(), std::back_inserter(items), to_toml);
            return fmt::format("[{}]", fmt::join(items, ", "));
        }
        case SceneValue::Kind::Table: {
            std::vector<std::string> members;
            for (const auto& [name, member] : value.members)
                members.push_back(fmt::format("{} = {}", quote(name), to_toml(member)));
            return fmt::format("{{ {} }}", fmt::join(members, ", "));
        }
        case SceneValue::Kind::Date:
            break;
    }
    assert(false && "the caller has refused dates");
    return "";
}

bool is_number(const SceneValue& value)
{
    return value.kind == SceneValue::Kind::Integer || value.kind == SceneValue::Kind::Number;
}

std::optional<double> number_of(const std::string& key, const SceneValue& value)
{
    if (is_number(value)) return value.number;
    if (without_piece(key) != kResolution || value.kind != SceneValue::Kind::Array || value.items.empty())
        return std::nullopt;
    if (!std::all_of(value.items.begin(), value.items.end(), is_number)) return std::nullopt;
    double most = 0.0;
    for (const SceneValue& item : value.items) most = std::max(most, item.number);
    return most;
}

}  // namespace

bool has_date(const SceneValue& value)
{
    return value.kind == SceneValue::Kind::Date ||
           std::any_of(value.items.begin(), value.items.end(), has_date) ||
           std::any_of(value.members.begin(), value.members.end(),
                       [](const auto& member) { return has_date(member.second); });
}

Setting make_setting(const std::string& key, const SceneValue& value)
{
    const std::string toml = to_toml(value);
    return {key, toml, value.kind == SceneValue::Kind::Text ? value.text : toml, number_of(key, value)};
}

std::string without_piece(const std::string& key)
{
    constexpr std::string_view kCloth = "cloth.";
    if (!key.starts_with(kCloth)) return key;
    const std::size_t end = key.find_first_not_of("0123456789", kCloth.size());
    const bool is_index = end != std::string::npos && end > kCloth.size() && key[end] == '.';
    return is_index ? std::string(kCloth) + key.substr(end + 1) : key;
}

std::string assignment(const Setting& setting)
{
    return setting.key + "=" + setting.toml;
}

const Setting* find_setting(const std::vector<Setting>& settings, const std::string& key)
{
    const auto found = std::find_if(settings.begin(), settings.end(),
                                    [&](const Setting& setting) { return setting.key == key; });
    return found == settings.end() ? nullptr : &*found;
}

bool is_numerical_key(const std::string& key)
{
    constexpr std::array<std::string_view, 5> kTables = {"time.", "eol.", "solver.", "remesh.", "output."};
    constexpr std::array<std::string_view, 4> kKeys = {kResolution, "cloth.pattern", "cloth.pattern_angle",
                                                       "cloth.edge_length"};
    return std::any_of(kTables.begin(), kTables.end(), [&](auto table) { return key.starts_with(table); }) ||
           std::find(kKeys.begin(), kKeys.end(), without_piece(key)) != kKeys.end();
}

std::string label_setting(const Setting& setting)
{
    if (setting.key == "eol.enabled") return setting.text == "true" ? "EOL" : "rows only";
    if (setting.key == "time.integrator" || setting.key == "cloth.pattern") return setting.text;
    return setting.key + " = " + setting.text;
}

std::string list_settings(const std::vector<Setting>& settings)
{
    std::vector<std::string> parts;
    for (const Setting& setting : settings) parts.push_back(setting.key + " = " + setting.text);
    return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace arris
