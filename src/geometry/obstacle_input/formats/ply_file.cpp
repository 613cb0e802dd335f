// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/formats/ply_file.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/formats/ply_header.h"

namespace arris {
namespace {

// What a reader does with an element.
enum class Kind { Vertices, Faces, Strips, Unread };

class PlyReader {
  public:
    explicit PlyReader(std::string_view bytes) : header_(read_ply_header(bytes)), rest_(bytes)
    {
        rest_.remove_prefix(header_.size);
        line_ = header_.lines;
    }

    PlainMesh read()
    {
        for (const PlyElement& element : header_.elements) prepare(element);
        if (vertex_count_ == 0) throw InputError("no vertices");
        for (const PlyElement& element : header_.elements) {
            if (element.count > 0 && element.properties.empty())
                throw InputError(
                    fmt::format("its header gives element '{}' no properties", excerpt(element.name)));
            kind_ = kind_of(element);
            used_ = used_properties(element);
            for (number_ = 0; number_ < element.count; ++number_) read_element(element);
        }
        if (mesh_.corners.empty() && mesh_.segments.empty() && mesh_.lone_points.empty())
            for (std::size_t p = 0; p < mesh_.points.size(); ++p)
                mesh_.lone_points.push_back(static_cast<int>(p));
        return std::move(mesh_);
    }

  private:
    static Kind kind_of(const PlyElement& element)
    {
        if (element.name == "vertex") return Kind::Vertices;
        if (element.name == "face") return Kind::Faces;
        return element.name == "tristrips" ? Kind::Strips : Kind::Unread;
    }

    void prepare(const PlyElement& element)
    {
        const Kind kind = kind_of(element);
        if (element.count == 0) return;
        if (kind == Kind::Vertices) {
            vertex_count_ = element.count;
            for (const char* axis : {"x", "y", "z"})
                if (const int k = element.find({axis}); k < 0 || element.properties[k].is_list())
                    throw InputError(fmt::format(
                        "its vertices have no property '{}'; allowed: vertices with x, y and z", axis));
            const PlyType& type = element.properties[element.find({"x"})].value;
            mesh_.is_single = header_.format != PlyFormat::Text && type.is_float && type.size == 4;
        } else if (kind == Kind::Unread) {
            note_unread(element);
        } else {
            const int k = element.find({"vertex_indices", "vertex_index"});
            if (k < 0 || !element.properties[k].is_list())
                throw InputError(
                    fmt::format("its element '{}' has no list of vertices; allowed: 'property list uchar int "
                                "vertex_indices', or 'vertex_index'",
                                excerpt(element.name)));
        }
    }

    // In a file without faces, a list in an unknown element may be the faces under another name.
    void note_unread(const PlyElement& element)
    {
        bool has_faces = false;
        for (const PlyElement& other : header_.elements)
            has_faces |= other.count > 0 && (kind_of(other) == Kind::Faces || kind_of(other) == Kind::Strips);
        for (const PlyProperty& property : element.properties)
            if (property.is_list() && !has_faces)
                throw InputError(fmt::format(
                    "it has no faces, but an unknown element '{}' with a list '{}'; allowed: element 'face' "
                    "with a list 'vertex_indices'",
                    excerpt(element.name), excerpt(property.name)));
        if (element.name == "edge")
            mesh_.warnings.push_back(
                fmt::format("its {} ('element edge') {} not read",
                            counted(static_cast<long long>(element.count), "edge", "edges"),
                            element.count == 1 ? "is" : "are"));
        else
            mesh_.warnings.push_back(
                fmt::format("its element '{}' ({} of it) is not read", excerpt(element.name), element.count));
    }

    std::array<int, 3> used_properties(const PlyElement& element) const
    {
        if (kind_ == Kind::Vertices) return {element.find({"x"}), element.find({"y"}), element.find({"z"})};
        const int list = element.find({"vertex_indices", "vertex_index"});
        return {list, list, list};
    }

    // Elements

    void read_element(const PlyElement& element)
    {
        if (header_.format == PlyFormat::Text) next_text_line(element);
        Vec3 place = Vec3::Zero();
        std::vector<int>& list = list_;
        list.clear();
        for (int k = 0; k < static_cast<int>(element.properties.size()); ++k) {
            const PlyProperty& property = element.properties[k];
            const bool is_list_of_vertices =
                kind_ != Kind::Vertices && kind_ != Kind::Unread && k == used_[0];
            std::uint64_t length = 1;
            if (property.is_list()) length = take_length(property, element);
            for (std::uint64_t i = 0; i < length; ++i) {
                const double value = take(property.value, element);
                if (is_list_of_vertices) list.push_back(index_of(value, element));
                for (int axis = 0; axis < 3 && kind_ == Kind::Vertices; ++axis)
                    if (used_[axis] == k) place[axis] = value;
            }
        }
        if (header_.format == PlyFormat::Text && !take_word(words_).empty())
            refuse(element, "its line has more numbers than the header says");
        if (kind_ == Kind::Vertices) {
            mesh_.points.push_back(place);
            if (header_.format == PlyFormat::Text) mesh_.lines.push_back(line_);
        }
        if (kind_ == Kind::Faces) add_face(list);
        if (kind_ == Kind::Strips) add_strips(list);
    }

    void add_face(const std::vector<int>& corners)
    {
        if (corners.size() == 1) mesh_.lone_points.push_back(corners[0]);
        if (corners.size() == 2) mesh_.segments.push_back({corners[0], corners[1]});
        if (corners.size() >= 3) mesh_.add_polygon(corners);
    }

    // Every other triangle of a strip is turned round. Triangles with a repeated corner join strips.
    void add_strips(const std::vector<int>& list)
    {
        std::size_t start = 0;
        for (std::size_t k = 0; k < list.size(); ++k) {
            if (list[k] < 0) start = k + 1;
            if (k < start + 2) continue;
            const int a = list[k - 2], b = list[k - 1], c = list[k];
            if (a == b || b == c || c == a) continue;
            const bool is_turned = (k - start) % 2 == 1;
            mesh_.add_polygon({a, is_turned ? c : b, is_turned ? b : c});
        }
    }

    int index_of(double value, const PlyElement& element) const
    {
        if (kind_ == Kind::Strips && value < 0.0) return -1;
        if (!(value >= 0.0 && value < static_cast<double>(vertex_count_)) || value != std::floor(value) ||
            value > std::numeric_limits<int>::max())
            throw InputError(fmt::format("{}{} {} names vertex {}, but there are {}, counted from 0", place(),
                                         element.name, number_, value, vertex_count_));
        return static_cast<int>(value);
    }

    // Numbers

    std::string place() const
    {
        return header_.format == PlyFormat::Text ? fmt::format("line {}: ", line_) : "";
    }

    [[noreturn]] void refuse(const PlyElement& element, const std::string& why) const
    {
        throw InputError(
            fmt::format("{}number {} of element '{}': {}", place(), number_ + 1, excerpt(element.name), why));
    }

    [[noreturn]] void refuse_truncated(const PlyElement& element) const
    {
        throw InputError(
            fmt::format("truncated: its header counts {} of element '{}', but the file ends in "
                        "number {}",
                        element.count, excerpt(element.name), number_ + 1));
    }

    // A text has one element a line; empty lines do no harm.
    void next_text_line(const PlyElement& element)
    {
        do {
            if (rest_.empty()) refuse_truncated(element);
            words_ = take_line(rest_);
            ++line_;
        } while (words_.empty());
    }

    std::uint64_t take_length(const PlyProperty& property, const PlyElement& element)
    {
        const double length = take(property.count, element);
        const double left =
            static_cast<double>(header_.format == PlyFormat::Text ? words_.size() : rest_.size());
        if (length > left) refuse_truncated(element);
        if (!(length >= 0.0) || length != std::floor(length))
            refuse(element, fmt::format("the length of its list '{}' is {}", excerpt(property.name), length));
        return static_cast<std::uint64_t>(length);
    }

    double take(const PlyType& type, const PlyElement& element)
    {
        if (header_.format == PlyFormat::Text) return take_text(type, element);
        if (static_cast<std::size_t>(type.size) > rest_.size()) refuse_truncated(element);
        std::uint64_t bits = 0;
        for (int k = 0; k < type.size; ++k) {
            const int at = header_.format == PlyFormat::BigEndian ? k : type.size - 1 - k;
            bits = bits << 8 | static_cast<std::uint8_t>(rest_[at]);
        }
        rest_.remove_prefix(type.size);
        if (type.is_float) return to_float(bits, type.size);
        const int unused = 64 - 8 * type.size;
        if (type.is_signed) return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
        return static_cast<double>(bits);
    }

    static double to_float(std::uint64_t bits, int size)
    {
        double number = 0.0;
        if (size == 8) {
            std::memcpy(&number, &bits, sizeof number);
        } else {
            const auto low = static_cast<std::uint32_t>(bits);
            float single = 0.0f;
            std::memcpy(&single, &low, sizeof single);
            number = single;
        }
        return number;
    }

    double take_text(const PlyType& type, const PlyElement& element)
    {
        const std::string_view word = take_word(words_);
        if (word.empty()) {
            if (rest_.find_first_not_of(" \t\r\n") == std::string_view::npos) refuse_truncated(element);
            refuse(element, "its line has fewer numbers than the header says");
        }
        const ParsedNumber number = parse_number(word);
        if (number.error == NumberError::TooLarge)
            refuse(element, fmt::format("'{}' is beyond double precision", excerpt(word)));
        const bool is_whole = type.is_float || number.value == std::floor(number.value);
        if (number.error != NumberError::None || !is_whole)
            refuse(element, fmt::format("'{}' is no {}number", excerpt(word), type.is_float ? "" : "whole "));
        return number.value;
    }

    PlyHeader header_;
    std::string_view rest_;
    std::string_view words_;  // left of the line of a text
    int line_ = 0;
    Kind kind_ = Kind::Unread;  // of the element that is read
    std::array<int, 3> used_{};
    std::uint64_t number_ = 0;  // from 0, among the elements of its kind
    std::vector<int> list_;
    std::uint64_t vertex_count_ = 0;
    PlainMesh mesh_;
};

}  // namespace

PlainMesh read_ply(std::string_view bytes)
{
    return PlyReader(skip_byte_order_mark(bytes)).read();
}

}  // namespace arris
