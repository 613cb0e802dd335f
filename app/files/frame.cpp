// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/files/frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string_view>
#include <utility>

#include "app/files/atomic_file.h"
#include "app/text/printable.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

static_assert(std::endian::native == std::endian::little,
              "frames are copied to and from little-endian files");

constexpr std::uint64_t kVertexBytes = 11 * 8 + 4 + 1 + 1;
constexpr std::uint64_t kFaceBytes = 1 + 3 * 4 + 3 * 8;
constexpr std::uint64_t kEdgeBytes = 2 * 4, kPieceBytes = 4, kCornersBytes = 1 + 3 * 4,
                        kPointBytes = 2 * 8 + 4;
constexpr std::size_t kMaxHeaderBytes = 2048 + 128 * kMaxPieces;

struct Counts {
    std::uint64_t vertices = 0, faces = 0, edges = 0;
    std::uint64_t points = 0;  ///< further ones, of vertices on seams
};

/// Counts and pieces of a frame, which determine its file's header and length.
struct Layout {
    Counts counts;
    std::vector<PiecePlace> pieces;

    bool has_seams() const { return counts.points > 0; }
    std::uint64_t body_bytes() const
    {
        const std::uint64_t face =
            kFaceBytes + (pieces.empty() ? 0 : kPieceBytes) + (has_seams() ? kCornersBytes : 0);
        return counts.vertices * kVertexBytes + counts.faces * face + counts.edges * kEdgeBytes +
               counts.points * kPointBytes;
    }
};

// The only definition of the header: the reader compares the file with it.
std::string header(const Layout& layout)
{
    const auto& [counts, pieces] = layout;
    std::string text = "ply\nformat binary_little_endian 1.0\n";
    text += "comment Arris frame: m, m/s, J; v: of the vertex, w: of the material there\n";
    if (!pieces.empty()) text += "comment pieces: name, shift of u, u where it begins\n";
    for (const PiecePlace& piece : pieces)
        text += fmt::format("comment piece {} {} {}{}\n", piece.name, piece.shift, piece.begin,
                            piece.is_mirrored ? " mirrored" : "");
    text += fmt::format("element vertex {}\n", counts.vertices);
    for (const char* name : {"x", "y", "z", "u", "v", "vx", "vy", "vz", "wx", "wy", "wz"})
        text += fmt::format("property double {}\n", name);
    text += "property uint id\nproperty uchar eol\nproperty uchar contact\n";
    text += fmt::format("element face {}\n", counts.faces);
    text += "property list uchar int vertex_indices\n";
    text += "property double strain\nproperty double stretch_energy\nproperty double bending_energy\n";
    if (!pieces.empty()) text += "property int piece\n";
    if (layout.has_seams()) text += "property list uchar int point_indices\n";
    text += fmt::format("element edge {}\nproperty int vertex1\nproperty int vertex2\n", counts.edges);
    if (layout.has_seams())
        text += fmt::format("element point {}\nproperty double u\nproperty double v\nproperty int vertex\n",
                            counts.points);
    return text + "end_header\n";
}

template <class T>
void put(std::string& bytes, const T& value)
{
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class Vector>
void put_vector(std::string& bytes, const Vector& vector)
{
    for (Eigen::Index i = 0; i < vector.size(); ++i) put(bytes, vector[i]);
}

void put_vertex(std::string& bytes, const Frame& frame, std::size_t i)
{
    put_vector(bytes, frame.world[i]);
    put_vector(bytes, frame.material[i]);
    put_vector(bytes, frame.vertex_velocity[i]);
    put_vector(bytes, frame.material_velocity[i]);
    put(bytes, frame.ids[i]);
    put(bytes, frame.eol[i]);
    put(bytes, frame.contact[i]);
}

void put_face(std::string& bytes, const Frame& frame, std::size_t i)
{
    put(bytes, std::uint8_t{3});
    for (const int vertex : frame.faces[i]) put(bytes, std::int32_t{vertex});
    put(bytes, frame.strain[i]);
    put(bytes, frame.stretch_energy[i]);
    put(bytes, frame.bending_energy[i]);
    if (!frame.pieces.empty()) put(bytes, std::int32_t{frame.piece_of(frame.corners()[i])});
    if (frame.face_points.empty()) return;
    put(bytes, std::uint8_t{3});
    for (const int point : frame.face_points[i]) put(bytes, std::int32_t{point});
}

[[maybe_unused]] bool has_matching_sizes(const Frame& frame)
{
    const std::size_t n = frame.world.size(), m = frame.faces.size();
    return frame.material.size() == n + frame.seam_vertices.size() &&
           frame.face_points.size() == (frame.seam_vertices.empty() ? 0 : m) &&
           frame.vertex_velocity.size() == n && frame.material_velocity.size() == n &&
           frame.ids.size() == n && frame.eol.size() == n && frame.contact.size() == n &&
           frame.strain.size() == m && frame.stretch_energy.size() == m && frame.bending_energy.size() == m;
}

// Reads values from a body whose length has been checked against the header.
class BodyReader {
  public:
    BodyReader(const std::string& path, const std::string& bytes) : path_(path), at_(bytes.data()) {}

    template <class T>
    T take()
    {
        T value;
        std::memcpy(&value, at_, sizeof value);
        at_ += sizeof value;
        return value;
    }

    double take_finite(const char* element, std::size_t i)
    {
        const double value = take<double>();
        if (!std::isfinite(value)) fail(element, i, "has a value that is not finite");
        return value;
    }

    template <class Vector>
    Vector take_vector(std::size_t i)
    {
        Vector vector;
        for (Eigen::Index k = 0; k < vector.size(); ++k) vector[k] = take_finite("vertex", i);
        return vector;
    }

    std::uint8_t take_at_most(std::uint8_t greatest, std::size_t i)
    {
        const auto value = take<std::uint8_t>();
        if (value > greatest) fail("vertex", i, "has an eol or contact value that is not allowed");
        return value;
    }

    int take_index(std::size_t vertex_count, const char* element, std::size_t i)
    {
        const auto index = take<std::int32_t>();
        if (index < 0 || static_cast<std::size_t>(index) >= vertex_count)
            fail(element, i, fmt::format("names vertex {} of {}", index, vertex_count));
        return index;
    }

    [[noreturn]] void fail(const char* element, std::size_t i, const std::string& what) const
    {
        throw InputError(fmt::format("{}: {} {} {}", path_, element, i, what));
    }

  private:
    const std::string& path_;
    const char* at_;
};

void take_vertex(BodyReader& reader, std::size_t i, Frame& frame)
{
    frame.world[i] = reader.take_vector<Vec3>(i);
    frame.material[i] = reader.take_vector<Vec2>(i);
    frame.vertex_velocity[i] = reader.take_vector<Vec3>(i);
    frame.material_velocity[i] = reader.take_vector<Vec3>(i);
    frame.ids[i] = reader.take<std::uint32_t>();
    frame.eol[i] = reader.take_at_most(2, i);
    frame.contact[i] = reader.take_at_most(1, i);
}

void take_face(BodyReader& reader, std::size_t i, Frame& frame)
{
    if (reader.take<std::uint8_t>() != 3) reader.fail("face", i, "is not a triangle");
    Face& face = frame.faces[i];
    for (int& vertex : face) vertex = reader.take_index(frame.world.size(), "face", i);
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0])
        reader.fail("face", i, "repeats a vertex");
    frame.strain[i] = reader.take_finite("face", i);
    frame.stretch_energy[i] = reader.take_finite("face", i);
    frame.bending_energy[i] = reader.take_finite("face", i);
    const int piece = frame.pieces.empty() ? 0 : reader.take<std::int32_t>();
    if (frame.face_points.empty()) {
        if (piece != frame.piece_of(face)) reader.fail("face", i, "is not where its piece is");
        return;
    }
    if (reader.take<std::uint8_t>() != 3) reader.fail("face", i, "is not a triangle");
    for (int& point : frame.face_points[i]) point = reader.take_index(frame.material.size(), "face", i);
}

void take_point(BodyReader& reader, std::size_t i, Frame& frame)
{
    for (double& coordinate : frame.material[frame.world.size() + i])
        coordinate = reader.take_finite("point", i);
    frame.seam_vertices[i] = reader.take_index(frame.world.size(), "point", i);
}

/// Requires that the points at a face's corners are of its vertices.
void check_points(const BodyReader& reader, std::size_t i, const Frame& frame)
{
    for (int k = 0; k < 3; ++k) {
        const auto point = static_cast<std::size_t>(frame.face_points[i][k]), n = frame.world.size();
        const int vertex = point < n ? static_cast<int>(point) : frame.seam_vertices[point - n];
        if (vertex != frame.faces[i][k]) reader.fail("face", i, "has a point of another vertex");
    }
}

void take_edge(BodyReader& reader, std::size_t i, Frame& frame)
{
    auto& edge = frame.eol_edges[i];
    for (int& vertex : edge) vertex = reader.take_index(frame.world.size(), "edge", i);
    if (edge[0] == edge[1]) reader.fail("edge", i, "repeats a vertex");
}

void resize(Frame& frame, const Counts& counts)
{
    for (auto* vectors : {&frame.world, &frame.vertex_velocity, &frame.material_velocity})
        vectors->resize(counts.vertices);
    frame.material.resize(counts.vertices + counts.points);
    frame.seam_vertices.resize(counts.points);
    if (counts.points > 0) frame.face_points.resize(counts.faces);
    frame.ids.resize(counts.vertices);
    for (auto* flags : {&frame.eol, &frame.contact}) flags->resize(counts.vertices);
    frame.faces.resize(counts.faces);
    for (auto* values : {&frame.strain, &frame.stretch_energy, &frame.bending_energy})
        values->resize(counts.faces);
    frame.eol_edges.resize(counts.edges);
}

std::uint64_t find_count(const std::string& path, const std::string& text, const std::string& element)
{
    const std::string key = "\nelement " + element + " ";
    const std::size_t at = text.find(key);
    std::uint64_t count = 0;
    const char* end = text.data() + text.size();
    if (at == std::string::npos ||
        std::from_chars(text.data() + at + key.size(), end, count).ec != std::errc() ||
        count > static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max()))
        throw InputError(
            fmt::format("{}: is not a frame: its count of {} elements is missing or invalid", path, element));
    return count;
}

/// The pieces that the comments name.
std::vector<PiecePlace> find_pieces(const std::string& path, const std::string& text)
{
    std::vector<PiecePlace> pieces;
    const std::string key = "\ncomment piece ";
    for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + 1)) {
        std::istringstream line(text.substr(at + key.size(), text.find('\n', at + 1) - at - key.size()));
        std::string shift, begin, mirrored;
        PiecePlace piece;
        line >> piece.name >> shift >> begin >> mirrored;
        piece.is_mirrored = mirrored == "mirrored";
        const auto read = [&](const std::string& word, double& value) {
            return std::from_chars(word.data(), word.data() + word.size(), value).ec == std::errc();
        };
        const bool is_first = pieces.empty();
        if (!read(shift, piece.shift) || !read(begin, piece.begin) || !std::isfinite(piece.shift) ||
            is_first == std::isfinite(piece.begin) || (!is_first && !(piece.begin > pieces.back().begin)))
            throw InputError(fmt::format("{}: is not a frame: its piece {} has no place", path,
                                         printable(piece.name, 64)));
        pieces.push_back(piece);
    }
    return pieces;
}

struct Header {
    Layout layout;
    std::size_t bytes;
};

// Leaves the stream at the body. Accepts only the header of write_frame.
Header read_header(const std::string& path, std::istream& in)
{
    std::string text(kMaxHeaderBytes, '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(in.gcount()));
    if (!text.starts_with("ply\n"))
        throw InputError(path + ": is not a frame: it does not begin with \"ply\"");
    constexpr std::string_view kEnd = "\nend_header\n";
    text.resize(std::min(text.size(), text.find(kEnd)));  // what looks like a header in the body is none
    const Counts counts = {
        find_count(path, text, "vertex"), find_count(path, text, "face"), find_count(path, text, "edge"),
        text.find("\nelement point ") == std::string::npos ? 0 : find_count(path, text, "point")};
    const Layout layout = {counts, find_pieces(path, text)};
    const std::string expected = header(layout);
    text += kEnd;
    if (!text.starts_with(expected))
        throw InputError(path + ": is not a frame: its header differs from that of `arris run`");
    in.clear();
    in.seekg(static_cast<std::streamoff>(expected.size()));
    return {layout, expected.size()};
}

std::string read_body(const std::string& path, std::istream& in, const Header& read, std::uint64_t file_bytes)
{
    const std::uint64_t body_bytes = read.layout.body_bytes(), promised = read.bytes + body_bytes;
    if (promised != file_bytes)
        throw InputError(
            fmt::format("{}: has {} bytes, but its header implies {}", path, file_bytes, promised));
    std::string body(body_bytes, '\0');
    in.read(body.data(), static_cast<std::streamsize>(body.size()));
    if (in.gcount() != static_cast<std::streamsize>(body.size())) throw InputError(path + ": cannot be read");
    return body;
}

}  // namespace

void write_frame(const std::string& path, const Frame& frame)
{
    assert(has_matching_sizes(frame) && "a frame's arrays have one entry per vertex or per face");
    const Counts counts = {frame.world.size(), frame.faces.size(), frame.eol_edges.size(),
                           frame.seam_vertices.size()};
    const Layout layout = {counts, frame.pieces};
    std::string bytes = header(layout);
    bytes.reserve(bytes.size() + layout.body_bytes());
    for (std::size_t i = 0; i < counts.vertices; ++i) put_vertex(bytes, frame, i);
    for (std::size_t i = 0; i < counts.faces; ++i) put_face(bytes, frame, i);
    for (const auto& edge : frame.eol_edges)
        for (const int vertex : edge) put(bytes, std::int32_t{vertex});
    for (std::size_t i = 0; i < counts.points; ++i) {
        put_vector(bytes, frame.material[counts.vertices + i]);
        put(bytes, std::int32_t{frame.seam_vertices[i]});
    }
    write_atomically(path, bytes);
}

Frame read_frame(const std::string& path)
{
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        throw InputError(path + ": does not exist or is not a file");
    const std::uint64_t file_bytes = std::filesystem::file_size(path, error);
    std::ifstream in(path, std::ios::binary);
    if (error || !in) throw InputError(path + ": cannot be opened");

    Header read = read_header(path, in);
    const Counts& counts = read.layout.counts;
    const std::string body = read_body(path, in, read, file_bytes);
    Frame frame;
    frame.pieces = std::move(read.layout.pieces);
    resize(frame, counts);
    BodyReader reader(path, body);
    for (std::size_t i = 0; i < counts.vertices; ++i) take_vertex(reader, i, frame);
    for (std::size_t i = 0; i < counts.faces; ++i) take_face(reader, i, frame);
    for (std::size_t i = 0; i < counts.edges; ++i) take_edge(reader, i, frame);
    for (std::size_t i = 0; i < counts.points; ++i) take_point(reader, i, frame);
    if (counts.points > 0)
        for (std::size_t i = 0; i < counts.faces; ++i) check_points(reader, i, frame);
    return frame;
}

}  // namespace arris
