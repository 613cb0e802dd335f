// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/ply_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>

#include "geometry/input_error.h"

namespace arris {
namespace {

// More properties than any exporter writes. Bounds the work per element, as a header could declare any number
// of them.
constexpr std::size_t kMostProperties = 1000;

struct PlyType {
    std::string_view name;
    int size;
    bool is_signed;
    bool is_float;
};

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

struct PlyProperty {
    PlyType count{"", 0, false, false};  // count of a list property; size 0 for a property that is no list
    PlyType value{"", 0, false, false};
    bool is_index = false;  // names vertices
};

struct PlyElement {
    std::string_view name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

class PlyCheck {
  public:
    explicit PlyCheck(std::string_view bytes) : bytes_(bytes), rest_(bytes) {}

    std::vector<std::string> run()
    {
        read_header();
        std::vector<std::string> warnings;
        for (const PlyElement& element : elements_) {
            if (element.name == "vertex") vertex_count_ = element.count;
            if (element.name == "edge" && element.count > 0)
                warnings.push_back(fmt::format("its {} edges ('element edge') are not read", element.count));
        }
        if (vertex_count_ == 0) throw InputError("no vertices");
        for (const PlyElement& element : elements_) walk(element);
        return warnings;
    }

  private:
    // Reading the header, line by line

    std::string_view take_line()
    {
        const std::size_t end = rest_.find('\n');
        if (end == std::string_view::npos) throw InputError("truncated: its header has no 'end_header'");
        std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(end + 1);
        if (line.ends_with('\r')) line.remove_suffix(1);
        return line;
    }

    static std::string_view take_word(std::string_view& text)
    {
        constexpr std::string_view kSpace = " \t\r\n\v\f";
        const std::size_t begin = std::min(text.find_first_not_of(kSpace), text.size());
        const std::size_t end = std::min(text.find_first_of(kSpace, begin), text.size());
        const std::string_view word = text.substr(begin, end - begin);
        text.remove_prefix(end);
        return word;
    }

    void read_header()
    {
        if (!bytes_.starts_with("ply\n") && !bytes_.starts_with("ply\r\n"))
            throw InputError("not a PLY file");
        take_line();
        for (;;) {
            std::string_view words = take_line();
            const std::string_view keyword = take_word(words);
            if (keyword == "end_header") break;
            if (keyword == "format") read_format(take_word(words));
            if (keyword == "element") read_element(words);
            if (keyword == "property") read_property(words);
        }
        if (format_.empty()) throw InputError("its header names no format");
    }

    void read_format(std::string_view word)
    {
        if (word != "ascii" && word != "binary_little_endian" && word != "binary_big_endian")
            throw InputError(
                "its header names an unknown format; allowed: ascii, binary_little_endian, "
                "binary_big_endian");
        format_ = word;
    }

    void read_element(std::string_view words)
    {
        PlyElement element;
        element.name = take_word(words);
        const std::string_view digits = take_word(words);
        const auto [end, error] =
            std::from_chars(digits.data(), digits.data() + digits.size(), element.count);
        if (error != std::errc() || end != digits.data() + digits.size() || digits.empty())
            throw InputError(fmt::format("its header has no count for element '{}'", quote(element.name)));
        // Each element takes at least one byte.
        if (element.count > bytes_.size())
            throw InputError(fmt::format("its header counts {} of element '{}', but the file has {} bytes",
                                         element.count, quote(element.name), bytes_.size()));
        elements_.push_back(element);
    }

    void read_property(std::string_view words)
    {
        if (elements_.empty()) throw InputError("its header has a property before any element");
        PlyProperty property;
        std::string_view type = take_word(words);
        if (type == "list") {
            property.count = type_of(take_word(words));
            if (property.count.is_float) throw InputError("its header has a list whose count is no integer");
            type = take_word(words);
        }
        property.value = type_of(type);
        const std::string_view name = take_word(words);
        property.is_index = elements_.back().name == "face" && property.count.size > 0 &&
                            (name == "vertex_indices" || name == "vertex_index") && !property.value.is_float;
        elements_.back().properties.push_back(property);
        if (elements_.back().properties.size() > kMostProperties)
            throw InputError(fmt::format("its header has more than {} properties", kMostProperties));
    }

    static PlyType type_of(std::string_view name)
    {
        const auto found = std::find_if(kTypes.begin(), kTypes.end(),
                                        [&](const PlyType& type) { return type.name == name; });
        if (found == kTypes.end())
            throw InputError(fmt::format("its header has a property of unknown type '{}'", quote(name)));
        return *found;
    }

    static std::string quote(std::string_view word) { return std::string(word.substr(0, 40)); }

    // Body

    void walk(const PlyElement& element)
    {
        if (element.count > 0 && element.properties.empty())
            throw InputError(fmt::format("its header gives element '{}' no properties", quote(element.name)));
        for (std::uint64_t i = 0; i < element.count; ++i)
            for (const PlyProperty& property : element.properties) {
                std::int64_t length = 1;
                if (property.count.size > 0) {
                    length = take(property.count, element, i);
                    if (length < 0 || static_cast<std::uint64_t>(length) > rest_.size())
                        refuse_truncated(element, i);
                }
                if (!property.is_index && format_ != "ascii") {
                    skip(static_cast<std::uint64_t>(length) * property.value.size, element, i);
                    continue;
                }
                for (std::int64_t k = 0; k < length; ++k) {
                    const std::int64_t value = take(property.value, element, i);
                    if (property.is_index &&
                        (value < 0 || static_cast<std::uint64_t>(value) >= vertex_count_))
                        throw InputError(
                            fmt::format("face {} names vertex {}, but there are {}, counted from 0", i, value,
                                        vertex_count_));
                }
            }
    }

    [[noreturn]] static void refuse_truncated(const PlyElement& element, std::uint64_t i)
    {
        throw InputError(
            fmt::format("truncated: its header counts {} of element '{}', but the file ends in "
                        "number {}",
                        element.count, quote(element.name), i + 1));
    }

    void skip(std::uint64_t size, const PlyElement& element, std::uint64_t i)
    {
        if (size > rest_.size()) refuse_truncated(element, i);
        rest_.remove_prefix(size);
    }

    // Reads the next number; returns it if it is an integer type, else 0.
    std::int64_t take(const PlyType& type, const PlyElement& element, std::uint64_t i)
    {
        if (format_ == "ascii") return take_text(type, element, i);
        if (static_cast<std::uint64_t>(type.size) > rest_.size()) refuse_truncated(element, i);
        std::uint64_t bits = 0;
        for (int k = 0; k < type.size; ++k) {
            const int at = format_ == "binary_big_endian" ? k : type.size - 1 - k;
            bits = bits << 8 | static_cast<std::uint8_t>(rest_[at]);
        }
        rest_.remove_prefix(type.size);
        if (type.is_float) return 0;
        const int unused = 64 - 8 * type.size;
        if (type.is_signed) return static_cast<std::int64_t>(bits << unused) >> unused;
        return static_cast<std::int64_t>(bits);
    }

    std::int64_t take_text(const PlyType& type, const PlyElement& element, std::uint64_t i)
    {
        const std::string_view word = take_word(rest_);
        if (word.empty()) refuse_truncated(element, i);
        if (type.is_float) return 0;
        std::int64_t value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc() || end != word.data() + word.size())
            throw InputError(fmt::format("number {} of element '{}': '{}' is no whole number", i + 1,
                                         quote(element.name), quote(word)));
        return value;
    }

    std::string_view bytes_;
    std::string_view rest_;
    std::string_view format_;
    std::vector<PlyElement> elements_;
    std::uint64_t vertex_count_ = 0;
};

}  // namespace

std::vector<std::string> check_ply(std::string_view bytes)
{
    return PlyCheck(bytes).run();
}

}  // namespace arris
