// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace arris {

/// Bounds on a JSON text: values, and how deep arrays and objects are nested. They bound memory.
inline constexpr int kMostJsonValues = 1000000;
inline constexpr int kDeepestJson = 32;

/// Parses a JSON text. Throws InputError, which begins with the file's name, for a text that is no JSON (with
/// line and column), that exceeds the bounds, or that has a number too large for double precision.
nlohmann::json parse_json(const std::string& file, const std::string& text);

/// A value of a JSON file, with its place there. Reading a value of another type throws InputError:
/// "FILE: panels.front.edges[2].label: is 3; allowed: a text". The document must outlive its places.
class JsonPlace {
  public:
    JsonPlace(const std::string& file, const nlohmann::json& root) : file_(&file), value_(&root) {}

    const nlohmann::json& value() const { return *value_; }
    const std::string& path() const { return path_; }

    /// Whether an object has this member, and not as null.
    bool has(const std::string& name) const;
    /// A member of an object; required.
    JsonPlace member(const std::string& name) const;
    /// An element of an array.
    JsonPlace element(std::size_t index) const;
    /// Number of elements of an array, within bounds.
    std::size_t size(std::size_t least, std::size_t most, const std::string& allowed) const;

    double number(double least, double most) const;
    int whole_number(int least, int most) const;
    /// From 0, 1, false or true.
    bool flag() const;
    std::string text() const;

    [[noreturn]] void refuse(const std::string& allowed) const;
    [[noreturn]] void refuse(const std::string& wrong, const std::string& allowed) const;

  private:
    JsonPlace(const JsonPlace& parent, const nlohmann::json& value, const std::string& step);

    const std::string* file_;
    const nlohmann::json* value_;
    std::string path_ = {};
};

}  // namespace arris
