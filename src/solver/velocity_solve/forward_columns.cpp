// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/forward_columns.h"

#include <cblas.h>

#include <algorithm>

namespace arris {
namespace {

/// Columns per panel: enough for efficient matrix products, few enough that their paths are nearly equal.
constexpr int kPanelWidth = 16;

}  // namespace

ForwardColumns::ForwardColumns(const Factorization& factorization)
    : factorization_(&factorization),
      rows_(factorization.position().size() * kPanelWidth, 0.0),
      is_on_path_(static_cast<std::size_t>(factorization.supernode_count()), 0)
{
}

void ForwardColumns::append(const std::vector<SparseVector>& columns)
{
    const int count = static_cast<int>(columns.size());
    gram_.conservativeResize(size_ + count, size_ + count);
    for (int first = 0; first < count; first += kPanelWidth)
        append_panel(columns.data() + first, std::min(kPanelWidth, count - first));
}

std::vector<int> ForwardColumns::path_of(const SparseVector* columns, int width)
{
    std::vector<int> path;
    for (int c = 0; c < width; ++c)
        for (const auto& [unknown, value] : columns[c]) {
            int s = factorization_->supernode_of(factorization_->position()[unknown]);
            for (; s >= 0 && !is_on_path_[s]; s = factorization_->parent(s)) {
                is_on_path_[s] = 1;
                path.push_back(s);
            }
        }
    for (const int s : path) is_on_path_[s] = 0;
    std::sort(path.begin(), path.end());
    return path;
}

void ForwardColumns::append_panel(const SparseVector* columns, int width)
{
    Panel panel = {size_, width, path_of(columns, width), {}, {}};
    for (int c = 0; c < width; ++c)
        for (const auto& [unknown, value] : columns[c])
            rows_[static_cast<std::size_t>(factorization_->position()[unknown]) * width + c] += value;
    solve(panel);
    panels_.push_back(std::move(panel));
    extend_gram(panels_.back());
    size_ += width;
}

/// Row-major rows are column-major transposed: X^T (width x columns) L11^T = B^T, then B2^T -= X^T L21^T.
void ForwardColumns::solve(Panel& panel)
{
    const int width = panel.width;
    for (const int s : panel.path) {
        const Supernode block = factorization_->supernode(s);
        double* x = rows_.data() + static_cast<std::size_t>(block.first) * width;
        cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, width, block.columns,
                    1.0, block.values, block.row_count, x, width);
        const std::size_t entries = static_cast<std::size_t>(block.columns) * width;
        panel.offset.push_back(panel.values.size());
        panel.values.insert(panel.values.end(), x, x + entries);

        const int below = block.row_count - block.columns;
        flops_ += static_cast<double>(width) * block.columns * (block.columns + 2.0 * below);
        if (below > 0) {
            update_.resize(std::max(update_.size(), static_cast<std::size_t>(below) * width));
            cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, width, below, block.columns, 1.0, x, width,
                        block.values + block.columns, block.row_count, 0.0, update_.data(), width);
            for (int r = 0; r < below; ++r) {
                double* target =
                    rows_.data() + static_cast<std::size_t>(block.rows[block.columns + r]) * width;
                const double* update = update_.data() + static_cast<std::size_t>(r) * width;
                for (int c = 0; c < width; ++c) target[c] -= update[c];
            }
        }
        std::fill(x, x + entries, 0.0);
    }
}

/// Products of the new panel with every panel, on the blocks that both contain.
void ForwardColumns::extend_gram(const Panel& panel)
{
    for (const Panel& other : panels_) {
        Eigen::MatrixXd product = Eigen::MatrixXd::Zero(panel.width, other.width);
        for (std::size_t i = 0, j = 0; i < panel.path.size() && j < other.path.size();) {
            if (panel.path[i] < other.path[j]) {
                ++i;
            } else if (panel.path[i] > other.path[j]) {
                ++j;
            } else {
                const int columns = factorization_->supernode(panel.path[i]).columns;
                flops_ += 2.0 * panel.width * other.width * columns;
                cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, panel.width, other.width, columns, 1.0,
                            panel.values.data() + panel.offset[i++], panel.width,
                            other.values.data() + other.offset[j++], other.width, 1.0, product.data(),
                            panel.width);
            }
        }
        gram_.block(panel.first, other.first, panel.width, other.width) = product;
        gram_.block(other.first, panel.first, other.width, panel.width) = product.transpose();
    }
}

Eigen::VectorXd ForwardColumns::dot(const Eigen::VectorXd& forward) const
{
    Eigen::VectorXd result = Eigen::VectorXd::Zero(size_);
    for (const Panel& panel : panels_)
        for (std::size_t k = 0; k < panel.path.size(); ++k) {
            const Supernode block = factorization_->supernode(panel.path[k]);
            cblas_dgemv(CblasColMajor, CblasNoTrans, panel.width, block.columns, 1.0,
                        panel.values.data() + panel.offset[k], panel.width, forward.data() + block.first, 1,
                        1.0, result.data() + panel.first, 1);
        }
    return result;
}

void ForwardColumns::accumulate(const Eigen::VectorXd& coefficients, Eigen::VectorXd& forward) const
{
    for (const Panel& panel : panels_)
        for (std::size_t k = 0; k < panel.path.size(); ++k) {
            const Supernode block = factorization_->supernode(panel.path[k]);
            cblas_dgemv(CblasColMajor, CblasTrans, panel.width, block.columns, 1.0,
                        panel.values.data() + panel.offset[k], panel.width, coefficients.data() + panel.first,
                        1, 1.0, forward.data() + block.first, 1);
        }
}

}  // namespace arris
