// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obj_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"

namespace arris {
namespace {

constexpr const char* kVertexForm = "'v x y z', numbers in the file's unit (then a weight, or a colour)";
constexpr const char* kUvForm = "'vt u v', numbers (of a cloth: in metres)";
constexpr const char* kIndexForm =
    "'f' and at least 3 of vertex, vertex/uv, vertex//normal or "
    "vertex/uv/normal, whole numbers counted from 1 (or back from -1)";
constexpr const char* kElementForm = "'l' and at least 2 vertices, 'p' and at least 1";

// Statements of OBJ that change no shape that is read.
constexpr std::array<std::string_view, 29> kShapeless = {
    "vn",     "vp",  "o",     "g",    "s",    "mg",    "usemtl", "mtllib",   "usemap",  "maplib",
    "cstype", "deg", "bmat",  "step", "parm", "trim",  "hole",   "scrv",     "sp",      "end",
    "seam",   "con", "bevel", "lod",  "res",  "ctech", "stech",  "c_interp", "d_interp"};
constexpr std::array<std::string_view, 2> kShadows = {"shadow_obj", "trace_obj"};
constexpr std::array<std::string_view, 7> kFreeForms = {"curv", "curv2", "surf", "bzp", "bsp", "cdc", "cdp"};
constexpr std::array<std::string_view, 2> kInclusions = {"call", "csh"};

template <std::size_t n>
bool is_in(const std::array<std::string_view, n>& words, std::string_view word)
{
    return std::find(words.begin(), words.end(), word) != words.end();
}

class ObjReader {
  public:
    explicit ObjReader(std::string_view bytes) : rest_(skip_byte_order_mark(bytes))
    {
        if (rest_.find('\0') != std::string_view::npos)
            throw InputError("not the text of an OBJ file (it holds a zero byte)");
    }

    ObjFile read()
    {
        while (!rest_.empty()) {
            take_statement();
            interpret();
        }
        require_in_range();
        warn(free_forms_, "free-form curve or surface ('curv', 'surf') is not read",
             "free-form curves and surfaces ('curv', 'surf') are not read");
        warn(inclusions_, "statement ('call', 'csh') that includes another file is not followed",
             "statements ('call', 'csh') that include other files are not followed");
        if (unknown_ > 0)
            file_.warnings.push_back(counted(unknown_, "statement is", "statements are") +
                                     " none of OBJ and not read, the first " + first_unknown_);
        return std::move(file_);
    }

  private:
    // Takes the next statement without its comment. A backslash continues it in the next line; lines that are
    // a comment may stand in between.
    void take_statement()
    {
        line_ = next_line_;
        joined_.clear();
        bool is_continued = false;
        do {
            const std::string_view whole = take_line(rest_);
            ++next_line_;
            if (is_continued && whole.starts_with('#')) continue;
            statement_ = whole.substr(0, whole.find('#'));
            statement_ = statement_.substr(0, statement_.find_last_not_of(" \t\v\f") + 1);
            const bool was_continued = std::exchange(is_continued, statement_.ends_with('\\'));
            if (is_continued) statement_.remove_suffix(1);
            if (was_continued || is_continued) joined_.append(statement_).append(1, ' ');
        } while (is_continued && !rest_.empty());
        if (!joined_.empty()) statement_ = joined_;
    }

    void interpret()
    {
        std::string_view words = statement_;
        const std::string keyword = to_lower(take_word(words));
        if (keyword.empty()) return;
        if (keyword == "v") return take_vertex(words);
        if (keyword == "vt") return take_uv(words);
        // 'fo' is the format's older name of a face.
        if (keyword == "f" || keyword == "fo") return take_face(words);
        if (keyword == "l" || keyword == "p") return take_line_or_point(keyword, words);
        if (keyword == "stitch") return take_stitch(words);
        ++file_.other_count;
        if (is_in(kShapeless, keyword) || is_in(kShadows, keyword)) return;
        if (is_in(kFreeForms, keyword)) {
            ++free_forms_;
        } else if (is_in(kInclusions, keyword)) {
            ++inclusions_;
        } else {
            note_unknown(keyword);
        }
    }

    // 'vv', 'v1' and 'v' before a blank that is none in OBJ were meant as vertices, whose indices would
    // shift.
    void note_unknown(const std::string& keyword)
    {
        const bool is_element = std::string_view("flp").find(keyword[0]) != std::string_view::npos;
        const bool has_letter = keyword.size() > 1 && keyword[1] >= 'a' && keyword[1] <= 'z';
        if (keyword[0] == 'v' || (is_element && !has_letter))
            refuse(fmt::format("'{}' is no statement of OBJ", excerpt(keyword)),
                   "v, vt, vn, vp, f, l or p, followed by a blank");
        if (unknown_++ == 0) first_unknown_ = fmt::format("in line {}: '{}'", line_, excerpt(statement_));
    }

    void warn(int count, const char* one, const char* many)
    {
        if (count > 0) file_.warnings.push_back("its " + counted(count, one, many));
    }

    [[noreturn]] void refuse(const std::string& why, const char* allowed) const
    {
        throw InputError(
            fmt::format("line {}: '{}': {}; allowed: {}", line_, excerpt(statement_), why, allowed));
    }

    // Numbers

    double read_number(std::string_view word, const char* allowed) const
    {
        const ParsedNumber number = parse_number(word);
        if (number.error == NumberError::NoNumber)
            refuse(fmt::format("'{}' is no number", excerpt(word)), allowed);
        if (number.error == NumberError::TooLarge)
            refuse(fmt::format("'{}' is beyond double precision", excerpt(word)), allowed);
        return number.value;
    }

    // Reads all numbers of a statement; returns how many, and keeps the first ones.
    template <std::size_t n>
    int read_numbers(std::string_view words, std::array<double, n>& numbers, const char* allowed) const
    {
        int count = 0;
        for (std::string_view word = take_word(words); !word.empty(); word = take_word(words), ++count) {
            const double number = read_number(word, allowed);
            if (count < static_cast<int>(n)) numbers[count] = number;
        }
        return count;
    }

    // A fourth number alone is the weight of projective coordinates; more numbers are a colour.
    void take_vertex(std::string_view words)
    {
        std::array<double, 4> numbers{};
        const int count = read_numbers(words, numbers, kVertexForm);
        if (count < 3) refuse(fmt::format("{} numbers, but a vertex has 3", count), kVertexForm);
        Vec3 place(numbers[0], numbers[1], numbers[2]);
        if (count == 4) {
            if (!(std::abs(numbers[3]) > 0.0 && std::isfinite(numbers[3])))
                refuse(fmt::format("its weight is {}", numbers[3]), "a finite weight other than 0");
            place /= numbers[3];
        }
        file_.vertices.push_back({place, line_});
    }

    // 'vt u' has v = 0.
    void take_uv(std::string_view words)
    {
        std::array<double, 2> numbers{};
        if (read_numbers(words, numbers, kUvForm) < 1) refuse("a UV without a number", kUvForm);
        file_.uvs.push_back({{numbers[0], numbers[1]}, line_});
    }

    // Elements

    void take_face(std::string_view words)
    {
        int corners = 0;
        for (std::string_view word = take_word(words); !word.empty(); word = take_word(words), ++corners)
            file_.corners.push_back(corner_of(word, kIndexForm));
        if (corners < 3)
            refuse(fmt::format("a face of {}; at least 3 are needed", counted(corners, "corner", "corners")),
                   kIndexForm);
        file_.corner_counts.push_back(corners);
    }

    void take_line_or_point(const std::string& keyword, std::string_view words)
    {
        ++file_.line_and_point_count;
        int last = -1, corners = 0;
        for (std::string_view word = take_word(words); !word.empty(); word = take_word(words), ++corners) {
            const int vertex = corner_of(word, kElementForm).vertex;
            if (keyword == "p") file_.lone_points.push_back(vertex);
            if (keyword == "l" && last >= 0) file_.segments.push_back({last, vertex});
            last = vertex;
        }
        if (corners < (keyword == "p" ? 1 : 2))
            refuse(counted(corners, "vertex is", "vertices are") + " too few", kElementForm);
    }

    // The vertices may follow the statement: they are checked at the file's end.
    void take_stitch(std::string_view words)
    {
        constexpr const char* kForm =
            "stitch a b c r: three vertices, counted from 0, and a share from 0 to 1";
        std::array<double, 4> numbers;
        for (double& number : numbers) number = read_number(take_word(words), kForm);
        ObjStitch stitch{{}, numbers[3], line_};
        for (std::size_t k = 0; k < 3; ++k) {
            if (!(numbers[k] >= 0.0 && numbers[k] <= 1e9 && numbers[k] == std::floor(numbers[k])))
                refuse("has a vertex that is none", kForm);
            stitch.vertices[k] = static_cast<int>(numbers[k]);
        }
        if (!(stitch.share >= 0.0 && stitch.share <= 1.0) || !take_word(words).empty())
            refuse("is no stitch", kForm);
        file_.stitches.push_back(stitch);
    }

    // vertex, vertex/uv, vertex/uv/normal or vertex//normal
    ObjCorner corner_of(std::string_view word, const char* allowed)
    {
        std::array<std::string_view, 3> parts;
        std::string_view rest = word;
        for (std::string_view& part : parts) {
            part = rest.substr(0, rest.find('/'));
            rest.remove_prefix(std::min(rest.size(), part.size() + 1));
        }
        if (!rest.empty()) refuse(fmt::format("'{}' has more than two slashes", excerpt(word)), allowed);
        const int vertex = read_index("vertex", parts[0], file_.vertices.size(), allowed);
        const int uv = parts[1].empty() ? -1 : read_index("UV", parts[1], file_.uvs.size(), allowed);
        if (!parts[2].empty()) whole_number(parts[2], allowed);
        if (vertex > greatest_) {
            greatest_ = vertex;
            greatest_line_ = line_;
        }
        return {vertex, uv, line_};
    }

    long long whole_number(std::string_view word, const char* allowed) const
    {
        std::string_view digits = word;
        if (digits.starts_with('+')) digits.remove_prefix(1);
        long long index = 0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
        if (error != std::errc() || end != digits.data() + digits.size())
            refuse(fmt::format("'{}' is no index", excerpt(word)), allowed);
        return index;
    }

    // Returns an index from 0. A negative index counts back from the last of the `count` elements so far.
    int read_index(const char* what, std::string_view word, std::size_t count, const char* allowed) const
    {
        const long long index = whole_number(word, allowed);
        const long long from_one = index < 0 ? static_cast<long long>(count) + index + 1 : index;
        if (from_one < 1 || from_one > std::numeric_limits<int>::max())
            refuse(fmt::format("it names {} {}, but there are {} so far, counted from 1", what, index, count),
                   allowed);
        return static_cast<int>(from_one - 1);
    }

    // An element may name vertices that follow it.
    void require_in_range() const
    {
        if (greatest_ < static_cast<int>(file_.vertices.size())) return;
        throw InputError(fmt::format("line {}: it names vertex {}, but there are {}, counted from 1",
                                     greatest_line_, greatest_ + 1LL, file_.vertices.size()));
    }

    std::string_view rest_;
    std::string_view statement_;
    std::string joined_;  // a statement of several lines
    int line_ = 1;        // of the statement
    int next_line_ = 1;
    ObjFile file_;
    int greatest_ = -1;  // greatest vertex that an element names
    int greatest_line_ = 0;
    int free_forms_ = 0;
    int inclusions_ = 0;
    int unknown_ = 0;
    std::string first_unknown_;
};

}  // namespace

ObjFile read_obj(std::string_view bytes)
{
    return ObjReader(bytes).read();
}

}  // namespace arris
