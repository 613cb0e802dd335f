// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/obstacle_reply.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "geometry/input_error.h"
#include "geometry/input_limits.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle/obstacle_topology.h"

namespace arris {
namespace {

constexpr std::string_view kMeshMark = "arris-obstacle-2";
constexpr std::string_view kRefusalMark = "arris-refusal--1";
constexpr std::size_t kMostLines = 1000;

static_assert(sizeof(Vec3) == 3 * sizeof(double) && std::is_trivially_copyable_v<Face>);

template <class Element>
void append(std::string& bytes, const std::vector<Element>& elements)
{
    const std::uint64_t count = elements.size();
    bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
    bytes.append(reinterpret_cast<const char*>(elements.data()), count * sizeof(Element));
}

void append(std::string& bytes, const std::string& text)
{
    const std::uint64_t count = text.size();
    bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
    bytes.append(text);
}

void append_lines(std::string& bytes, const std::vector<std::string>& lines)
{
    const std::uint64_t count = lines.size();
    bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
    for (const std::string& line : lines) append(bytes, line);
}

class ReplyReader {
  public:
    explicit ReplyReader(std::string_view bytes) : rest_(bytes) {}

    bool take_mark(std::string_view mark)
    {
        if (!rest_.starts_with(mark)) return false;
        rest_.remove_prefix(mark.size());
        return true;
    }

    // Takes a count, which must not exceed the elements that fit in the remaining bytes.
    std::size_t take_count(std::size_t element_size)
    {
        std::uint64_t count = 0;
        if (rest_.size() < sizeof count) refuse();
        std::memcpy(&count, rest_.data(), sizeof count);
        rest_.remove_prefix(sizeof count);
        if (count > rest_.size() / element_size) refuse();
        return count;
    }

    template <class Element>
    void take(std::vector<Element>& elements)
    {
        elements.resize(take_count(sizeof(Element)));
        const std::size_t size = elements.size() * sizeof(Element);
        if (size > 0) std::memcpy(static_cast<void*>(elements.data()), rest_.data(), size);
        rest_.remove_prefix(size);
    }

    std::string take_line()
    {
        const std::size_t length = take_count(1);
        const std::string line = one_line(rest_.substr(0, length));
        rest_.remove_prefix(length);
        return line;
    }

    std::vector<std::string> take_lines()
    {
        const std::size_t count = take_count(sizeof(std::uint64_t));
        if (count > kMostLines) refuse();
        std::vector<std::string> lines;
        for (std::size_t i = 0; i < count; ++i) lines.push_back(take_line());
        return lines;
    }

    void require_end() const
    {
        if (!rest_.empty()) refuse();
    }

    [[noreturn]] static void refuse() { throw InputError("the reply of its import is damaged"); }

  private:
    std::string_view rest_;
};

template <class Number>
Number take_one(ReplyReader& reader)
{
    std::vector<Number> one;
    reader.take(one);
    if (one.size() != 1) ReplyReader::refuse();
    return one.front();
}

void take_origins(ReplyReader& reader, ObstacleFile& file)
{
    VertexOrigins& origins = file.origins;
    reader.take(origins.of_points);
    reader.take(origins.joined);
    origins.vertex_count = take_one<int>(reader);
    origins.tolerance = take_one<double>(reader);
    const auto is_vertex = [&](int v) { return v >= 0 && v < origins.vertex_count; };
    bool is_sound = origins.vertex_count >= 0 && origins.tolerance >= 0.0 &&
                    std::isfinite(origins.tolerance) &&
                    origins.of_points.size() == (origins.vertex_count > 0 ? file.mesh.points.size() : 0);
    for (const int v : origins.of_points) is_sound = is_sound && (v == -1 || is_vertex(v));
    for (const auto& [kept, other] : origins.joined)
        is_sound = is_sound && is_vertex(kept) && is_vertex(other);
    if (!is_sound) ReplyReader::refuse();
}

}  // namespace

std::string encode_reply(const ObstacleFile& file)
{
    std::string bytes(kMeshMark);
    append(bytes, file.mesh.points);
    append(bytes, file.mesh.faces);
    append(bytes, file.mesh.segments);
    append(bytes, file.mesh.lone_points);
    append(bytes, file.origins.of_points);
    append(bytes, file.origins.joined);
    append(bytes, std::vector<int>{file.origins.vertex_count});
    append(bytes, std::vector<double>{file.origins.tolerance});
    append_lines(bytes, file.warnings);
    append_lines(bytes, file.notes);
    return bytes;
}

std::string encode_refusal(const std::string& why)
{
    std::string bytes(kRefusalMark);
    append(bytes, why);
    return bytes;
}

ObstacleFile decode_reply(std::string_view bytes)
{
    ReplyReader reader(bytes);
    if (reader.take_mark(kRefusalMark)) throw InputError(reader.take_line());
    if (!reader.take_mark(kMeshMark)) ReplyReader::refuse();
    ObstacleFile file;
    reader.take(file.mesh.points);
    reader.take(file.mesh.faces);
    reader.take(file.mesh.segments);
    reader.take(file.mesh.lone_points);
    take_origins(reader, file);
    file.warnings = reader.take_lines();
    file.notes = reader.take_lines();
    reader.require_end();
    if (const std::string wrong = validate(file.mesh); !wrong.empty())
        throw InputError("it could not be repaired: " + one_line(wrong));
    for (const Vec3& p : file.mesh.points)
        if (!(p.cwiseAbs().maxCoeff() <= kLargestCoordinate)) ReplyReader::refuse();
    return file;
}

}  // namespace arris
