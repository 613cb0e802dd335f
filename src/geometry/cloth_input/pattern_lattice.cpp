// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/pattern_lattice.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "geometry/cloth/material_box.h"
#include "geometry/rigid_motion.h"

namespace arris {
namespace {

struct Interval {
    double min = std::numeric_limits<double>::infinity();
    double max = -std::numeric_limits<double>::infinity();

    void add(double x)
    {
        min = std::min(min, x);
        max = std::max(max, x);
    }
};

// The interval of x in which the parallelogram contains points at height `y`.
Interval cut_at(const std::array<Vec2, 4>& corners, double y)
{
    Interval cut;
    for (int k = 0; k < 4; ++k) {
        const Vec2& a = corners[k];
        const Vec2& b = corners[(k + 1) % 4];
        if (a.y() == y) cut.add(a.x());
        if ((a.y() < y && y < b.y()) || (b.y() < y && y < a.y()))
            cut.add(a.x() + (b.x() - a.x()) * ((y - a.y()) / (b.y() - a.y())));
    }
    return cut;
}

bool is_odd(int i)
{
    return i % 2 != 0;
}
double half_if_odd(int half_row)
{
    return is_odd(half_row) ? 0.5 : 0.0;
}

}  // namespace

PatternLattice::PatternLattice(const ClothGrid& grid)
    : pattern_(grid.pattern), size_(grid.size), centre_(0.5 * grid.size), resolution_(grid.resolution)
{
    assert(pattern_ != GridPattern::Unstructured);
    rotation_ = rotation_about(Vec3::UnitZ(), grid.pattern_angle).topLeftCorner<2, 2>();
    is_turned_ = rotation_ != Mat2::Identity();
    const std::array<Vec2, 4> corners = {to_cells({0.0, 0.0}), to_cells({size_.x(), 0.0}), to_cells(size_),
                                         to_cells({0.0, size_.y()})};
    Interval height;
    for (const Vec2& corner : corners) height.add(corner.y());
    first_half_row_ = static_cast<int>(std::ceil(2.0 * (height.min - kMaterialTolerance)));
    const int last = static_cast<int>(std::floor(2.0 * (height.max + kMaterialTolerance)));
    for (int half_row = first_half_row_; half_row <= last; ++half_row) append_row(half_row, corners);
}

void PatternLattice::append_row(int half_row, const std::array<Vec2, 4>& corners)
{
    Row row{0, 0, vertex_count()};
    if (!is_odd(half_row) || pattern_ == GridPattern::Cross) {
        const auto [low, high] =
            std::minmax({corners[0].y(), corners[1].y(), corners[2].y(), corners[3].y()});
        const double y = 0.5 * half_row;
        const double shift = half_if_odd(half_row);
        const Interval cut = cut_at(corners, std::clamp(y, low, high));
        row.first = static_cast<int>(std::ceil(cut.min - shift - kMaterialTolerance));
        const int last = static_cast<int>(std::floor(cut.max - shift + kMaterialTolerance));
        row.count = std::max(last - row.first + 1, 0);
        for (int i = row.first; i <= last; ++i) places_.emplace_back(i + shift, y);
    }
    rows_.push_back(row);
}

// Turns back about the centre, then scales to cells.
Vec2 PatternLattice::to_cells(const Vec2& material) const
{
    const Vec2 X = is_turned_ ? Vec2(rotation_.transpose() * (material - centre_) + centre_) : material;
    return {X.x() / size_.x() * resolution_[0], X.y() / size_.y() * resolution_[1]};
}

Vec2 PatternLattice::to_material(const Vec2& cells) const
{
    const Vec2 X(size_.x() * (cells.x() / resolution_[0]), size_.y() * (cells.y() / resolution_[1]));
    return is_turned_ ? Vec2(rotation_ * (X - centre_) + centre_) : X;
}

const PatternLattice::Row* PatternLattice::row_at(int half_row) const
{
    const int k = half_row - first_half_row_;
    return k >= 0 && k < static_cast<int>(rows_.size()) ? &rows_[k] : nullptr;
}

int PatternLattice::find(int half_row, int i) const
{
    const Row* row = row_at(half_row);
    if (row == nullptr || i < row->first || i >= row->first + row->count) return -1;
    return row->offset + i - row->first;
}

std::vector<int> PatternLattice::vertices_in(const Vec2& min, const Vec2& max) const
{
    std::vector<int> vertices;
    const int last = static_cast<int>(std::floor(2.0 * max.y()));
    for (int half_row = static_cast<int>(std::ceil(2.0 * min.y())); half_row <= last; ++half_row) {
        const Row* row = row_at(half_row);
        if (row == nullptr) continue;
        const double shift = half_if_odd(half_row);
        const int begin = std::max(static_cast<int>(std::ceil(min.x() - shift)), row->first);
        const int end = std::min(static_cast<int>(std::floor(max.x() - shift)) + 1, row->first + row->count);
        for (int i = begin; i < end; ++i) vertices.push_back(row->offset + i - row->first);
    }
    return vertices;
}

std::vector<int> PatternLattice::cells_in(const Vec2& min, const Vec2& max) const
{
    std::vector<int> cells;
    const int i_end = static_cast<int>(std::floor(max.x())) + 1;
    const int j_end = static_cast<int>(std::floor(max.y())) + 1;
    for (int j = static_cast<int>(std::ceil(min.y())) - 1; j < j_end; ++j)
        for (int i = static_cast<int>(std::ceil(min.x())) - 1; i < i_end; ++i)
            if (const int cell = find(2 * j, i); cell >= 0) cells.push_back(cell);
    return cells;
}

std::vector<Face> PatternLattice::faces_of(int cell) const
{
    const int i = static_cast<int>(std::lround(places_[cell].x()));
    const int j = static_cast<int>(std::lround(places_[cell].y()));
    const int a = cell;
    const int b = find(2 * j, i + 1);
    const int c = find(2 * j + 2, i + 1);
    const int d = find(2 * j + 2, i);
    if (pattern_ == GridPattern::Cross) {
        const int m = find(2 * j + 1, i);
        return {Face{a, b, m}, Face{b, c, m}, Face{c, d, m}, Face{d, a, m}};
    }
    if (pattern_ == GridPattern::Alternating && is_odd(i + j)) return {Face{a, b, d}, Face{b, c, d}};
    return {Face{a, b, c}, Face{a, c, d}};
}

}  // namespace arris
