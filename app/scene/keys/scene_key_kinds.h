// SPDX-License-Identifier: GPL-3.0-or-later
// The kinds of rows in the table of scene keys (scene_key_table.cpp), and the ranges that many of them share.
#pragma once

#include <string_view>

#include "app/scene/keys/scene_keys.h"

namespace arris {

// Bounds far beyond any real cloth. They keep every product of two values finite.
inline constexpr KeyRange kAnyNumber{-1e6, 1e6};
inline constexpr KeyRange kPositive{0.0, 1e6, true};
inline constexpr KeyRange kNotNegative{0.0, 1e6};
inline constexpr KeyRange kSize{1e-6, 1e4};
inline constexpr KeyRange kAngle{-360.0, 360.0};
inline constexpr KeyRange kTitle{0.0, 200.0};
inline constexpr KeyRange kPath{1.0, 4096.0};

inline constexpr std::string_view kUnits = "m|cm|mm|in";
inline constexpr std::string_view kStarts = "clear|untangle";
inline constexpr std::string_view kAxes = "x|y|z";
inline constexpr std::string_view kOrigin = "[0.0, 0.0, 0.0]";
inline constexpr std::string_view kIdentity = R"({"axis": [0.0, 0.0, 1.0], "degrees": 0.0})";
inline constexpr std::string_view kNever = "null";

inline SceneKey table(std::string_view name, std::string_view fallback, std::string_view sentence)
{
    return {.name = name, .type = KeyType::Table, .fallback = fallback, .sentence = sentence};
}

inline SceneKey tables(std::string_view name, std::string_view sentence)
{
    return {.name = name, .type = KeyType::Tables, .sentence = sentence};
}

/// A table that may also be an array of tables, [[name]], whose elements have the same keys.
inline SceneKey repeatable(SceneKey key)
{
    key.may_repeat = true;
    return key;
}

inline SceneKey number(std::string_view name, std::string_view unit, KeyRange range,
                       std::string_view fallback, std::string_view sentence)
{
    return {.name = name,
            .type = KeyType::Number,
            .unit = unit,
            .range = range,
            .fallback = fallback,
            .sentence = sentence};
}

inline SceneKey integer(std::string_view name, KeyRange range, std::string_view fallback,
                        std::string_view sentence)
{
    return {
        .name = name, .type = KeyType::Integer, .range = range, .fallback = fallback, .sentence = sentence};
}

inline SceneKey numbers(std::string_view name, int count, std::string_view unit, KeyRange range,
                        std::string_view fallback, std::string_view sentence)
{
    return {.name = name,
            .type = KeyType::Numbers,
            .unit = unit,
            .range = range,
            .count = count,
            .fallback = fallback,
            .sentence = sentence};
}

inline SceneKey points(std::string_view name, int least, std::string_view sentence)
{
    return {.name = name,
            .type = KeyType::Points,
            .unit = "m",
            .range = kAnyNumber,
            .count = least,
            .sentence = sentence};
}

/// One polygon of the material, or an array of them.
inline SceneKey polygon(std::string_view name, KeyType type, std::string_view sentence)
{
    return {.name = name, .type = type, .unit = "m", .range = kAnyNumber, .count = 3, .sentence = sentence};
}

inline SceneKey box(std::string_view name, std::string_view sentence)
{
    return {.name = name,
            .type = KeyType::Box,
            .unit = "m",
            .range = kAnyNumber,
            .fallback = kRequired,
            .sentence = sentence};
}

inline SceneKey indices(std::string_view name, std::string_view sentence)
{
    return {.name = name, .type = KeyType::Indices, .range = {0.0, 5e6}, .count = 1, .sentence = sentence};
}

/// A key that may be left out.
inline SceneKey optional(SceneKey key)
{
    key.fallback = {};
    return key;
}

inline SceneKey text(std::string_view name, KeyType type, KeyRange range, std::string_view fallback,
                     std::string_view sentence)
{
    return {.name = name, .type = type, .range = range, .fallback = fallback, .sentence = sentence};
}

inline SceneKey axis(std::string_view name)
{
    return {.name = name,
            .type = KeyType::Axis,
            .range = kAnyNumber,
            .count = 3,
            .fallback = kRequired,
            .sentence = "Axis of the rotation, of any length but zero."};
}

inline SceneKey choice(std::string_view name, std::string_view choices, std::string_view fallback,
                       std::string_view sentence)
{
    return {.name = name,
            .type = KeyType::Choice,
            .choices = choices,
            .fallback = fallback,
            .sentence = sentence};
}

inline SceneKey choices(std::string_view name, int least, std::string_view all, std::string_view fallback,
                        std::string_view sentence)
{
    return {.name = name,
            .type = KeyType::Choices,
            .count = least,
            .choices = all,
            .fallback = fallback,
            .sentence = sentence};
}

inline SceneKey boolean(std::string_view name, std::string_view fallback, std::string_view sentence)
{
    return {.name = name, .type = KeyType::Boolean, .fallback = fallback, .sentence = sentence};
}

/// Marks the given values of a key as not built yet.
inline SceneKey not_built(SceneKey key, std::string_view values)
{
    key.unbuilt_choices = values;
    return key;
}

}  // namespace arris
