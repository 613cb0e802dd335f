// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/front.h"

#include <cblas.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <vector>

extern "C" void dpotrf_(const char* triangle, const int* size, double* values, const int* stride, int* info);

namespace arris {
namespace {

/// Columns of a tile; its rows are up to twice as many. 64 costs two per cent more, 128 as much.
constexpr int kTile = 96;

/// Runs the tasks 0 .. count - 1. A thread that waits for the last of them takes up no other work, which
/// might be a whole subtree.
template <class Task>
void run_all(int count, const Task& task)
{
    if (count == 1) return task(0);
    tbb::this_task_arena::isolate([&] { tbb::parallel_for(0, count, task, tbb::simple_partitioner()); });
}

bool is_cholesky_done(double* values, int size, int stride)
{
    int info = 0;
    dpotrf_("L", &size, values, &stride, &info);
    return info == 0;
}

/// X L^T = B for `rows` rows X of B, in place.
void divide(const double* triangle, int columns, int stride, double* values, int rows)
{
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, rows, columns, 1.0, triangle,
                stride, values, stride);
}

/// A block of the trailing lower triangle; `first_row` >= `first_column`.
struct Tile {
    int first_row, rows, first_column, columns;
};

/// Tiles over the columns `first` to `last`; those of the factor and those of the update have other strides,
/// so none has both.
void append_tiles(int first, int last, int row_count, std::vector<Tile>& tiles)
{
    for (int column = first; column < last; column += kTile)
        for (int row = column; row < row_count; row += 2 * kTile)
            tiles.push_back(
                {row, std::min(2 * kTile, row_count - row), column, std::min(kTile, last - column)});
}

/// Subtracts the product of a panel's rows from a tile.
void subtract_product(const double* panel, int width, const Front& front, const Tile& tile)
{
    double* target = front.column(tile.first_column) + tile.first_row;
    const int stride = tile.first_column < front.columns ? front.row_count : front.below();
    const double *left = panel + tile.first_row, *right = panel + tile.first_column;
    int done = 0;
    if (tile.first_row == tile.first_column) {
        done = tile.columns;
        cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, done, width, -1.0, left, front.row_count, 1.0,
                    target, stride);
    }
    if (tile.rows > done)
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, tile.rows - done, tile.columns, width, -1.0,
                    left + done, front.row_count, right, front.row_count, 1.0, target + done, stride);
}

bool eliminate_in_tiles(const Front& front)
{
    std::vector<Tile> tiles;
    for (int first = 0; first < front.columns; first += kTile) {
        const int width = std::min(kTile, front.columns - first), next = first + width;
        double* panel = front.column(first);
        if (!is_cholesky_done(panel + first, width, front.row_count)) return false;
        const int left = front.row_count - next;
        run_all((left + kTile - 1) / kTile, [&](int t) {
            divide(panel + first, width, front.row_count, panel + next + t * kTile,
                   std::min(kTile, left - t * kTile));
        });
        tiles.clear();
        append_tiles(next, front.columns, front.row_count, tiles);
        append_tiles(front.columns, front.row_count, front.row_count, tiles);
        run_all(static_cast<int>(tiles.size()),
                [&](int t) { subtract_product(panel, width, front, tiles[t]); });
    }
    return true;
}

}  // namespace

double* Front::column(int column) const
{
    if (column < columns) return factor + static_cast<std::ptrdiff_t>(column) * row_count;
    return update + static_cast<std::ptrdiff_t>(column - columns) * below() - columns;
}

bool eliminate(const Front& front)
{
    if (front.row_count > 2 * kTile) return eliminate_in_tiles(front);
    if (!is_cholesky_done(front.factor, front.columns, front.row_count)) return false;
    if (front.below() == 0) return true;
    double* lower = front.factor + front.columns;
    divide(front.factor, front.columns, front.row_count, lower, front.below());
    cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, front.below(), front.columns, -1.0, lower,
                front.row_count, 1.0, front.update, front.below());
    return true;
}

double critical_flops_of(int columns, int row_count)
{
    const double tile = std::min(kTile, row_count), tall = std::min(2 * kTile, row_count);
    double flops = 0.0;
    for (int first = 0; first < columns; first += kTile) {
        const double width = std::min(kTile, columns - first);
        flops += width * width * width / 3.0 + tile * width * width + 2.0 * tall * tile * width;
    }
    return flops;
}

}  // namespace arris
