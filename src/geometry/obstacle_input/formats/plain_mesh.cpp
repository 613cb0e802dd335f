// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/formats/plain_mesh.h"

#include <fmt/format.h>

#include <utility>

#include "geometry/input_error.h"
#include "geometry/obj_file.h"
#include "geometry/obstacle_input/formats/ply_file.h"
#include "geometry/obstacle_input/formats/stl_file.h"

namespace arris {
namespace {

PlainMesh from_obj(std::string_view bytes)
{
    ObjFile file = read_obj(bytes);
    PlainMesh mesh;
    for (const auto& [place, line] : file.vertices) {
        mesh.points.push_back(place);
        mesh.lines.push_back(line);
    }
    for (const ObjCorner& corner : file.corners) mesh.corners.push_back(corner.vertex);
    mesh.corner_counts = std::move(file.corner_counts);
    mesh.segments = std::move(file.segments);
    mesh.lone_points = std::move(file.lone_points);
    mesh.warnings = std::move(file.warnings);
    if (mesh.corners.empty() && mesh.segments.empty() && mesh.lone_points.empty())
        throw InputError(
            fmt::format("no faces ('f'), lines ('l') or points ('p') among {} vertices", mesh.points.size()));
    return mesh;
}

// A point that no element names does no harm.
void require_finite(const PlainMesh& mesh)
{
    const auto require = [&](int point) {
        const Vec3& p = mesh.points[point];
        if (p.allFinite()) return;
        const std::string line = mesh.lines.empty() ? "" : fmt::format("line {}: ", mesh.lines[point]);
        throw InputError(
            fmt::format("{}vertex {} ({}, {}, {}) is not finite", line, point + 1LL, p.x(), p.y(), p.z()));
    };
    for (const int point : mesh.corners) require(point);
    for (const auto& [a, b] : mesh.segments) {
        require(a);
        require(b);
    }
    for (const int point : mesh.lone_points) require(point);
}

}  // namespace

bool is_plain_format(std::string_view extension)
{
    return extension == "obj" || extension == "stl" || extension == "ply";
}

PlainMesh read_plain_mesh(std::string_view extension, std::string_view bytes)
{
    if (bytes.empty()) throw InputError("empty");
    PlainMesh mesh = extension == "obj"   ? from_obj(bytes)
                     : extension == "stl" ? read_stl(bytes)
                                          : read_ply(bytes);
    require_finite(mesh);
    return mesh;
}

}  // namespace arris
