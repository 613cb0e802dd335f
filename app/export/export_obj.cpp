// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/export/export_obj.h"

#include <fmt/format.h>

#include <iterator>

#include "app/files/atomic_file.h"

namespace arris {

void write_obj(const std::string& path, const Frame& frame, UpAxis up)
{
    fmt::memory_buffer text;
    const auto out = std::back_inserter(text);
    fmt::format_to(
        out,
        "# Arris: m, {} is up; vt: material coordinates; l: edges on a sharp feature, or on a fold "
        "that has just left it\no cloth\n",
        to_string(up));
    for (const Vec3& x : frame.world) fmt::format_to(out, "v {} {} {}\n", x[0], x[1], x[2]);
    for (const Vec2& X : frame.own_material()) fmt::format_to(out, "vt {} {}\n", X[0], X[1]);
    const auto put = [&](std::size_t f) {
        const Face &face = frame.faces[f], &points = frame.corners()[f];
        fmt::format_to(out, "f {}/{} {}/{} {}/{}\n", face[0] + 1, points[0] + 1, face[1] + 1, points[1] + 1,
                       face[2] + 1, points[2] + 1);
    };
    if (frame.pieces.empty())
        for (std::size_t f = 0; f < frame.faces.size(); ++f) put(f);
    for (std::size_t p = 0; p < frame.pieces.size(); ++p) {
        fmt::format_to(out, "g {}\n", frame.pieces[p].name);
        for (const int f : frame.faces_of(static_cast<int>(p))) put(static_cast<std::size_t>(f));
    }
    // Some readers make lines of a whole object that has any, so the edges are an object of their own.
    if (!frame.eol_edges.empty()) fmt::format_to(out, "o cloth_eol\n");
    for (const auto& [a, b] : frame.eol_edges) fmt::format_to(out, "l {} {}\n", a + 1, b + 1);
    write_atomically(path, {text.data(), text.size()});
}

void write_obj(const std::string& path, const ObstacleRecord& obstacle, const std::vector<Vec3>& points,
               UpAxis up)
{
    fmt::memory_buffer text;
    const auto out = std::back_inserter(text);
    const ObstacleMesh& mesh = obstacle.mesh;
    fmt::format_to(out, "# Arris: m, {} is up; l: wires; p: lone points\no {}\n", to_string(up),
                   obstacle.name);
    for (const Vec3& x : points) fmt::format_to(out, "v {} {} {}\n", x[0], x[1], x[2]);
    for (const auto& [a, b, c] : mesh.faces) fmt::format_to(out, "f {} {} {}\n", a + 1, b + 1, c + 1);
    for (const auto& [a, b] : mesh.segments) fmt::format_to(out, "l {} {}\n", a + 1, b + 1);
    for (const int point : mesh.lone_points) fmt::format_to(out, "p {}\n", point + 1);
    write_atomically(path, {text.data(), text.size()});
}

}  // namespace arris
