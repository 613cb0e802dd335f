// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// Nodes of a regular grid that covers a part of the material: node (i, j) is at low + spacing (i, j), and
/// has the index i * count[1] + j in lists of values.
struct MaterialGrid {
    Vec2 low = Vec2::Zero();            ///< m
    double spacing = 1.0;               ///< m
    std::array<int, 2> count = {1, 1};  ///< nodes in each direction, at least 1

    int size() const { return count[0] * count[1]; }
    int index(int i, int j) const { return i * count[1] + j; }
    Vec2 node(int i, int j) const { return low + spacing * Vec2(i, j); }
};

/// A grid over the bounding box of these points, of at most about `most_nodes` nodes: its spacing is
/// `spacing` (m), or more where that would take more nodes. `points` may not be empty.
MaterialGrid make_material_grid(const std::vector<Vec2>& points, double spacing, int most_nodes);

/// Four nodes around a point, with bilinear weights that sum to 1. Beyond the grid its border counts.
struct GridPlace {
    std::array<int, 4> node;
    std::array<double, 4> weight;
};
GridPlace find_place(const MaterialGrid& grid, const Vec2& X);

/// Bilinear value, from one value a node.
double interpolate(const MaterialGrid& grid, const std::vector<float>& values, const Vec2& X);

/// Lowers values until none exceeds another by more than `slope` times the way between their nodes along
/// the grid's rows, columns and diagonals. Time linear in the number of nodes.
void limit_slope(const MaterialGrid& grid, double slope, std::vector<float>& values);

/// Sums of `Channels` values over rectangles of nodes, in constant time each.
template <int Channels>
class GridSums {
  public:
    using Value = Eigen::Matrix<double, Channels, 1>;

    /// `values`: one a node.
    GridSums(const MaterialGrid& grid, const std::vector<Value>& values) : grid_(grid)
    {
        const int rows = grid.count[0], columns = grid.count[1];
        sums_.assign(static_cast<std::size_t>(rows + 1) * (columns + 1), Value::Zero());
        for (int i = 0; i < rows; ++i) {
            Value row = Value::Zero();
            for (int j = 0; j < columns; ++j) {
                row += values[grid.index(i, j)];
                at(i + 1, j + 1) = at(i, j + 1) + row;
            }
        }
    }

    /// Sum over the nodes from `first` to `last`, both included; clamped to the grid.
    Value over(std::array<int, 2> first, std::array<int, 2> last) const
    {
        for (int k = 0; k < 2; ++k) {
            first[k] = std::max(first[k], 0);
            last[k] = std::min(last[k], grid_.count[k] - 1);
        }
        return at(last[0] + 1, last[1] + 1) - at(first[0], last[1] + 1) - at(last[0] + 1, first[1]) +
               at(first[0], first[1]);
    }

  private:
    Value& at(int i, int j) { return sums_[static_cast<std::size_t>(i) * (grid_.count[1] + 1) + j]; }
    const Value& at(int i, int j) const
    {
        return sums_[static_cast<std::size_t>(i) * (grid_.count[1] + 1) + j];
    }

    MaterialGrid grid_;
    std::vector<Value> sums_;  // of all nodes before a row and column
};

}  // namespace arris
