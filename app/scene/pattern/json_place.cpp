// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/pattern/json_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "app/text/printable.h"
#include "geometry/input_error.h"
#include "geometry/mesh_text.h"

namespace arris {
namespace {

using Json = nlohmann::json;

// Line and column of a byte, both from 1.
std::string place_of(const std::string& text, std::size_t byte)
{
    const std::size_t end = std::min(byte, text.size());
    const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n') + 1;
    const std::size_t last = end == 0 ? std::string::npos : text.rfind('\n', end - 1);
    return fmt::format("{}:{}", line, last == std::string::npos ? end + 1 : end - last);
}

std::string in_words(const Json& value)
{
    if (value.is_array()) return fmt::format("an array of {}", counted(std::ssize(value), "value", "values"));
    if (value.is_object())
        return fmt::format("an object of {}", counted(std::ssize(value), "member", "members"));
    if (value.is_string())
        return fmt::format("\"{}\"", printable(value.get_ref<const std::string&>(), kLongestQuote));
    return value.dump();
}

}  // namespace

Json parse_json(const std::string& file, const std::string& text)
{
    const std::string name = printable(file);
    int count = 0;
    const auto check = [&](int depth, Json::parse_event_t, const Json&) {
        if (depth > kDeepestJson)
            throw InputError(fmt::format("{}: nests values more than {} deep; allowed: {}", name,
                                         kDeepestJson, kDeepestJson));
        if (++count > 2 * kMostJsonValues)
            throw InputError(fmt::format("{}: has too many values; allowed: {}", name, kMostJsonValues));
        return true;
    };
    std::string_view body;
    try {
        body = skip_byte_order_mark(text);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", name, error.what()));
    }
    try {
        return Json::parse(body, check);
    } catch (const Json::parse_error& error) {
        throw InputError(fmt::format("{}:{}: is not JSON; allowed: a GarmentCode pattern (JSON)", name,
                                     place_of(text, error.byte == 0 ? 0 : error.byte - 1)));
    } catch (const Json::exception& error) {
        throw InputError(
            fmt::format("{}: {}; allowed: numbers in double precision", name, printable(error.what(), 200)));
    }
}

JsonPlace::JsonPlace(const JsonPlace& parent, const Json& value, const std::string& step)
    : file_(parent.file_), value_(&value), path_(parent.path_ + step)
{
}

bool JsonPlace::has(const std::string& name) const
{
    if (!value_->is_object()) refuse("an object");
    const auto found = value_->find(name);
    return found != value_->end() && !found->is_null();
}

JsonPlace JsonPlace::member(const std::string& name) const
{
    const std::string shown = printable(name, kLongestQuote);
    if (!has(name)) refuse(fmt::format("has no \"{}\"", shown), fmt::format("an object with \"{}\"", shown));
    return {*this, *value_->find(name), path_.empty() ? shown : "." + shown};
}

JsonPlace JsonPlace::element(std::size_t index) const
{
    if (!value_->is_array()) refuse("an array");
    return {*this, (*value_)[index], fmt::format("[{}]", index)};
}

std::size_t JsonPlace::size(std::size_t least, std::size_t most, const std::string& allowed) const
{
    if (!value_->is_array() || value_->size() < least || value_->size() > most) refuse(allowed);
    return value_->size();
}

double JsonPlace::number(double least, double most) const
{
    const double number = value_->is_number() ? value_->get<double>() : NAN;
    if (!(number >= least && number <= most)) refuse(fmt::format("numbers from {:g} to {:g}", least, most));
    return number;
}

int JsonPlace::whole_number(int least, int most) const
{
    const double wide = number(least, most);
    const int whole = static_cast<int>(wide);
    if (static_cast<double>(whole) < wide || static_cast<double>(whole) > wide)
        refuse(fmt::format("whole numbers from {} to {}", least, most));
    return whole;
}

bool JsonPlace::flag() const
{
    if (value_->is_boolean()) return value_->get<bool>();
    return whole_number(0, 1) == 1;
}

std::string JsonPlace::text() const
{
    if (!value_->is_string()) refuse("a text");
    return value_->get<std::string>();
}

void JsonPlace::refuse(const std::string& allowed) const
{
    refuse("is " + in_words(*value_), allowed);
}

void JsonPlace::refuse(const std::string& wrong, const std::string& allowed) const
{
    throw InputError(fmt::format("{}: {}{}; allowed: {}", printable(*file_),
                                 path_.empty() ? "" : path_ + ": ", wrong, allowed));
}

}  // namespace arris
