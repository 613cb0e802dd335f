// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/obj_outline.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>
#include <sstream>
#include <string_view>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"

namespace arris {
namespace {

constexpr const char* kVertexForm = "'v x y z', numbers in the file's unit (then a weight, or a colour)";
constexpr const char* kUvForm = "'vt u v', numbers in metres";
constexpr const char* kIndexForm =
    "'f' and at least 3 of vertex, vertex/uv, vertex//normal or "
    "vertex/uv/normal, whole numbers counted from 1 (or back from -1)";

// Longest quotation from a file in a message, in characters.
constexpr std::size_t kLongestQuote = 40;

class OutlineReader {
  public:
    explicit OutlineReader(const std::string& path) : path_(path) {}

    ObjOutline read()
    {
        std::ifstream file(path_, std::ios::binary);
        if (!file) throw InputError(path_ + ": cannot be opened");
        std::ostringstream bytes;
        bytes << file.rdbuf();
        if (file.bad()) throw InputError(path_ + ": cannot be read to its end");
        std::istringstream text(canonical_text(bytes.str()));
        for (std::string line; std::getline(text, line); take(line)) ++line_;
        if (outline_.corner_counts.empty()) refuse_without_faces();
        // A face may name vertices that follow it.
        std::vector<char> is_used(outline_.vertices.size(), 0);
        for (const ObjCorner& corner : outline_.corners) {
            require_in_range(corner);
            is_used[static_cast<std::size_t>(corner.vertex)] = 1;
        }
        outline_.unused_vertex_count = static_cast<int>(std::count(is_used.begin(), is_used.end(), 0));
        return outline_;
    }

  private:
    std::string canonical_text(const std::string& bytes) const
    {
        try {
            return canonical_obj(bytes);
        } catch (const InputError& error) {
            throw InputError(path_ + ": " + error.what());
        }
    }

    void take(const std::string& statement)
    {
        statement_ = statement;
        std::istringstream words(statement_);
        std::string word;
        if (!(words >> word)) return;
        if (word == "v")
            take_vertex(words);
        else if (word == "vt")
            take_uv(words);
        else if (word == "f")
            take_face(words);
        else if (word == "l" || word == "p")
            ++outline_.line_and_point_count;
        else if (word != "#")
            ++other_statements_;
    }

    [[noreturn]] void refuse(const std::string& why, const char* allowed) const
    {
        std::string quote = statement_.substr(0, kLongestQuote);
        if (quote.size() < statement_.size()) quote += "...";
        throw InputError(
            fmt::format("{}, line {}: '{}': {}; allowed: {}", path_, line_, quote, why, allowed));
    }

    [[noreturn]] void refuse_without_faces() const
    {
        throw InputError(fmt::format(
            "{}: no faces among {} vertices, {} lines and points and {} other statements; allowed: "
            "vertices as 'v x y z' and faces of at least 3 of them as 'f 1 2 3'",
            path_, outline_.vertices.size(), outline_.line_and_point_count, other_statements_));
    }

    // --- numbers

    double read_number(std::string_view word, const char* allowed) const
    {
        const ParsedNumber number = parse_number(word);
        if (number.error == NumberError::NoNumber)
            refuse(fmt::format("'{}' is no number", word.substr(0, kLongestQuote)), allowed);
        if (number.error == NumberError::TooLarge)
            refuse(fmt::format("'{}' is beyond double precision", word.substr(0, kLongestQuote)), allowed);
        return number.value;
    }

    std::vector<double> read_numbers(std::istringstream& words, const char* allowed) const
    {
        std::vector<double> numbers;
        for (std::string word; words >> word;) numbers.push_back(read_number(word, allowed));
        return numbers;
    }

    // A fourth number alone is the weight of projective coordinates; more numbers are a colour.
    void take_vertex(std::istringstream& words)
    {
        const std::vector<double> numbers = read_numbers(words, kVertexForm);
        if (numbers.size() < 3)
            refuse(fmt::format("{} numbers, but a vertex has 3", numbers.size()), kVertexForm);
        Vec3 place(numbers[0], numbers[1], numbers[2]);
        if (numbers.size() == 4) place /= numbers[3];
        outline_.vertices.push_back({place, line_});
    }

    void take_uv(std::istringstream& words)
    {
        const std::vector<double> numbers = read_numbers(words, kUvForm);
        if (numbers.size() < 2) refuse(fmt::format("{} numbers, but a UV has 2", numbers.size()), kUvForm);
        outline_.uvs.push_back({{numbers[0], numbers[1]}, line_});
    }

    // --- faces

    void take_face(std::istringstream& words)
    {
        int corners = 0;
        for (std::string word; words >> word; ++corners) take_corner(word);
        if (corners < 3)
            refuse(fmt::format("a face of {} corners; at least 3 are needed", corners), kIndexForm);
        outline_.corner_counts.push_back(corners);
    }

    // vertex, vertex/uv, vertex/uv/normal or vertex//normal
    void take_corner(std::string_view word)
    {
        const std::size_t slash = word.find('/');
        ObjCorner corner{read_index("vertex", word.substr(0, slash), outline_.vertices.size()), -1, line_};
        if (slash != std::string_view::npos) {
            const std::string_view rest = word.substr(slash + 1);
            const std::string_view uv = rest.substr(0, rest.find('/'));
            if (!uv.empty()) corner.uv = read_index("UV", uv, outline_.uvs.size());
        }
        if (!outline_.corners.empty() && (corner.uv < 0) != (outline_.corners.front().uv < 0))
            refuse("some faces have UVs and some have none", "all with UVs, or none");
        outline_.corners.push_back(corner);
    }

    // Returns an index from 0. A negative index counts back from the last of the `count` elements so far.
    int read_index(const char* what, std::string_view word, std::size_t count) const
    {
        long long index = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
        if (error != std::errc() || end != word.data() + word.size())
            refuse(fmt::format("'{}' is no index", word.substr(0, kLongestQuote)), kIndexForm);
        const long long from_one = index < 0 ? static_cast<long long>(count) + index + 1 : index;
        if (from_one < 1 || from_one > std::numeric_limits<int>::max())
            refuse(fmt::format("a face names {} {}, but there are {} so far, counted from 1", what, index,
                               count),
                   kIndexForm);
        return static_cast<int>(from_one - 1);
    }

    void require_in_range(const ObjCorner& corner) const
    {
        require_in_range("vertex", corner.vertex, outline_.vertices.size(), corner.line);
        if (corner.uv >= 0) require_in_range("UV", corner.uv, outline_.uvs.size(), corner.line);
    }

    void require_in_range(const char* what, int index, std::size_t count, int line) const
    {
        if (static_cast<std::size_t>(index) < count) return;
        throw InputError(fmt::format("{}, line {}: a face names {} {}, but there are {}, counted from 1",
                                     path_, line, what, static_cast<long long>(index) + 1, count));
    }

    std::string path_;
    ObjOutline outline_;
    std::string statement_;
    int line_ = 0;
    int other_statements_ = 0;
};

}  // namespace

ObjOutline read_obj_outline(const std::string& path)
{
    return OutlineReader(path).read();
}

}  // namespace arris
