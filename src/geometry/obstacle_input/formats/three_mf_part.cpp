// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/formats/three_mf_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <utility>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/formats/xml_elements.h"

namespace arris {
namespace {

constexpr std::string_view kFamily = "http://schemas.microsoft.com/3dmanufacturing/";
constexpr std::string_view kCore = "http://schemas.microsoft.com/3dmanufacturing/core/";
constexpr std::string_view kProduction = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";

// Extensions, by the part of their namespace after kFamily, whose absence from a reader changes no shape:
// colours, identifiers, groups of triangles.
// Alternatives (production/alternatives/) hold the full shape of an object whose own mesh is a sketch.
constexpr std::array<std::string_view, 4> kShapeless = {"core/", "production/20", "material/",
                                                        "trianglesets/"};

bool is_shapeless(std::string_view space)
{
    if (!space.starts_with(kFamily)) return false;
    space.remove_prefix(kFamily.size());
    return std::any_of(kShapeless.begin(), kShapeless.end(),
                       [&](auto name) { return space.starts_with(name); });
}

std::string_view trimmed(std::string_view text)
{
    text.remove_prefix(std::min(text.find_first_not_of(kXmlSpace), text.size()));
    return text.substr(0, text.find_last_not_of(kXmlSpace) + 1);
}

std::string quote(std::string_view text)
{
    return one_line(text.substr(0, kLongestQuote));
}

std::vector<std::string_view> split(std::string_view text)
{
    std::vector<std::string_view> words;
    for (std::size_t begin = text.find_first_not_of(kXmlSpace); begin != std::string_view::npos;) {
        const std::size_t end = std::min(text.find_first_of(kXmlSpace, begin), text.size());
        words.push_back(text.substr(begin, end - begin));
        begin = text.find_first_not_of(kXmlSpace, end);
    }
    return words;
}

double metres_of(std::string_view unit)
{
    constexpr std::array<std::pair<std::string_view, double>, 6> kUnits = {{{"micron", 1e-6},
                                                                            {"millimeter", 1e-3},
                                                                            {"centimeter", 1e-2},
                                                                            {"inch", 0.0254},
                                                                            {"foot", 0.3048},
                                                                            {"meter", 1.0}}};
    for (const auto& [name, metres] : kUnits)
        if (unit == name) return metres;
    throw InputError(fmt::format("its unit '{}' is none of micron, millimeter, centimeter, inch, foot, meter",
                                 quote(unit)));
}

class PartReader {
  public:
    ThreeMfPart read(std::string_view xml)
    {
        XmlVisitor visitor;
        visitor.begin = [&](const XmlElement& element) { begin(element); };
        visitor.end = [&](const XmlName& name) { end(name); };
        visitor.declare = [&](std::string_view prefix, std::string_view uri) {
            prefixes_[std::string(prefix)] = uri;
        };
        visit_xml(xml, visitor);
        return std::move(part_);
    }

  private:
    // Some writers leave out the namespace of the core.
    static bool is_core(const XmlName& name) { return name.space.empty() || name.space.starts_with(kCore); }

    void begin(const XmlElement& element)
    {
        const std::string_view name = element.name.local;
        if (!has_model_ && !(is_core(element.name) && name == "model"))
            throw InputError(fmt::format("no 3MF model: it begins with <{}>", quote(name)));
        has_model_ = true;
        if (!is_core(element.name)) return note_foreign(element.name);
        if (name == "model") take_model(element);
        if (name == "object") take_object(element);
        if (name == "item") part_.items.push_back(reference(element));
        if (object_ == nullptr) return;
        if (name == "vertex") take_vertex(element);
        if (name == "triangle") take_triangle(element);
        if (name == "component") object_->components.push_back(reference(element));
    }

    void end(const XmlName& name)
    {
        if (!is_core(name) || name.local != "object" || object_ == nullptr) return;
        require_indices();
        object_ = nullptr;
    }

    // Extensions put shapes inside an object; others put data of their own at its side. Elements of vendors
    // may be left out, as the file does not require their extensions.
    void note_foreign(const XmlName& name)
    {
        if (object_ == nullptr || is_shapeless(name.space)) return;
        const bool is_of_family = name.space.starts_with(kFamily);
        std::string& noted = is_of_family ? object_->foreign : object_->unread;
        if (noted.empty()) noted = quote(name.local);
    }

    static std::string_view require(const XmlElement& element, std::string_view attribute)
    {
        const auto value = element.find(attribute);
        if (!value)
            throw InputError(fmt::format("<{}> has no attribute '{}'", quote(element.name.local), attribute));
        return trimmed(*value);
    }

    void take_model(const XmlElement& element)
    {
        if (const auto unit = element.find("unit")) part_.metres_per_unit = metres_of(*unit);
        for (const std::string_view prefix : split(element.find("requiredextensions").value_or(""))) {
            const auto found = prefixes_.find(prefix);
            if (found == prefixes_.end() || !is_shapeless(found->second))
                throw InputError(fmt::format(
                    "it requires the 3MF extension '{}' ({}), which is not read; allowed: production, "
                    "materials, "
                    "triangle sets",
                    quote(prefix), found == prefixes_.end() ? "not declared" : one_line(found->second)));
        }
    }

    void take_object(const XmlElement& element)
    {
        id_ = require(element, "id");
        const auto [found, is_new] = part_.objects.try_emplace(id_);
        if (!is_new) throw InputError(fmt::format("two objects have the id {}", quote(id_)));
        object_ = &found->second;
        object_->type = element.find("type").value_or("model");
        constexpr std::array<std::string_view, 5> kTypes = {"model", "solidsupport", "support", "surface",
                                                            "other"};
        if (std::find(kTypes.begin(), kTypes.end(), object_->type) == kTypes.end())
            throw InputError(fmt::format("object {}: its type '{}' is none of {}", quote(id_),
                                         quote(object_->type), fmt::join(kTypes, ", ")));
    }

    [[noreturn]] void refuse(const std::string& why) const
    {
        throw InputError(fmt::format("object {}: {}", quote(id_), why));
    }

    void take_vertex(const XmlElement& element)
    {
        Vec3 p;
        constexpr std::array<std::string_view, 3> kAxes = {"x", "y", "z"};
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view word = require(element, kAxes[axis]);
            const ParsedNumber number = parse_number(word);
            if (number.error != NumberError::None)
                refuse(fmt::format("vertex {}: '{}' is no number in double precision",
                                   object_->points.size() + 1, quote(word)));
            p[axis] = number.value;
        }
        if (!p.allFinite())
            refuse(fmt::format("vertex {} ({}, {}, {}) is not finite", object_->points.size() + 1, p.x(),
                               p.y(), p.z()));
        object_->points.push_back(p);
    }

    void take_triangle(const XmlElement& element)
    {
        Face face{};
        constexpr std::array<std::string_view, 3> kCorners = {"v1", "v2", "v3"};
        for (int k = 0; k < 3; ++k) {
            const std::string_view word = require(element, kCorners[k]);
            const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), face[k]);
            if (error != std::errc() || end != word.data() + word.size() || face[k] < 0)
                refuse(fmt::format("face {}: '{}' is no index of a vertex", object_->faces.size() + 1,
                                   quote(word)));
        }
        object_->faces.push_back(face);
    }

    void require_indices() const
    {
        const std::size_t count = object_->points.size();
        for (std::size_t f = 0; f < object_->faces.size(); ++f)
            for (const int p : object_->faces[f])
                if (static_cast<std::size_t>(p) >= count)
                    refuse(fmt::format("face {} names vertex {}, but there are {}", f + 1, p + 1LL, count));
    }

    // A transform m00 m01 m02 m10 ... m32 acts on rows: (x, y, z, 1) times a matrix of 4 rows and 3 columns.
    static ThreeMfReference reference(const XmlElement& element)
    {
        ThreeMfReference made;
        made.object = require(element, "objectid");
        made.path = element.find("path", kProduction).value_or("");
        const auto transform = element.find("transform");
        if (!transform) return made;
        const std::vector<std::string_view> words = split(*transform);
        std::array<double, 12> numbers{};
        for (std::size_t k = 0; k < std::min(words.size(), numbers.size()); ++k) {
            const ParsedNumber number = parse_number(words[k]);
            if (number.error == NumberError::None && std::isfinite(number.value))
                numbers[k] = number.value;
            else
                throw InputError(fmt::format("transform '{}': '{}' is no finite number", quote(*transform),
                                             quote(words[k])));
        }
        if (words.size() != numbers.size())
            throw InputError(
                fmt::format("transform '{}' has {} numbers; allowed: 12", quote(*transform), words.size()));
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column) made.turn(column, row) = numbers[3 * row + column];
        made.shift = {numbers[9], numbers[10], numbers[11]};
        return made;
    }

    ThreeMfPart part_;
    ThreeMfObject* object_ = nullptr;  // being read
    std::string id_;
    bool has_model_ = false;
    std::map<std::string, std::string, std::less<>> prefixes_;  // with the namespaces that they stand for
};

}  // namespace

ThreeMfPart read_three_mf_part(std::string_view xml)
{
    return PartReader().read(xml);
}

}  // namespace arris
