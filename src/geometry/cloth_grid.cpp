// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/cut_pattern.h"
#include "geometry/input_error.h"
#include "geometry/rigid_motion.h"

namespace arris {
namespace {

// The share i / n of `length`, exactly `length` at i = n.
double share(double length, double i, int n)
{
    return i < n ? length * (i / n) : length;
}

void add_vertex(const Vec2& X, ClothMesh& mesh)
{
    mesh.material.push_back(X);
    mesh.world.emplace_back(X.x(), X.y(), 0.0);
}

// Splits the cell with corners a, b, c, d (counter-clockwise from its least u and v).
void add_cell(const std::array<int, 4>& corner, bool is_falling, ClothMesh& mesh)
{
    const auto [a, b, c, d] = corner;
    if (is_falling) {
        mesh.faces.push_back({a, b, d});
        mesh.faces.push_back({b, c, d});
    } else {
        mesh.faces.push_back({a, b, c});
        mesh.faces.push_back({a, c, d});
    }
}

void add_crossed_cell(const std::array<int, 4>& corner, int middle, ClothMesh& mesh)
{
    for (int k = 0; k < 4; ++k) mesh.faces.push_back({corner[k], corner[(k + 1) % 4], middle});
}

ClothMesh make_regular(const ClothGrid& grid)
{
    ClothMesh mesh;
    const auto [nu, nv] = grid.resolution;
    for (int j = 0; j <= nv; ++j)
        for (int i = 0; i <= nu; ++i)
            add_vertex({share(grid.size.x(), i, nu), share(grid.size.y(), j, nv)}, mesh);
    for (int j = 0; j < nv; ++j) {
        for (int i = 0; i < nu; ++i) {
            const int a = j * (nu + 1) + i;
            const std::array<int, 4> corner = {a, a + 1, a + nu + 2, a + nu + 1};
            if (grid.pattern == GridPattern::Cross) {
                add_vertex({share(grid.size.x(), i + 0.5, nu), share(grid.size.y(), j + 0.5, nv)}, mesh);
                add_crossed_cell(corner, mesh.vertex_count() - 1, mesh);
            } else {
                add_cell(corner, grid.pattern == GridPattern::Alternating && (i + j) % 2 == 1, mesh);
            }
        }
    }
    return mesh;
}

// A grid of more vertices than this is refused: SI sizes and cells that make one are a slip of the pen.
constexpr double kMostVertices = 5e6;

std::string name_of(const ClothGrid& grid)
{
    return fmt::format("cloth of size [{}, {}] and resolution [{}, {}]", grid.size.x(), grid.size.y(),
                       grid.resolution[0], grid.resolution[1]);
}

// Vertices inside, and those along the border; a turned pattern of long cells has many of these.
double estimate_vertices(const ClothGrid& grid)
{
    const Vec2 cell(grid.size.x() / grid.resolution[0], grid.size.y() / grid.resolution[1]);
    const double cells = double(grid.resolution[0]) * grid.resolution[1];
    if (grid.pattern == GridPattern::Unstructured) {
        // Angles of 20.7 degrees leave no long faces: at least about one vertex a shorter side of the
        // rectangle.
        const double side = std::min(0.5 * cell.sum(), grid.size.minCoeff());
        return 1.5 * (1.0 + grid.size.x() / side) * (1.0 + grid.size.y() / side);
    }
    const Mat3 back = rotation_about(Vec3::UnitZ(), -grid.pattern_angle);
    double border = 0.0;
    for (int axis = 0; axis < 2; ++axis) {
        const Vec2 side = back.col(axis).head<2>() * grid.size[axis];
        border += 2.0 * side.cwiseQuotient(cell).norm();
    }
    return (grid.pattern == GridPattern::Cross ? 2.0 : 1.0) * cells + border;
}

void require_valid(const ClothGrid& grid)
{
    if (!grid.size.allFinite() || !(grid.size.minCoeff() > 0.0))
        throw InputError(name_of(grid) + ": sizes must be finite and positive");
    if (grid.resolution[0] < 1 || grid.resolution[1] < 1)
        throw InputError(name_of(grid) + ": at least one cell along u and v is needed");
    if (!std::isfinite(grid.pattern_angle))
        throw InputError(
            fmt::format("{}: pattern_angle {} is not finite", name_of(grid), grid.pattern_angle));
    const double vertices = estimate_vertices(grid);
    if (!(vertices <= kMostVertices))
        throw InputError(fmt::format("{} would have about {:.3g} vertices; at most {:.0e} are allowed",
                                     name_of(grid), vertices, kMostVertices));
}

bool is_turned(const ClothGrid& grid)
{
    return rotation_about(Vec3::UnitZ(), grid.pattern_angle) != Mat3::Identity();
}

}  // namespace

ClothMesh make_cloth_grid(const ClothGrid& grid)
{
    require_valid(grid);
    if (grid.pattern == GridPattern::Unstructured) return make_unstructured(grid);
    if (!grid.folds.empty() || is_turned(grid)) return make_cut_pattern(grid);
    return make_regular(grid);
}

}  // namespace arris
