// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth/material_grid.h"

#include <algorithm>
#include <cmath>

#include "geometry/cloth/material_box.h"

namespace arris {

MaterialGrid make_material_grid(const std::vector<Vec2>& points, double spacing, int most_nodes)
{
    Vec2 low = points.front(), high = low;
    for (const Vec2& X : points) {
        low = low.cwiseMin(X);
        high = high.cwiseMax(X);
    }
    const Vec2 size = high - low;
    // (size_x / s + 1) (size_y / s + 1) <= n, solved for s.
    const double around = size.x() + size.y(), area = size.x() * size.y(), most = most_nodes - 1.0;
    const double least = (around + std::sqrt(around * around + 4.0 * most * area)) / (2.0 * most);
    MaterialGrid grid;
    grid.low = low;
    grid.spacing = std::max(spacing, least);
    for (int k = 0; k < 2; ++k)
        grid.count[k] = 1 + static_cast<int>(std::ceil(size[k] / grid.spacing - kMaterialTolerance));
    return grid;
}

GridPlace find_place(const MaterialGrid& grid, const Vec2& X)
{
    std::array<int, 2> first, second;
    std::array<double, 2> share;
    for (int k = 0; k < 2; ++k) {
        const double last = grid.count[k] - 1.0;
        const double at = std::clamp((X[k] - grid.low[k]) / grid.spacing, 0.0, last);
        first[k] = static_cast<int>(at);
        second[k] = std::min(first[k] + 1, grid.count[k] - 1);
        share[k] = at - first[k];
    }
    const auto& [s, t] = share;
    return {{grid.index(first[0], first[1]), grid.index(first[0], second[1]), grid.index(second[0], first[1]),
             grid.index(second[0], second[1])},
            {(1.0 - s) * (1.0 - t), (1.0 - s) * t, s * (1.0 - t), s * t}};
}

double interpolate(const MaterialGrid& grid, const std::vector<float>& values, const Vec2& X)
{
    const GridPlace place = find_place(grid, X);
    double value = 0.0;
    for (int k = 0; k < 4; ++k) value += place.weight[k] * values[place.node[k]];
    return value;
}

void limit_slope(const MaterialGrid& grid, double slope, std::vector<float>& values)
{
    const double along = slope * grid.spacing, across = std::sqrt(2.0) * along;
    const auto lower = [&](int i, int j, int di, int dj) {
        const int k = i + di, l = j + dj;
        if (k < 0 || l < 0 || k >= grid.count[0] || l >= grid.count[1]) return;
        const double most = values[grid.index(k, l)] + (di != 0 && dj != 0 ? across : along);
        float& value = values[grid.index(i, j)];
        if (value > most) value = static_cast<float>(most);
    };
    // Two passes of a distance transform: each value is lowered by the neighbours that the pass has seen.
    for (int i = 0; i < grid.count[0]; ++i)
        for (int j = 0; j < grid.count[1]; ++j)
            for (const auto& [di, dj] : {std::pair{-1, -1}, {-1, 0}, {-1, 1}, {0, -1}}) lower(i, j, di, dj);
    for (int i = grid.count[0] - 1; i >= 0; --i)
        for (int j = grid.count[1] - 1; j >= 0; --j)
            for (const auto& [di, dj] : {std::pair{1, 1}, {1, 0}, {1, -1}, {0, 1}}) lower(i, j, di, dj);
}

}  // namespace arris
