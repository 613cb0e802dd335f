// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "geometry/cloth_input/cloth_grid.h"

namespace arris {

/// Cells: pattern vertices nearer to a crease are dropped. Measured over all patterns and angles; raising it
/// makes the faces beside a crease larger than the others.
inline constexpr double kCreaseClearance = 0.45;

/// The vertices of a grid's regular pattern, turned about the middle of the rectangle, that lie in the
/// rectangle. They are given in *cell coordinates*: a cell is the unit square between whole numbers, and a
/// "cross" cell has its middle at halves. Storage is proportional to the number of cells inside and the
/// border's length in cells.
class PatternLattice {
  public:
    /// `grid` must be valid and its pattern regular.
    explicit PatternLattice(const ClothGrid& grid);

    Vec2 to_cells(const Vec2& material) const;
    Vec2 to_material(const Vec2& cells) const;

    int vertex_count() const { return static_cast<int>(places_.size()); }
    const Vec2& place(int vertex) const { return places_[vertex]; }  ///< cell coordinates

    /// Vertices whose cell coordinates lie in the box, in ascending order.
    std::vector<int> vertices_in(const Vec2& min, const Vec2& max) const;

    /// Cells that meet the box, each named by the vertex at its lower left corner, ascending. A cell whose
    /// lower left corner is outside the rectangle is left out, as it is incomplete.
    std::vector<int> cells_in(const Vec2& min, const Vec2& max) const;

    /// The faces of a cell, counter-clockwise. A vertex outside the rectangle is -1.
    std::vector<Face> faces_of(int cell) const;

  private:
    // Vertices at y = half_row / 2, with x = first, first + 1, ... (plus 1/2 if half_row is odd).
    struct Row {
        int first = 0, count = 0, offset = 0;
    };

    int find(int half_row, int i) const;
    const Row* row_at(int half_row) const;
    void append_row(int half_row, const std::array<Vec2, 4>& corners);

    GridPattern pattern_;
    Vec2 size_, centre_;
    std::array<int, 2> resolution_;
    Mat2 rotation_ = Mat2::Identity();
    bool is_turned_ = false;
    int first_half_row_ = 0;
    std::vector<Row> rows_;
    std::vector<Vec2> places_;
};

}  // namespace arris
