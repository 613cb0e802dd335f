// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/formats/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"

namespace arris {
namespace {

// More properties than any exporter writes. Bounds the work per element, as a header could declare any number
// of them.
constexpr std::size_t kMostProperties = 1000;

constexpr std::array<PlyType, 16> kTypes = {{{"char", 1, true, false},
                                             {"uchar", 1, false, false},
                                             {"short", 2, true, false},
                                             {"ushort", 2, false, false},
                                             {"int", 4, true, false},
                                             {"uint", 4, false, false},
                                             {"float", 4, true, true},
                                             {"double", 8, true, true},
                                             {"int8", 1, true, false},
                                             {"uint8", 1, false, false},
                                             {"int16", 2, true, false},
                                             {"uint16", 2, false, false},
                                             {"int32", 4, true, false},
                                             {"uint32", 4, false, false},
                                             {"float32", 4, true, true},
                                             {"float64", 8, true, true}}};

PlyType type_of(std::string_view name)
{
    const auto found =
        std::find_if(kTypes.begin(), kTypes.end(), [&](const PlyType& type) { return type.name == name; });
    if (found == kTypes.end())
        throw InputError(fmt::format("its header has a property of unknown type '{}'", excerpt(name)));
    return *found;
}

class HeaderReader {
  public:
    explicit HeaderReader(std::string_view bytes) : bytes_(bytes), rest_(bytes) {}

    PlyHeader read()
    {
        for (const char* end : {"\r\n", "\n", "\r"})
            if (line_end_.empty() && bytes_.starts_with(std::string("ply") + end)) line_end_ = end;
        if (line_end_.empty()) throw InputError("not a PLY file");
        next_line();
        for (;;) {
            std::string_view words = next_line();
            const std::string_view keyword = take_word(words);
            if (keyword == "end_header") break;
            if (keyword == "format") read_format(take_word(words));
            if (keyword == "element") read_element(words);
            if (keyword == "property") read_property(words);
        }
        if (!has_format_) throw InputError("its header names no format");
        header_.size = bytes_.size() - rest_.size();
        return header_;
    }

  private:
    // Every line of a header ends as its first does: a binary body may begin with any byte.
    std::string_view next_line()
    {
        const std::size_t end = rest_.find(line_end_);
        if (end == std::string_view::npos) throw InputError("truncated: its header has no 'end_header'");
        const std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(end + line_end_.size());
        ++header_.lines;
        return line;
    }

    void read_format(std::string_view word)
    {
        if (word == "ascii")
            header_.format = PlyFormat::Text;
        else if (word == "binary_little_endian")
            header_.format = PlyFormat::LittleEndian;
        else if (word == "binary_big_endian")
            header_.format = PlyFormat::BigEndian;
        else
            throw InputError(
                "its header names an unknown format; allowed: ascii, binary_little_endian, "
                "binary_big_endian");
        has_format_ = true;
    }

    void read_element(std::string_view words)
    {
        PlyElement element;
        element.name = take_word(words);
        const std::string_view digits = take_word(words);
        const auto [end, error] =
            std::from_chars(digits.data(), digits.data() + digits.size(), element.count);
        if (error != std::errc() || end != digits.data() + digits.size() || digits.empty())
            throw InputError(fmt::format("its header has no count for element '{}'", excerpt(element.name)));
        // Each element takes at least one byte.
        if (element.count > bytes_.size())
            throw InputError(fmt::format("its header counts {} of element '{}', but the file has {} bytes",
                                         element.count, excerpt(element.name), bytes_.size()));
        for (const PlyElement& other : header_.elements)
            if (other.name == element.name)
                throw InputError(fmt::format("its header has the element '{}' twice", excerpt(element.name)));
        header_.elements.push_back(element);
    }

    void read_property(std::string_view words)
    {
        if (header_.elements.empty()) throw InputError("its header has a property before any element");
        PlyProperty property;
        std::string_view type = take_word(words);
        if (type == "list") {
            property.count = type_of(take_word(words));
            if (property.count.is_float) throw InputError("its header has a list whose count is no integer");
            type = take_word(words);
        }
        property.value = type_of(type);
        property.name = to_lower(take_word(words));
        std::vector<PlyProperty>& properties = header_.elements.back().properties;
        properties.push_back(property);
        if (properties.size() > kMostProperties)
            throw InputError(fmt::format("its header has more than {} properties", kMostProperties));
    }

    std::string_view bytes_;
    std::string_view rest_;
    std::string line_end_;
    bool has_format_ = false;
    PlyHeader header_;
};

}  // namespace

int PlyElement::find(std::initializer_list<std::string_view> names) const
{
    for (std::size_t k = 0; k < properties.size(); ++k)
        if (std::find(names.begin(), names.end(), properties[k].name) != names.end())
            return static_cast<int>(k);
    return -1;
}

PlyHeader read_ply_header(std::string_view bytes)
{
    return HeaderReader(bytes).read();
}

}  // namespace arris
