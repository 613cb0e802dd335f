// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/forward_columns.h"

#include <cblas.h>

#include <algorithm>
#include <array>

#include "geometry/batches.h"
#include "geometry/sort_unique.h"

namespace arris {
namespace {

/// Columns per panel: enough for efficient matrix products, few enough that their paths are nearly equal.
constexpr int kPanelWidth = 16;

}  // namespace

void ForwardColumns::append(const std::vector<SparseVector>& columns)
{
    const int count = static_cast<int>(columns.size()), old = static_cast<int>(panels_.size());
    gram_.conservativeResize(size_ + count, size_ + count);
    for (int first = 0; first < count; first += kPanelWidth)
        panels_.push_back({size_ + first, std::min(kPanelWidth, count - first), {}, {}, {}});
    const int all = static_cast<int>(panels_.size());
    for_each_batch(all - old, 1, [&](int p, int, int) {
        const SparseVector* own = columns.data() + static_cast<std::ptrdiff_t>(p) * kPanelWidth;
        find_path(own, panels_[old + p]);
        solve(own, panels_[old + p]);
    });
    for (int p = old; p < all; ++p) flops_ += flops_of(panels_[p]);
    // The new panels with every panel before them, and with themselves.
    std::vector<std::array<int, 2>> pairs;
    for (int p = old; p < all; ++p)
        for (int q = 0; q <= p; ++q) pairs.push_back({p, q});
    flops_ += sum_in_batches<double>(
        static_cast<int>(pairs.size()),
        [&](int k, int) { return set_gram(panels_[pairs[k][0]], panels_[pairs[k][1]]); }, 1);
    size_ += count;
}

/// The supernodes from the columns' unknowns to the root.
void ForwardColumns::find_path(const SparseVector* columns, Panel& panel) const
{
    const EliminationTree& tree = factorization_->tree();
    for (int c = 0; c < panel.width; ++c)
        for (const auto& [unknown, value] : columns[c])
            panel.path.push_back(tree.supernode_of[factorization_->position()[unknown]]);
    sort_unique(panel.path);
    std::vector<int> above;
    for (int s : panel.path)
        for (s = tree.parent[s]; s >= 0; s = tree.parent[s]) above.push_back(s);
    panel.path.insert(panel.path.end(), above.begin(), above.end());
    sort_unique(panel.path);
}

/// Row-major rows are column-major transposed: X^T (width x columns) L11^T = B^T, then B2^T -= X^T L21^T.
/// What a supernode subtracts from the rows below it goes to its parent.
void ForwardColumns::solve(const SparseVector* columns, Panel& panel) const
{
    const EliminationTree& tree = factorization_->tree();
    const std::size_t width = static_cast<std::size_t>(panel.width);
    const auto index_of = [&](int s) {
        return std::lower_bound(panel.path.begin(), panel.path.end(), s) - panel.path.begin();
    };
    std::size_t size = 0, size_below = 0;
    std::vector<std::size_t> below_offset;
    for (const int s : panel.path) {
        panel.offset.push_back(size);
        below_offset.push_back(size_below);
        size += width * static_cast<std::size_t>(tree.columns(s));
        size_below += width * static_cast<std::size_t>(tree.below(s));
    }
    panel.values.assign(size, 0.0);
    std::vector<double> below(size_below, 0.0);
    for (std::size_t c = 0; c < width; ++c)
        for (const auto& [unknown, value] : columns[c]) {
            const int position = factorization_->position()[unknown], s = tree.supernode_of[position];
            panel.values[panel.offset[index_of(s)] + width * (position - tree.first_column[s]) + c] += value;
        }
    for (std::size_t k = 0; k < panel.path.size(); ++k) {
        const Supernode block = factorization_->supernode(panel.path[k]);
        double *x = panel.values.data() + panel.offset[k], *update = below.data() + below_offset[k];
        cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, panel.width,
                    block.columns, 1.0, block.values, block.row_count, x, panel.width);
        const int rows = block.row_count - block.columns;
        if (rows == 0) continue;
        cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, panel.width, rows, block.columns, -1.0, x,
                    panel.width, block.values + block.columns, block.row_count, 1.0, update, panel.width);
        const int parent = tree.parent[panel.path[k]], columns_above = tree.columns(parent);
        const auto above = index_of(parent);
        const int* place = tree.place.data() + tree.first_row[panel.path[k]] + block.columns;
        for (int r = 0; r < rows; ++r, update += width) {
            double* target = place[r] < columns_above
                                 ? panel.values.data() + panel.offset[above] + width * place[r]
                                 : below.data() + below_offset[above] + width * (place[r] - columns_above);
            for (std::size_t c = 0; c < width; ++c) target[c] += update[c];
        }
    }
}

double ForwardColumns::flops_of(const Panel& panel) const
{
    const EliminationTree& tree = factorization_->tree();
    double flops = 0.0;
    for (const int s : panel.path)
        flops += static_cast<double>(panel.width) * tree.columns(s) * (tree.columns(s) + 2.0 * tree.below(s));
    return flops;
}

/// The product of two panels, on the blocks that both contain. Returns its flops.
double ForwardColumns::set_gram(const Panel& a, const Panel& b)
{
    Eigen::MatrixXd product = Eigen::MatrixXd::Zero(a.width, b.width);
    double flops = 0.0;
    for (std::size_t i = 0, j = 0; i < a.path.size() && j < b.path.size();) {
        if (a.path[i] < b.path[j]) {
            ++i;
        } else if (a.path[i] > b.path[j]) {
            ++j;
        } else {
            const int columns = factorization_->tree().columns(a.path[i]);
            flops += 2.0 * a.width * b.width * columns;
            cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, a.width, b.width, columns, 1.0,
                        a.values.data() + a.offset[i++], a.width, b.values.data() + b.offset[j++], b.width,
                        1.0, product.data(), a.width);
        }
    }
    gram_.block(a.first, b.first, a.width, b.width) = product;
    gram_.block(b.first, a.first, b.width, a.width) = product.transpose();
    return flops;
}

Eigen::VectorXd ForwardColumns::dot(const Eigen::VectorXd& forward) const
{
    Eigen::VectorXd result = Eigen::VectorXd::Zero(size_);
    for_each_in_batches(
        static_cast<int>(panels_.size()),
        [&](int p) {
            const Panel& panel = panels_[p];
            for (std::size_t k = 0; k < panel.path.size(); ++k) {
                const Supernode block = factorization_->supernode(panel.path[k]);
                cblas_dgemv(CblasColMajor, CblasNoTrans, panel.width, block.columns, 1.0,
                            panel.values.data() + panel.offset[k], panel.width, forward.data() + block.first,
                            1, 1.0, result.data() + panel.first, 1);
            }
        },
        4);
    return result;
}

/// Each task has some supernodes, and there takes the panels in order.
void ForwardColumns::accumulate(const Eigen::VectorXd& coefficients, Eigen::VectorXd& forward) const
{
    constexpr int kSupernodes = 8;
    for_each_batch(factorization_->tree().size(), kSupernodes, [&](int first, int last, int) {
        for (const Panel& panel : panels_) {
            const auto begin = std::lower_bound(panel.path.begin(), panel.path.end(), first);
            for (auto at = begin; at != panel.path.end() && *at < last; ++at) {
                const Supernode block = factorization_->supernode(*at);
                cblas_dgemv(CblasColMajor, CblasTrans, panel.width, block.columns, 1.0,
                            panel.values.data() + panel.offset[at - panel.path.begin()], panel.width,
                            coefficients.data() + panel.first, 1, 1.0, forward.data() + block.first, 1);
            }
        }
    });
}

}  // namespace arris
