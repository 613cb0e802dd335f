// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/cloth_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/cloth_input/cut_pattern.h"
#include "geometry/cloth_input/mesh_lines.h"
#include "geometry/cloth_input/pattern_lattice.h"
#include "geometry/cloth_input/unstructured.h"
#include "geometry/input_error.h"
#include "geometry/rigid_motion.h"

namespace arris {
namespace {

// i / n of `length`; exactly `length` at i = n.
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

std::string name_of(const ClothGrid& grid)
{
    return fmt::format("cloth of size [{}, {}] and resolution [{}, {}]", grid.size.x(), grid.size.y(),
                       grid.resolution[0], grid.resolution[1]);
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
}

// Whether the pattern must be cut to fit the rectangle: it is turned, or has folds.
bool is_cut(const ClothGrid& grid)
{
    return !grid.folds.empty() || rotation_about(Vec3::UnitZ(), grid.pattern_angle) != Mat3::Identity();
}

// Constants measured over sizes of 10 to 1000 cells, side ratios of 1 to 30, and all angles.
// Unstructured: vertices per square of the mean side, and per mean side of half the border.
constexpr double kInside = 1.12, kOnBorder = 0.8;

GridCount count_regular(const ClothGrid& grid)
{
    const double nu = grid.resolution[0], nv = grid.resolution[1];
    const bool has_middles = grid.pattern == GridPattern::Cross;
    return {(nu + 1.0) * (nv + 1.0) + (has_middles ? nu * nv : 0.0), (has_middles ? 4.0 : 2.0) * nu * nv};
}

// Faces of a triangulated disc: F = 2 V - B - 2 with B vertices on the border.
double count_faces(double vertices, double border)
{
    return std::max(2.0, 2.0 * vertices - border - 2.0);
}

// Creases (border and fold lines) are divided at about a cell's length. Pattern vertices are dropped from a
// strip on either side.
GridCount estimate_cut_pattern(const ClothGrid& grid)
{
    const MeshLines graph = make_mesh_lines(rectangle_border(grid.size), grid.folds);
    const Mat2 back = rotation_about(Vec3::UnitZ(), -grid.pattern_angle).topLeftCorner<2, 2>();
    const Vec2 cell(grid.size.x() / grid.resolution[0], grid.size.y() / grid.resolution[1]);
    double border = 0.0, inside = 0.0;
    for (int s = 0; s < static_cast<int>(graph.segments.size()); ++s) {
        const auto [a, b] = graph.segments[s];
        const Vec2 along = (back * (graph.nodes[b] - graph.nodes[a])).cwiseQuotient(cell);
        (s < graph.border_count ? border : inside) += std::max(1.0, along.norm());
    }
    const double density = grid.pattern == GridPattern::Cross ? 2.0 : 1.0;
    const double cells = double(grid.resolution[0]) * grid.resolution[1];
    const double cleared = kCreaseClearance * density * (border + 2.0 * inside);
    const double vertices = std::max(density * cells - cleared, 0.0) + border + inside;
    return {vertices, count_faces(vertices, border)};
}

double mean_side(const ClothGrid& grid)
{
    return 0.5 * (grid.size.x() / grid.resolution[0] + grid.size.y() / grid.resolution[1]);
}

// Faces have the cells' mean side. In a narrow rectangle, the least angle of 20.7 degrees lets no face be
// much longer than the rectangle is wide.
GridCount estimate_unstructured(const ClothGrid& grid)
{
    const double side = mean_side(grid);
    const double nu = grid.size.x() / side, nv = grid.size.y() / side;
    // On a rectangle narrower than the mean side, one vertex per square of the width: sides come from
    // repeated halving, and are 0.77 to 1.31 widths long.
    const double narrow = grid.size.maxCoeff() / grid.size.minCoeff();
    const double vertices = std::max(kInside * nu * nv + kOnBorder * (nu + nv) + 1.0, narrow);
    return {vertices, count_faces(vertices, std::max(2.0 * (nu + nv), narrow))};
}

void require_few(const ClothGrid& grid, const char* how, double vertices)
{
    if (vertices <= kMostGridVertices) return;
    throw InputError(fmt::format("{} {} {:.3g} vertices; at most {:.0e} are allowed", name_of(grid), how,
                                 vertices, kMostGridVertices));
}

ClothMesh make_mesh(const ClothGrid& grid)
{
    if (grid.pattern == GridPattern::Unstructured)
        return make_unstructured(make_mesh_lines(rectangle_border(grid.size), grid.folds), mean_side(grid));
    return is_cut(grid) ? make_cut_pattern(grid) : make_regular(grid);
}

}  // namespace

GridCount estimate_cloth_grid(const ClothGrid& grid)
{
    require_valid(grid);
    if (grid.pattern == GridPattern::Unstructured) return estimate_unstructured(grid);
    return is_cut(grid) ? estimate_cut_pattern(grid) : count_regular(grid);
}

ClothMesh make_cloth_grid(const ClothGrid& grid)
{
    require_few(grid, "would have about", estimate_cloth_grid(grid).vertices);
    ClothMesh mesh = make_mesh(grid);
    require_few(grid, "has", mesh.vertex_count());
    return mesh;
}

}  // namespace arris
