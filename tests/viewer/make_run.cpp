// SPDX-License-Identifier: GPL-3.0-or-later
// make_run DIR TITLE FRAMES CELLS [MOST_BYTES [obstacles|deforming|marks]]: writes a run without a
// simulation, for trying and testing the viewer. A square cloth waves and folds over a sharp edge that moves
// along the cloth, so EOL edges and mesh change with time. With `obstacles` there are a table at rest, a wire
// that turns, and nails that rise. With `deforming` there is a pole that bends. `marks` is frame 0 alone,
// with a block, in which a triangle, a segment and a point are marked.
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "app/export/viewer_html.h"
#include "app/files/frame.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "tests/formula_deformation.h"

namespace arris {
namespace {

constexpr double kFramesPerSecond = 24.0;
constexpr double kSize = 1.0;  // m

/// Bends a flat point about `edge` on the u axis: beyond the edge the cloth hangs down steeply.
Vec3 fold(double u, double v, double edge, double wave)
{
    const double over = std::max(0.0, u - edge);
    const double drop = 1.35;  // rad
    return {std::min(u, edge) + over * std::cos(drop), v, 0.6 + wave - over * std::sin(drop)};
}

Frame make_frame(int number, int frames, int cells)
{
    Frame frame;
    const double phase = 2.0 * std::numbers::pi * number / std::max(frames, 1);
    // The column of vertices on the edge follows the edge; when the edge passes another column, that one
    // takes over.
    const double edge = 0.62 + 0.12 * std::sin(phase);
    const int column = static_cast<int>(std::lround(edge * cells));
    const bool is_folded = number >= frames / 3;
    for (int i = 0; i <= cells; ++i) {
        for (int j = 0; j <= cells; ++j) {
            const double u = is_folded && i == column ? edge : kSize * i / cells;
            const double v = kSize * j / cells;
            const double free = is_folded ? std::max(0.0, edge - u) : u;
            const double wave = 0.16 * free * std::sin(9.0 * free - 2.0 * phase) +
                                0.03 * std::cos(7.0 * v + phase) * std::abs(u - edge);
            frame.world.push_back(fold(u, v, is_folded ? edge : 9.0, wave));
            frame.material.emplace_back(u, v);
            const bool is_on_edge = is_folded && i == column;
            frame.eol.push_back(is_on_edge ? (j == 0 || j == cells ? 2 : 1) : 0);
            frame.contact.push_back(is_on_edge || (is_folded && i > column - 5 && i < column) ? 1 : 0);
        }
    }
    const auto vertex = [&](int i, int j) { return i * (cells + 1) + j; };
    for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
            frame.faces.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
            frame.faces.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
        }
    }
    if (is_folded)
        for (int j = 0; j < cells; ++j) frame.eol_edges.push_back({vertex(column, j), vertex(column, j + 1)});
    for (const Face& face : frame.faces) {
        const Vec2 middle =
            (frame.material[face[0]] + frame.material[face[1]] + frame.material[face[2]]) / 3.0;
        frame.strain.push_back(0.06 * std::exp(-40.0 * std::pow(middle.x() - edge, 2)) +
                               0.01 * std::sin(12.0 * middle.y() + phase));
    }
    const std::size_t n = frame.world.size(), m = frame.faces.size();
    frame.vertex_velocity.assign(n, Vec3::Zero());
    // The speed grows along v from 0 to 2 m/s.
    for (const Vec2& at : frame.material) frame.material_velocity.emplace_back(0.0, 0.0, 2.0 * at.y());
    for (std::size_t v = 0; v < n; ++v) frame.ids.push_back(static_cast<std::uint32_t>(v));
    frame.stretch_energy.assign(m, 0.0);
    frame.bending_energy.assign(m, 0.0);
    return frame;
}

std::vector<ObstacleRecord> make_obstacles()
{
    ObstacleRecord table{"table", make_box({0.5, 1.2, 0.1}), {}, {}};
    table.placement.translation = {0.3, 0.5, 0.35};
    ObstacleRecord wire{
        "wire", make_wire({{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.3, 1.0, 0.1}}, false), {}, {}};
    wire.placement.translation = {1.1, 0.0, 0.4};
    wire.motion.angular_velocity = {0.0, 0.0, 0.5};
    wire.motion.pivot = {1.1, 0.5, 0.0};
    ObstacleRecord nails{"nails", make_points({{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}}), {}, {}};
    nails.placement.translation = {-0.1, 0.0, 0.4};
    nails.motion.velocity = {0.0, 0.0, 0.2};
    return {table, wire, nails};
}

/// A pole, 1 m high, whose top moves by 0.5 m a second against x, and a wire and a nail at its top.
std::vector<ObstacleRecord> make_deforming()
{
    ObstacleMesh mesh = make_box({0.1, 0.1, 1.0});
    const int top = static_cast<int>(mesh.points.size());
    for (const Vec3& point : {Vec3(0.0, 0.0, 0.5), Vec3(0.0, 0.4, 0.5), Vec3(0.0, -0.4, 0.5)})
        mesh.points.push_back(point);
    mesh.segments = {{top, top + 1}};
    mesh.lone_points = {top + 2};
    auto bends = std::make_shared<FormulaDeformation>(
        mesh.points,
        [](const Vec3& rest, double time) {
            return Vec3(rest - Vec3(0.5 * time * (rest.z() + 0.5), 0.0, 0.0));
        },
        [](const Vec3& rest, double) { return Vec3(-0.5 * (rest.z() + 0.5), 0.0, 0.0); },
        std::vector<double>{0.0, 100.0});
    ObstacleRecord pole{"pole", std::move(mesh), {}, {}, std::move(bends)};
    pole.placement.translation = {-0.3, 0.5, 0.5};
    return {pole};
}

/// A block that hides the marks, which lie inside it.
ViewerStill make_still(const std::string& title, int cells)
{
    ViewerStill still{title, make_frame(0, 1, cells), {{"block", make_box({0.4, 0.4, 0.4}), {}, {}}}, {}};
    still.obstacles[0].placement.translation = {0.5, 0.5, 1.0};
    ObstacleMesh mesh;
    mesh.points = {{0.4, 0.5, 0.9}, {0.6, 0.5, 0.9}, {0.5, 0.5, 1.1}};
    mesh.faces = {{0, 1, 2}};
    mesh.segments = {{0, 1}};
    mesh.lone_points = {2};
    still.marks = {{"block", mesh, {}, {}}};
    return still;
}

void make_run(const std::string& directory, int frames, int cells, const ViewerOptions& options,
              const std::vector<ObstacleRecord>& obstacles)
{
    std::filesystem::create_directories(directory + "/frames");
    for (int number = 0; number < frames; ++number) {
        std::string digits = std::to_string(number);
        digits.insert(0, 5 - digits.size(), '0');
        write_frame(directory + "/frames/cloth_" + digits + ".ply", make_frame(number, frames, cells));
    }
    write_viewer(directory, options, obstacles);
}

}  // namespace
}  // namespace arris

int main(int argc, char** argv)
{
    if (argc < 5 || argc > 7) {
        std::fputs("usage: make_run DIR TITLE FRAMES CELLS [MOST_BYTES [obstacles|deforming|marks]]\n",
                   stderr);
        return 2;
    }
    try {
        arris::ViewerOptions options{argv[2], arris::kFramesPerSecond};
        if (argc >= 6) options.most_bytes = std::stoul(argv[5]);
        const std::string kind = argc == 7 ? argv[6] : "";
        if (kind == "marks") {
            std::filesystem::create_directories(argv[1]);
            arris::write_viewer_still(std::string(argv[1]) + "/viewer.html", "<!-- marks -->\n",
                                      arris::make_still(argv[2], std::stoi(argv[4])));
            return 0;
        }
        std::vector<arris::ObstacleRecord> obstacles;
        if (!kind.empty())
            obstacles = kind == "deforming" ? arris::make_deforming() : arris::make_obstacles();
        arris::make_run(argv[1], std::stoi(argv[3]), std::stoi(argv[4]), options, obstacles);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "make_run: %s\n", error.what());
        return 1;
    }
}
