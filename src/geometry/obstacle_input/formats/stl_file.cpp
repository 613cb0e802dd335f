// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/formats/stl_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"

namespace arris {
namespace {

constexpr std::size_t kHeader = 84;  // 80 bytes of comment, 4 of face count
constexpr std::size_t kFace = 50;    // normal, three corners, two bytes

std::uint64_t size_of(std::uint64_t faces)
{
    return kHeader + kFace * faces;
}

std::uint32_t face_count(std::string_view bytes)
{
    std::uint32_t count = 0;
    if (bytes.size() >= kHeader) std::memcpy(&count, bytes.data() + 80, sizeof count);
    return count;
}

// The length of a binary file tells it from a text. So does a zero byte, which no text has.
bool is_text(std::string_view bytes)
{
    if (bytes.size() >= kHeader && bytes.size() == size_of(face_count(bytes))) return false;
    std::string_view text = skip_byte_order_mark(bytes);
    if (text.find('\0') != std::string_view::npos) return false;
    while (!text.empty()) {
        std::string_view line = take_line(text);
        if (line.empty() || line.starts_with('#') || line.starts_with("//")) continue;
        return to_lower(line.substr(0, 5)) == "solid";
    }
    return false;
}

PlainMesh read_binary(std::string_view bytes)
{
    if (bytes.size() < kHeader)
        throw InputError(fmt::format("truncated: {} bytes are less than an STL file's header", bytes.size()));
    const std::uint32_t count = face_count(bytes);
    if (count == 0 && bytes.size() == kHeader) throw InputError("no faces");
    // Some writers leave a few bytes behind the last face; more than a face means a wrong count.
    if (count == 0 || bytes.size() < size_of(count) || bytes.size() >= size_of(count + std::uint64_t{1}))
        throw InputError(
            fmt::format("truncated, or not an STL file: its header counts {} faces, {} bytes, but the "
                        "file has {}",
                        count, size_of(count), bytes.size()));
    PlainMesh mesh;
    mesh.is_single = true;
    const std::uint64_t rest = bytes.size() - size_of(count);
    if (rest > 0)
        mesh.warnings.push_back(fmt::format("{} after its {} not read",
                                            counted(static_cast<long long>(rest), "byte", "bytes"),
                                            counted(count, "face is", "faces are")));
    for (std::uint32_t f = 0; f < count; ++f)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            float p[3];
            std::memcpy(p, bytes.data() + size_of(f) + 12 + 12 * corner, sizeof p);
            mesh.corners.push_back(static_cast<int>(mesh.points.size()));
            mesh.points.emplace_back(p[0], p[1], p[2]);
        }
    mesh.corner_counts.assign(count, 3);
    return mesh;
}

// Where a comment begins. In 1.#QNAN, as some writers spell a normal, none does.
std::size_t find_comment(std::string_view line)
{
    std::size_t at = line.find('#');
    while (at != std::string_view::npos && at > 0 && line[at - 1] == '.') at = line.find('#', at + 1);
    return at;
}

class TextReader {
  public:
    explicit TextReader(std::string_view bytes) : rest_(skip_byte_order_mark(bytes)) {}

    PlainMesh read()
    {
        while (!rest_.empty()) {
            ++line_;
            std::string_view line = take_line(rest_);
            if (line.starts_with("//")) continue;
            words_ = line.substr(0, find_comment(line));
            for (std::string word = next_word(); !word.empty(); word = next_word()) interpret(word);
        }
        if (is_open_) refuse(fmt::format("truncated: face {} has no end", faces_));
        if (faces_ == 0) throw InputError("no faces");
        if (!has_end_) refuse(fmt::format("truncated: no 'endsolid' after face {}", faces_));
        return std::move(mesh_);
    }

  private:
    // Some writers separate 'end' from what ends.
    std::string next_word()
    {
        std::string word = to_lower(take_word(words_));
        if (word == "end") word += to_lower(take_word(words_));
        return word;
    }

    void interpret(const std::string& word)
    {
        if (word == "facet") return begin_face();
        if (word == "vertex") return take_vertex();
        if (word == "endfacet") return end_face();
        if (word == "endsolid") has_end_ = true;
        if (word == "solid" || word == "endsolid") skip_name();
    }

    [[noreturn]] void refuse(const std::string& why) const
    {
        throw InputError(fmt::format("line {}: {}", line_, why));
    }

    // The rest of the line is the name. Only where a whole file is one line do facets follow: 'facet normal',
    // three words, and 'outer loop vertex'.
    void skip_name()
    {
        for (std::string_view rest = words_; !rest.empty(); take_word(rest)) {
            std::string_view words = rest;
            if (to_lower(take_word(words)) != "facet" || to_lower(take_word(words)) != "normal") continue;
            for (int axis = 0; axis < 3; ++axis) take_word(words);
            if (to_lower(take_word(words)) != "outer" || to_lower(take_word(words)) != "loop") continue;
            if (to_lower(take_word(words)) != "vertex") continue;
            words_ = rest;
            return;
        }
        words_ = {};
    }

    void begin_face()
    {
        if (is_open_) refuse(fmt::format("face {} has no end before the next", faces_));
        ++faces_;
        is_open_ = true;
        has_end_ = false;
        corners_ = 0;
        std::string_view words = words_;
        if (to_lower(take_word(words)) != "normal") return;
        for (int axis = 0; axis < 3; ++axis) {
            std::string_view normal = words;
            if (to_lower(take_word(normal)) != "outer") words = normal;
        }
        words_ = words;
    }

    void take_vertex()
    {
        ++corners_;
        Vec3 p;
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view word = take_word(words_);
            const ParsedNumber number = parse_number(word);
            if (number.error != NumberError::None)
                refuse(fmt::format("face {}, vertex {}: '{}' is {}", faces_, corners_, excerpt(word),
                                   number.error == NumberError::NoNumber ? "no number; a vertex has 3"
                                                                         : "beyond double precision"));
            p[axis] = number.value;
        }
        if (!is_open_) refuse("a vertex outside of a face");
        mesh_.corners.push_back(static_cast<int>(mesh_.points.size()));
        mesh_.points.push_back(p);
        mesh_.lines.push_back(line_);
    }

    void end_face()
    {
        if (!is_open_ || corners_ != 3)
            refuse(fmt::format("face {} has {} vertices instead of 3", faces_, corners_));
        is_open_ = false;
        mesh_.corner_counts.push_back(3);
    }

    std::string_view rest_;
    std::string_view words_;  // of the line
    int line_ = 0;
    PlainMesh mesh_;
    int faces_ = 0;
    int corners_ = 0;  // of the face
    bool is_open_ = false;
    bool has_end_ = false;
};

}  // namespace

PlainMesh read_stl(std::string_view bytes)
{
    return is_text(bytes) ? TextReader(bytes).read() : read_binary(bytes);
}

}  // namespace arris
