// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/formats/dae_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/formats/xml_elements.h"

namespace arris {
namespace {

// Placements of a node, and how many numbers each has.
constexpr std::array<std::pair<std::string_view, std::uint64_t>, 6> kPlacements = {
    {{"matrix", 16}, {"translate", 3}, {"rotate", 4}, {"scale", 3}, {"lookat", 9}, {"skew", 7}}};

constexpr std::array<std::string_view, 7> kPrimitives = {"triangles",  "polylist",  "polygons", "lines",
                                                         "linestrips", "tristrips", "trifans"};

std::string shown(std::string_view text)
{
    return one_line(excerpt(text));
}

std::optional<std::uint64_t> whole_number(std::string_view word)
{
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size() || word.empty()) return std::nullopt;
    return number;
}

class DaeCheck {
  public:
    void run(std::string_view bytes)
    {
        XmlVisitor visitor;
        visitor.begin = [&](const XmlElement& element) { begin(element); };
        visitor.end = [&](const XmlName& name) { end(name.local); };
        visitor.text = [&](std::string_view text) {
            if (is_reading_) text_ += text;
        };
        visit_xml(bytes, visitor);
    }

  private:
    enum class Content { None, Numbers, Indices };

    [[noreturn]] void refuse(const std::string& why) const
    {
        throw InputError(fmt::format("line {}: {}", line_, why));
    }

    std::string_view parent() const
    {
        return open_.empty() ? std::string_view() : std::string_view(open_.back());
    }

    void begin(const XmlElement& element)
    {
        const std::string_view name = element.name.local;
        line_ = element.line;
        if (name == "ph")
            refuse(
                "a polygon with holes (<ph>), which is not read; allowed: polygons without holes, triangles");
        if (name == "unit") check_unit(element);
        if (name == "vertices") has_positions_ = false;
        if (name == "input" && parent() == "vertices" && element.find("semantic") == "POSITION")
            has_positions_ = true;
        if (name == "accessor") check_accessor(element);
        start_reading(element);
        open_.emplace_back(name);
    }

    // Decides what the element's text must be.
    void start_reading(const XmlElement& element)
    {
        const std::string_view name = element.name.local;
        content_ = Content::None;
        count_.reset();
        if (name == "float_array") {
            content_ = Content::Numbers;
            count_ = whole_number(element.find("count").value_or(""));
            if (!count_) refuse("a <float_array> has no whole number as its 'count'");
            array_sizes_[std::string("#").append(element.find("id").value_or(""))] = *count_;
        }
        const bool is_primitive =
            std::find(kPrimitives.begin(), kPrimitives.end(), parent()) != kPrimitives.end();
        if (is_primitive && (name == "p" || name == "vcount")) content_ = Content::Indices;
        if (parent() == "node")
            for (const auto& [placement, count] : kPlacements)
                if (name == placement) {
                    content_ = Content::Numbers;
                    count_ = count;
                }
        is_reading_ = content_ != Content::None;
        text_.clear();
    }

    void end(std::string_view name)
    {
        if (std::exchange(is_reading_, false)) check_text(name);
        if (name == "vertices" && !has_positions_)
            refuse("<vertices> has no input with the semantic POSITION");
        open_.pop_back();
    }

    void check_text(std::string_view name)
    {
        std::uint64_t found = 0;
        std::string_view rest = text_;
        for (;; ++found) {
            rest.remove_prefix(std::min(rest.find_first_not_of(kXmlSpace), rest.size()));
            if (rest.empty()) break;
            const std::string_view word = rest.substr(0, rest.find_first_of(kXmlSpace));
            rest.remove_prefix(word.size());
            const bool is_right = content_ == Content::Indices
                                      ? whole_number(word).has_value()
                                      : parse_number(word).error == NumberError::None;
            if (!is_right)
                refuse(fmt::format("<{}>: '{}' is no {}", shown(name), shown(word),
                                   content_ == Content::Indices ? "whole number of at least 0"
                                                                : "number in double precision"));
        }
        if (count_ && found != *count_)
            refuse(fmt::format("<{}> has {}; allowed: {}", shown(name),
                               counted(static_cast<long long>(found), "number", "numbers"), *count_));
    }

    void check_unit(const XmlElement& element) const
    {
        const auto meter = element.find("meter");
        if (!meter) return;
        const ParsedNumber number = parse_number(*meter);
        if (number.error != NumberError::None || !(number.value > 0.0 && std::isfinite(number.value)))
            refuse(fmt::format("its unit is '{}' m; allowed: a positive number", shown(*meter)));
    }

    void check_accessor(const XmlElement& element) const
    {
        const auto found = array_sizes_.find(std::string(element.find("source").value_or("")));
        if (found == array_sizes_.end()) return;
        const auto count = whole_number(element.find("count").value_or(""));
        const auto stride = whole_number(element.find("stride").value_or("1"));
        const auto offset = whole_number(element.find("offset").value_or("0"));
        if (!count || !stride || !offset)
            refuse("an <accessor> has a count, stride or offset that is no whole number");
        const double reach =
            static_cast<double>(*offset) + static_cast<double>(*count) * static_cast<double>(*stride);
        if (reach > static_cast<double>(found->second))
            refuse(
                fmt::format("an <accessor> of {} elements, {} numbers each, reaches beyond its array of {}",
                            *count, *stride, found->second));
    }

    unsigned long line_ = 1;  // of the element that began last
    std::vector<std::string> open_;
    std::map<std::string, std::uint64_t> array_sizes_;  // by reference
    bool has_positions_ = false;
    Content content_ = Content::None;
    std::optional<std::uint64_t> count_;
    bool is_reading_ = false;
    std::string text_;
};

}  // namespace

void check_dae(std::string_view bytes)
{
    DaeCheck().run(bytes);
}

}  // namespace arris
