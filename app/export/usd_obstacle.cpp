// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/export/usd_obstacle.h"

#include <algorithm>
#include <functional>
#include <string>

#include "app/export/usd_text.h"

namespace arris {
namespace {

constexpr double kDrawnWidth = 0.002;  // m, of wires and points

/// USD multiplies row vectors from the left, so the matrix is transposed.
void put_matrix(fmt::memory_buffer& out, const Placement& placement)
{
    for (int column = 0; column < 3; ++column) {
        const Vec3 axis = placement.rotation.col(column);
        fmt::format_to(std::back_inserter(out), "{}({}, {}, {}, 0)", column == 0 ? "( " : ", ", axis[0],
                       axis[1], axis[2]);
    }
    const Vec3& t = placement.translation;
    fmt::format_to(std::back_inserter(out), ", ({}, {}, {}, 1) )", t[0], t[1], t[2]);
}

/// Time codes at which attributes have samples.
struct Samples {
    std::size_t count;  ///< at least 1, that of a value constant in time
    double frames_per_second;

    double time(std::size_t i) const { return static_cast<double>(i) / frames_per_second; }
};

using PutAt = std::function<void(fmt::memory_buffer&, double time)>;

/// Writes an attribute that `declaration` indents, types and names.
void write_attribute(AtomicFile& file, const std::string& declaration, const Samples& samples,
                     const PutAt& put_value)
{
    const bool is_constant = samples.count == 1;
    const std::string indent = declaration.substr(0, declaration.find_first_not_of(' '));
    file.write(declaration + (is_constant ? " = " : ".timeSamples = {\n"));
    for (std::size_t i = 0; i < samples.count; ++i) {
        fmt::memory_buffer text;
        if (!is_constant) fmt::format_to(std::back_inserter(text), "{}    {}: ", indent, i);
        put_value(text, samples.time(i));
        put(text, std::string_view(is_constant ? "\n" : ",\n"));
        file.write({text.data(), text.size()});
    }
    if (!is_constant) file.write(indent + "}\n");
}

template <class Items>
void write_line(AtomicFile& file, std::string_view declaration, const Items& items)
{
    fmt::memory_buffer text;
    put(text, declaration);
    put_array(text, items);
    put(text, std::string_view("\n"));
    file.write({text.data(), text.size()});
}

std::vector<Vec3> chosen(const std::vector<Vec3>& vectors, const std::vector<int>& indices)
{
    std::vector<Vec3> result;
    for (const int i : indices) result.push_back(vectors[static_cast<std::size_t>(i)]);
    return result;
}

/// Writes places and bounding box of the mesh's `points`, and their velocities where the mesh deforms.
void write_points(AtomicFile& file, const ObstacleRecord& obstacle, const std::vector<int>& points,
                  const Samples& run)
{
    const Samples samples = obstacle.is_deforming() ? run : Samples{1, run.frames_per_second};
    const auto places = [&](double time) { return chosen(obstacle.points_at(time), points); };
    write_attribute(file, "        point3f[] points", samples,
                    [&](auto& out, double time) { put_array(out, places(time)); });
    if (obstacle.is_deforming())
        write_attribute(file, "        vector3f[] velocities", samples, [&](auto& out, double time) {
            std::vector<Vec3> all, velocities;
            obstacle.deformation->find(time, all, velocities);
            put_array(out, chosen(velocities, points));
        });
    write_attribute(file, "        float3[] extent", samples,
                    [&](auto& out, double time) { put_bounds(out, places(time)); });
}

void write_surface(AtomicFile& file, const ObstacleRecord& obstacle, const Samples& run)
{
    const ObstacleMesh& mesh = obstacle.mesh;
    std::vector<int> all;
    for (std::size_t point = 0; point < mesh.points.size(); ++point) all.push_back(static_cast<int>(point));
    file.write(
        "    def Mesh \"surface\"\n    {\n"
        "        uniform token subdivisionScheme = \"none\"\n"
        "        uniform token orientation = \"rightHanded\"\n"
        "        uniform bool doubleSided = 1\n");
    write_line(file, "        int[] faceVertexCounts = ", std::vector<int>(mesh.faces.size(), 3));
    write_line(file, "        int[] faceVertexIndices = ", mesh.faces);
    write_points(file, obstacle, all, run);
    file.write("    }\n");
}

std::string widths()
{
    return fmt::format(
        "        float[] widths = [{}] (\n            interpolation = \"constant\"\n        )\n",
        kDrawnWidth);
}

void write_wires(AtomicFile& file, const ObstacleRecord& obstacle, const Samples& run)
{
    const auto& segments = obstacle.mesh.segments;
    std::vector<int> ends;
    for (const auto& segment : segments) ends.insert(ends.end(), segment.begin(), segment.end());
    file.write(
        "    def BasisCurves \"wires\"\n    {\n"
        "        uniform token type = \"linear\"\n");
    write_line(file, "        int[] curveVertexCounts = ", std::vector<int>(segments.size(), 2));
    write_points(file, obstacle, ends, run);
    file.write(widths() + "    }\n");
}

void write_lone_points(AtomicFile& file, const ObstacleRecord& obstacle, const Samples& run)
{
    file.write("    def Points \"points\"\n    {\n");
    write_points(file, obstacle, obstacle.mesh.lone_points, run);
    file.write(widths() + "    }\n");
}

}  // namespace

void write_usd_obstacle(AtomicFile& file, const ObstacleRecord& obstacle, std::size_t frame_count,
                        double frames_per_second)
{
    const Samples run{std::max<std::size_t>(frame_count, 1), frames_per_second};
    file.write(fmt::format("\ndef Xform \"{}\"\n{{\n", obstacle.name));
    write_attribute(file, "    matrix4d xformOp:transform",
                    obstacle.motion.is_moving() ? run : Samples{1, frames_per_second},
                    [&](auto& out, double time) { put_matrix(out, obstacle.at(time)); });
    file.write("    uniform token[] xformOpOrder = [\"xformOp:transform\"]\n");
    if (!obstacle.mesh.faces.empty()) write_surface(file, obstacle, run);
    if (!obstacle.mesh.segments.empty()) write_wires(file, obstacle, run);
    if (!obstacle.mesh.lone_points.empty()) write_lone_points(file, obstacle, run);
    file.write("}\n");
}

}  // namespace arris
