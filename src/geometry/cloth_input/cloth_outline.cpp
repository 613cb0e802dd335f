// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/cloth_outline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/cloth_input/unstructured.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

// Vertices per square of the edge length, and per edge length of the border. Measured over discs, stars,
// combs and rings of 3 to 100 edge lengths.
constexpr double kInside = 1.2, kOnBorder = 0.45;

// Signed, relative to the first corner, so that no digits are lost far from the origin.
double area_of(const std::vector<Vec2>& loop)
{
    double area = 0.0;
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) area += 0.5 * twice_area(loop[0], loop[k], loop[k + 1]);
    return area;
}

std::vector<Vec2> to_loop(const std::vector<Vec2>& polygon, bool is_hole)
{
    std::vector<Vec2> loop = polygon;
    loop.erase(std::unique(loop.begin(), loop.end()), loop.end());
    while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
    if ((area_of(loop) < 0.0) != is_hole) std::reverse(loop.begin(), loop.end());
    return loop;
}

}  // namespace

BorderLoops to_border_loops(const std::vector<Vec2>& outline, const std::vector<std::vector<Vec2>>& holes)
{
    BorderLoops border = {to_loop(outline, false)};
    for (const std::vector<Vec2>& hole : holes) border.push_back(to_loop(hole, true));
    return border;
}

double area_of(const BorderLoops& border)
{
    double area = 0.0;
    for (const std::vector<Vec2>& loop : border) area += area_of(loop);
    return area;
}

GridCount estimate_cloth_outline(const ClothOutline& outline)
{
    double on_border = 0.0;
    for (const std::vector<Vec2>& loop : outline.border) {
        for (std::size_t k = 0; k < loop.size(); ++k) {
            const double side = (loop[(k + 1) % loop.size()] - loop[k]).norm();
            on_border += std::max(1.0, std::round(side / outline.edge_length));
        }
    }
    const double squares = area_of(outline.border) / (outline.edge_length * outline.edge_length);
    const double vertices = std::max(kInside * squares + kOnBorder * on_border + 1.0, on_border);
    // With B vertices on the border and H holes, F = 2 V - B - 2 + 2 H.
    const double holes = static_cast<double>(outline.border.size()) - 1.0;
    return {vertices, std::max(1.0, 2.0 * vertices - on_border - 2.0 + 2.0 * holes)};
}

void require_few_vertices(double edge_length, double vertices)
{
    if (vertices > kMostGridVertices)
        throw InputError(
            fmt::format("edges of {} m would give about {:.3g} vertices; at most {:.0e} are allowed",
                        edge_length, vertices, kMostGridVertices));
}

ClothMesh make_cloth_outline(const ClothOutline& outline)
{
    require_few_vertices(outline.edge_length, estimate_cloth_outline(outline).vertices);
    return make_relaxed(make_mesh_lines(outline.border, outline.folds), outline.edge_length);
}

}  // namespace arris
