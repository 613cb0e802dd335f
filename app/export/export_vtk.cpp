// SPDX-License-Identifier: GPL-3.0-or-later
//
// An array in the appended section is a header of 64-bit counts, then its compressed bytes:
//
//     blocks = 1, bytes of a block, bytes of a last partial block = 0, compressed bytes | zlib stream
//
// An array without bytes has no blocks: three zeros.
#include "app/export/export_vtk.h"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string_view>

#include "app/files/atomic_file.h"
#include "app/files/frame_files.h"

namespace arris {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie in memory");

constexpr double kNoStrain = std::numeric_limits<double>::quiet_NaN();  // of a line

/// The two parts of a file: descriptions of arrays, and their bytes.
struct VtpText {
    std::string xml, appended;

    /// Describes an array of n x `components` values and appends them.
    template <class Value>
    void add(std::string_view type, std::string_view name, int components, const std::vector<Value>& values)
    {
        xml += fmt::format(
            "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
            "offset=\"{}\"/>\n",
            type, name, components, appended.size());
        append(values.data(), values.size() * sizeof(Value));
    }

    void append(const void* bytes, std::size_t size);
};

void VtpText::append(const void* bytes, std::size_t size)
{
    const auto put_counts = [&](const auto& counts) {
        appended.append(reinterpret_cast<const char*>(counts.data()), counts.size() * sizeof(std::uint64_t));
    };
    if (size == 0) return put_counts(std::array<std::uint64_t, 3>{});
    uLongf packed_size = compressBound(size);
    std::string packed(packed_size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(packed.data()), &packed_size, static_cast<const Bytef*>(bytes),
                  size, Z_BEST_SPEED) != Z_OK)
        throw std::runtime_error("zlib cannot compress an array");
    put_counts(std::array<std::uint64_t, 4>{1, size, 0, packed_size});
    appended.append(packed, 0, packed_size);
}

std::vector<double> flat(const std::vector<Vec3>& vectors)
{
    std::vector<double> values;
    values.reserve(3 * vectors.size());
    for (const Vec3& v : vectors) values.insert(values.end(), v.data(), v.data() + 3);
    return values;
}

/// Adds cells of one kind (Verts, Lines, Polys), each of `Size` points.
template <class Cell>
void add_cells(VtpText& text, std::string_view kind, const std::vector<Cell>& cells)
{
    std::vector<std::int64_t> points, offsets;
    for (const Cell& cell : cells) {
        for (const auto point : cell) points.push_back(point);
        offsets.push_back(static_cast<std::int64_t>(points.size()));
    }
    text.xml += fmt::format("<{}>\n", kind);
    text.add("Int64", "connectivity", 1, points);
    text.add("Int64", "offsets", 1, offsets);
    text.xml += fmt::format("</{}>\n", kind);
}

void add_points(VtpText& text, const std::vector<Vec3>& points)
{
    text.xml += "<Points>\n";
    text.add("Float64", "Points", 3, flat(points));
    text.xml += "</Points>\n";
}

/// Counts that open a piece.
std::string piece(std::size_t points, std::size_t verts, std::size_t lines, std::size_t polys)
{
    return fmt::format(
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
        "compressor=\"vtkZLibDataCompressor\">\n"
        "<PolyData>\n"
        "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" "
        "NumberOfPolys=\"{}\">\n",
        points, verts, lines, polys);
}

void write_text(const std::string& path, const VtpText& text)
{
    AtomicFile file(path);
    file.write(text.xml);
    file.write("</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_");
    file.write(text.appended);
    file.write("\n</AppendedData>\n</VTKFile>\n");
    file.commit();
}

/// A value for each line, then those of the faces.
std::vector<double> with_lines(std::size_t lines, double value, const std::vector<double>& faces)
{
    std::vector<double> values(lines, value);
    values.insert(values.end(), faces.begin(), faces.end());
    return values;
}

/// frames/<name>_%05d.vtp, as a collection beside the folder names it.
std::string relative_path(std::size_t frame, const std::string& name)
{
    const std::string file = frame_file("", static_cast<std::int64_t>(frame), "vtp", name);
    return "frames/" + std::filesystem::path(file).filename().string();
}

}  // namespace

void write_vtp(const std::string& path, const Frame& frame)
{
    VtpText text{piece(frame.world.size(), 0, frame.eol_edges.size(), frame.faces.size()), {}};
    std::vector<Vec3> material;
    for (const Vec2& X : frame.own_material())
        if (material.size() < frame.world.size()) material.emplace_back(X[0], X[1], 0.0);
    text.xml += "<PointData>\n";
    text.add("UInt32", "id", 1, frame.ids);
    text.add("UInt8", "eol", 1, frame.eol);
    text.add("UInt8", "contact", 1, frame.contact);
    text.add("Float64", "vertex_velocity", 3, flat(frame.vertex_velocity));
    text.add("Float64", "material_velocity", 3, flat(frame.material_velocity));
    text.add("Float64", "material", 3, flat(material));
    text.xml += "</PointData>\n<CellData>\n";
    const std::size_t lines = frame.eol_edges.size();
    text.add("Float64", "strain", 1, with_lines(lines, kNoStrain, frame.strain));
    text.add("Float64", "stretch_energy", 1, with_lines(lines, 0.0, frame.stretch_energy));
    text.add("Float64", "bending_energy", 1, with_lines(lines, 0.0, frame.bending_energy));
    if (!frame.pieces.empty()) {
        std::vector<std::int32_t> pieces(lines, -1);
        for (const Face& points : frame.corners()) pieces.push_back(frame.piece_of(points));
        text.add("Int32", "piece", 1, pieces);
    }
    text.xml += "</CellData>\n";
    add_points(text, frame.world);
    add_cells(text, "Lines", frame.eol_edges);
    add_cells(text, "Polys", frame.faces);
    write_text(path, text);
}

void write_vtp(const std::string& path, const ObstacleRecord& obstacle, const std::vector<Vec3>& points)
{
    const ObstacleMesh& mesh = obstacle.mesh;
    VtpText text{piece(points.size(), mesh.lone_points.size(), mesh.segments.size(), mesh.faces.size()), {}};
    std::vector<std::array<int, 1>> verts;
    for (const int point : mesh.lone_points) verts.push_back({point});
    std::vector<std::array<int, 2>> lines;
    for (const auto& [a, b] : mesh.segments) lines.push_back({a, b});
    add_points(text, points);
    add_cells(text, "Verts", verts);
    add_cells(text, "Lines", lines);
    add_cells(text, "Polys", mesh.faces);
    write_text(path, text);
}

void write_pvd(const std::string& path, const std::vector<ObstacleRecord>& obstacles, std::size_t frame_count,
               double frames_per_second)
{
    AtomicFile file(path);
    file.write(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
        "byte_order=\"LittleEndian\">\n<Collection>\n");
    for (std::size_t i = 0; i < frame_count; ++i) {
        const auto put = [&](std::size_t part, const std::string& name, std::size_t frame) {
            file.write(fmt::format("<DataSet timestep=\"{}\" part=\"{}\" name=\"{}\" file=\"{}\"/>\n",
                                   static_cast<double>(i) / frames_per_second, part, name,
                                   relative_path(frame, name)));
        };
        put(0, "cloth", i);
        for (std::size_t k = 0; k < obstacles.size(); ++k)
            put(k + 1, obstacles[k].name, count_obstacle_frames(obstacles[k], frame_count) > 1 ? i : 0);
    }
    file.write("</Collection>\n</VTKFile>\n");
    file.commit();
}

}  // namespace arris
