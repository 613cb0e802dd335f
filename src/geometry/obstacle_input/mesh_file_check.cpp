// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/mesh_file_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/ply_check.h"

namespace arris {
namespace {

// Longest quotation from a file in a message: enough to locate the place.
constexpr std::size_t kLongestQuote = 40;

// All binary formats checked here are little endian, as are the machines that this program supports.
template <class Number>
Number number_at(std::string_view bytes, std::size_t offset)
{
    Number number;
    std::memcpy(&number, bytes.data() + offset, sizeof number);
    return number;
}

std::string_view take_line(std::string_view& text)
{
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

std::string_view take_word(std::string_view& text)
{
    constexpr std::string_view kSpace = " \t\r\n\v\f";
    const std::size_t begin = std::min(text.find_first_not_of(kSpace), text.size());
    const std::size_t end = std::min(text.find_first_of(kSpace, begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    text.remove_prefix(end);
    return word;
}

// OBJ

class ObjCheck {
  public:
    explicit ObjCheck(std::string_view text) : text_(text) {}

    std::vector<std::string> run()
    {
        for (std::string_view rest = text_; !rest.empty();) {
            statement_ = take_line(rest);
            ++line_;
            check_statement();
        }
        if (elements_ == 0)
            throw InputError(
                fmt::format("no faces ('f'), lines ('l') or points ('p') among {} vertices", vertices_));
        if (greatest_index_ > vertices_)
            throw InputError(fmt::format("line {}: it names vertex {}, but there are {}", greatest_line_,
                                         greatest_index_, vertices_));
        if (free_forms_ == 0) return {};
        return {
            fmt::format("its {} free-form curves and surfaces ('curv', 'surf') are not read", free_forms_)};
    }

  private:
    [[noreturn]] void refuse(const std::string& why) const
    {
        std::string quote(statement_.substr(0, kLongestQuote));
        if (quote.size() < statement_.size()) quote += "...";
        throw InputError(fmt::format("line {}: '{}': {}", line_, quote, why));
    }

    void check_statement()
    {
        std::string_view words = statement_;
        const std::string_view keyword = take_word(words);
        if (keyword == "v") check_vertex(words);
        if (keyword == "f") check_element(words, 3);
        if (keyword == "l") check_element(words, 2);
        if (keyword == "p") check_element(words, 1);
        if (keyword == "surf" || keyword == "curv") ++free_forms_;
    }

    void check_vertex(std::string_view words)
    {
        ++vertices_;
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view word = take_word(words);
            if (word.empty()) refuse("a vertex has 3 numbers");
            const ParsedNumber number = parse_number(word);
            if (number.error == NumberError::NoNumber)
                refuse(fmt::format("'{}' is no number", word.substr(0, kLongestQuote)));
            if (number.error != NumberError::None || !std::isfinite(number.value))
                refuse("the vertex is not finite or beyond double precision");
        }
    }

    void check_element(std::string_view words, int least)
    {
        int corners = 0;
        for (std::string_view word = take_word(words); !word.empty(); word = take_word(words), ++corners) {
            long long index = 0;
            const std::string_view digits = word.substr(0, word.find('/'));
            const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
            if (error != std::errc() || end != digits.data() + digits.size())
                refuse(fmt::format("'{}' is no index of a vertex", digits.substr(0, kLongestQuote)));
            if (index == 0 || index < -vertices_)
                refuse(
                    fmt::format("vertex {} out of range: there are {} so far, counted from 1 (or back "
                                "from -1)",
                                index, vertices_));
            if (index > greatest_index_) {
                greatest_index_ = index;
                greatest_line_ = line_;
            }
        }
        if (corners < least) refuse(fmt::format("{} corners; at least {} are needed", corners, least));
        ++elements_;
    }

    std::string_view text_;
    std::string_view statement_;
    int line_ = 0;
    long long vertices_ = 0;
    long long elements_ = 0;
    long long free_forms_ = 0;
    long long greatest_index_ = 0;
    int greatest_line_ = 0;
};

// STL

constexpr std::size_t kStlHeader = 84;  // 80 bytes of comment, 4 of face count
constexpr std::size_t kStlFace = 50;

// Checks the numbers of a vertex.
void check_stl_vertex(std::string_view words, std::size_t facet, std::size_t corner)
{
    for (int axis = 0; axis < 3; ++axis) {
        const std::string_view word = take_word(words);
        const bool is_number = !word.empty() && parse_number(word).error == NumberError::None;
        if (!is_number)
            throw InputError(fmt::format("face {}, vertex {}: '{}' is no number; a vertex has 3", facet,
                                         corner, word.substr(0, kLongestQuote)));
    }
}

void check_ascii_stl(std::string_view text)
{
    std::size_t facets = 0;
    std::size_t corners = 0;
    bool is_open = false;
    std::string_view last_word;
    for (std::string_view rest = text; !rest.empty();) {
        std::string_view words = take_line(rest);
        const std::string_view word = take_word(words);
        if (!word.empty()) last_word = word;
        if (word == "facet") {
            ++facets;
            is_open = true;
            corners = 0;
        } else if (word == "vertex") {
            check_stl_vertex(words, facets, ++corners);
        } else if (word == "endfacet") {
            if (!is_open || corners != 3)
                throw InputError(fmt::format("face {} has {} vertices instead of 3", facets, corners));
            is_open = false;
        }
    }
    if (is_open) throw InputError(fmt::format("truncated: face {} has no end", facets));
    if (facets == 0) throw InputError("no faces");
    if (last_word != "endsolid")
        throw InputError(fmt::format("truncated: no 'endsolid' after face {}", facets));
}

void check_stl(std::string_view bytes)
{
    if (bytes.size() >= kStlHeader) {
        const std::uint64_t count = number_at<std::uint32_t>(bytes, 80);
        if (bytes.size() == kStlHeader + kStlFace * count) {
            if (count == 0) throw InputError("no faces");
            return;
        }
    }
    if (is_text_stl(bytes)) return check_ascii_stl(bytes);
    if (bytes.size() < kStlHeader)
        throw InputError(fmt::format("truncated: {} bytes are less than an STL file's header", bytes.size()));
    const std::uint64_t count = number_at<std::uint32_t>(bytes, 80);
    throw InputError(
        fmt::format("truncated, or not an STL file: its header counts {} faces, {} bytes, but the "
                    "file has {}",
                    count, kStlHeader + kStlFace * count, bytes.size()));
}

// GLB, 3DS and others

constexpr std::size_t kGlbHeader = 12;
constexpr std::size_t kGlbChunkHeader = 8;

void check_glb(std::string_view bytes)
{
    if (bytes.size() < kGlbHeader || !bytes.starts_with("glTF")) throw InputError("not a GLB file");
    if (const auto version = number_at<std::uint32_t>(bytes, 4); version != 2)
        throw InputError(fmt::format("glTF version {}; allowed: 2", version));
    const auto length = number_at<std::uint32_t>(bytes, 8);
    if (length > bytes.size())
        throw InputError(
            fmt::format("truncated: its header says {} bytes, but the file has {}", length, bytes.size()));
    bytes = bytes.substr(0, length);  // bytes after the declared length are ignored
    for (std::size_t at = kGlbHeader; at < bytes.size();) {
        if (bytes.size() - at < kGlbChunkHeader)
            throw InputError(fmt::format("truncated: a chunk's header at byte {}", at));
        const auto chunk = number_at<std::uint32_t>(bytes, at);
        if (chunk > bytes.size() - at - kGlbChunkHeader)
            throw InputError(fmt::format("truncated: the chunk at byte {} says {} bytes, but {} are left", at,
                                         chunk, bytes.size() - at - kGlbChunkHeader));
        at += kGlbChunkHeader + chunk;
    }
}

constexpr std::size_t k3dsChunkHeader = 6;

void check_3ds(std::string_view bytes)
{
    if (bytes.size() < k3dsChunkHeader || number_at<std::uint16_t>(bytes, 0) != 0x4d4d)
        throw InputError("not a 3DS file");
    const auto length = number_at<std::uint32_t>(bytes, 2);
    if (length > bytes.size())
        throw InputError(fmt::format("truncated: its main chunk says {} bytes, but the file has {}", length,
                                     bytes.size()));
}

void require_start(std::string_view bytes, std::string_view start, const char* what)
{
    if (!take_word(bytes).starts_with(start)) throw InputError(fmt::format("not {} file", what));
}

}  // namespace

const std::vector<std::string>& mesh_extensions()
{
    static const std::vector<std::string> kExtensions = {"obj", "stl", "ply", "gltf", "glb",
                                                         "dae", "fbx", "3mf", "3ds"};
    return kExtensions;
}

std::string canonical_bytes(const std::string& extension, std::string bytes)
{
    if (extension == "obj") return canonical_obj(bytes);
    if (extension == "stl") return is_text_stl(bytes) ? canonical_stl(bytes) : std::move(bytes);
    const bool is_text =
        extension == "ply" || extension == "gltf" || extension == "dae" || extension == "fbx";
    if (is_text) return std::string(skip_byte_order_mark(bytes));
    return bytes;
}

std::vector<std::string> check_mesh_bytes(const std::string& extension, std::string_view bytes)
{
    if (bytes.empty()) throw InputError("empty");
    if (extension == "obj") return ObjCheck(bytes).run();
    if (extension == "stl") check_stl(bytes);
    if (extension == "ply") return check_ply(bytes);
    if (extension == "glb") check_glb(bytes);
    if (extension == "3ds") check_3ds(bytes);
    if (extension == "gltf") require_start(bytes, "{", "a glTF");
    if (extension == "dae") require_start(bytes, "<", "a COLLADA");
    if (extension == "3mf") require_start(bytes, "PK\x03\x04", "a 3MF");
    return {};
}

}  // namespace arris
