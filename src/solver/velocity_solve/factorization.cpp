// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/factorization.h"

#include <cblas.h>
#include <cholmod.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <new>
#include <optional>
#include <stdexcept>

#include "solver/velocity_solve/front.h"
#include "solver/velocity_solve/symbolic_factor.h"

extern "C" void openblas_set_num_threads(int);

namespace arris {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

void throw_if_it_does_not_fit(const cholmod_common& common)
{
    if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    if (common.status < 0) throw std::length_error("the factor is too large");
}

/// Entries are not kept. A mesh that changes needs a little more at one time and a little less at another.
void make_room(std::size_t size, std::vector<double>& buffer)
{
    if (buffer.size() >= size) return;
    std::vector<double>().swap(buffer);
    buffer.resize(size + size / 8);
}

}  // namespace

struct Factorization::Impl {
    cholmod_common common = {};
    VertexGraph graph;        ///< pattern that was analysed last
    std::vector<Vec2> place;  ///< with which it was analysed; empty where there were none
    std::optional<SymbolicFactor> symbolic;
    // At least as large as they need be: they grow only.
    std::vector<double> values;                  ///< L
    std::vector<double> updates;                 ///< update matrices of a factorisation
    mutable std::vector<double> update_vectors;  ///< as the tree's rows: updates of a forward solve

    Impl()
    {
        openblas_set_num_threads(1);
        cholmod_start(&common);
        common.print = 0;
        common.supernodal = CHOLMOD_SUPERNODAL;
        common.nmethods = 1;
        common.method[0].ordering = CHOLMOD_GIVEN;
        // CHOLMOD merges supernodes of up to so many columns, and a column of its graph is a vertex, three
        // here.
        for (std::size_t& columns : common.nrelax) columns = (columns + 2) / 3;
    }
    ~Impl() { cholmod_finish(&common); }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    void analyse(const Matrix& matrix);
    Front front(int supernode);
    void add_matrix(int supernode, const Matrix& matrix, const std::vector<char>& is_pinned);
    void add_children(int supernode);
    void solve_forward(int supernode, double* x) const;
    void solve_backward(int supernode, double* x) const;
    double solve_flops() const;
};

/// Where anything throws, nothing counts as analysed.
void Factorization::Impl::analyse(const Matrix& matrix)
{
    symbolic.reset();
    graph = VertexGraph(matrix);
    std::vector<int> order = place.empty() ? order_by_metis(graph, common) : dissect(graph, place);
    cholmod_sparse pattern = graph.pattern();
    const auto free_factor = [this](cholmod_factor* factor) { cholmod_free_factor(&factor, &common); };
    const std::unique_ptr<cholmod_factor, decltype(free_factor)> of_vertices(
        cholmod_analyze_p(&pattern, order.data(), nullptr, 0, &common), free_factor);
    throw_if_it_does_not_fit(common);
    symbolic.emplace(matrix, graph, *of_vertices);
    try {
        make_room(static_cast<std::size_t>(symbolic->tree.value_count()), values);
        make_room(symbolic->updates.size, updates);
        make_room(symbolic->tree.rows.size(), update_vectors);
    } catch (...) {
        symbolic.reset();
        throw;
    }
}

Front Factorization::Impl::front(int s)
{
    const EliminationTree& tree = symbolic->tree;
    return {tree.columns(s), tree.row_count(s), values.data() + tree.first_value[s],
            updates.data() + symbolic->updates.first[s]};
}

/// Sets the supernode's front to its blocks of A, with pins.
void Factorization::Impl::add_matrix(int s, const Matrix& matrix, const std::vector<char>& is_pinned)
{
    const Front own = front(s);
    std::fill_n(own.factor, static_cast<std::ptrdiff_t>(own.columns) * own.row_count, 0.0);
    for (int column = own.columns; column < own.row_count; ++column)
        std::fill(own.column(column) + column, own.column(column) + own.row_count, 0.0);
    for (int k = symbolic->first_block[s]; k < symbolic->first_block[s + 1]; ++k) {
        const MatrixBlock& block = symbolic->blocks[k];
        const char *row_pins = &is_pinned[3 * block.row], *column_pins = &is_pinned[3 * block.column];
        const double* from = matrix.valuePtr() + block.source;
        double* to = values.data() + block.target;
        const int down = block.is_turned ? own.row_count : 1, along = block.is_turned ? 1 : own.row_count;
        const bool is_diagonal = block.row == block.column;
        for (int c = 0; c < 3; ++c, from += block.stride)
            for (int r = is_diagonal ? c : 0; r < 3; ++r) {
                double value = from[r];
                if (row_pins[r] || column_pins[c])  // any positive diagonal of a pinned coordinate will do
                    value = !is_diagonal || r != c ? 0.0 : value > 0.0 ? value : 1.0;
                to[r * down + c * along] = value;
            }
    }
}

/// Adds the updates of the supernode's children, in the children's order whatever threads do.
void Factorization::Impl::add_children(int s)
{
    const EliminationTree& tree = symbolic->tree;
    const Front own = front(s);
    for (int k = tree.first_child[s]; k < tree.first_child[s + 1]; ++k) {
        const int child = tree.children[k], size = tree.below(child);
        const int* row_places = tree.place.data() + tree.first_row[child] + tree.columns(child);
        const double* update = updates.data() + symbolic->updates.first[child];
        for (int column = 0; column < size; ++column, update += size) {
            double* target = own.column(row_places[column]);
            for (int row = column; row < size; ++row) target[row_places[row]] += update[row];
        }
    }
}

/// The supernode's part of x = L^-1 x, and what it subtracts from the rows below.
void Factorization::Impl::solve_forward(int s, double* x) const
{
    const EliminationTree& tree = symbolic->tree;
    const int columns = tree.columns(s), count = tree.row_count(s);
    const double* block = values.data() + tree.first_value[s];
    double *own = x + tree.first_column[s], *below = update_vectors.data() + tree.first_row[s] + columns;
    std::fill_n(below, count - columns, 0.0);
    for (int k = tree.first_child[s]; k < tree.first_child[s + 1]; ++k) {
        const int child = tree.children[k];
        for (int r = tree.first_row[child] + tree.columns(child); r < tree.first_row[child + 1]; ++r) {
            const int at = tree.place[r];
            (at < columns ? own[at] : below[at - columns]) += update_vectors[r];
        }
    }
    cblas_dtrsv(CblasColMajor, CblasLower, CblasNoTrans, CblasNonUnit, columns, block, count, own, 1);
    if (count > columns)
        cblas_dgemv(CblasColMajor, CblasNoTrans, count - columns, columns, -1.0, block + columns, count, own,
                    1, 1.0, below, 1);
}

/// The supernode's part of x = L^-T x.
void Factorization::Impl::solve_backward(int s, double* x) const
{
    const EliminationTree& tree = symbolic->tree;
    const int columns = tree.columns(s), count = tree.row_count(s);
    const double* block = values.data() + tree.first_value[s];
    double *own = x + tree.first_column[s], *below = update_vectors.data() + tree.first_row[s] + columns;
    const int* rows = tree.rows.data() + tree.first_row[s] + columns;
    for (int r = 0; r < count - columns; ++r) below[r] = x[rows[r]];
    if (count > columns)
        cblas_dgemv(CblasColMajor, CblasTrans, count - columns, columns, -1.0, block + columns, count, below,
                    1, 1.0, own, 1);
    cblas_dtrsv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, columns, block, count, own, 1);
}

/// Flops that take as long as one triangular solve, which waits for memory.
double Factorization::Impl::solve_flops() const
{
    return 16.0 * static_cast<double>(symbolic->tree.value_count());
}

Factorization::Factorization() : impl_(std::make_unique<Impl>()) {}
Factorization::~Factorization() = default;
Factorization::Factorization(Factorization&&) noexcept = default;
Factorization& Factorization::operator=(Factorization&&) noexcept = default;

void Factorization::analyse(const Matrix& matrix, const std::vector<Vec2>* place)
{
    assert(matrix.isCompressed() && "the pattern is read from the compressed arrays");
    const bool is_same_place = place ? impl_->place == *place : impl_->place.empty();
    if (impl_->symbolic && is_same_place && impl_->graph.is_of(matrix)) return;
    impl_->place = place ? *place : std::vector<Vec2>();
    impl_->analyse(matrix);
}

bool Factorization::factorise(const Matrix& matrix, const std::vector<char>& is_pinned)
{
    assert(impl_->graph.is_of(matrix) && "analyse comes first");
    std::atomic<bool> is_definite = true;
    impl_->symbolic->walk.up(impl_->symbolic->flops, [&](int s) {
        if (!is_definite) return;
        impl_->add_matrix(s, matrix, is_pinned);
        impl_->add_children(s);
        if (!eliminate(impl_->front(s))) is_definite = false;
    });
    return is_definite;
}

Eigen::VectorXd Factorization::solve_forward(const Eigen::VectorXd& rhs) const
{
    const std::vector<int>& position = impl_->symbolic->position;
    Eigen::VectorXd forward(rhs.size());
    for (int i = 0; i < rhs.size(); ++i) forward[position[i]] = rhs[i];
    impl_->symbolic->walk.up(impl_->solve_flops(), [&](int s) { impl_->solve_forward(s, forward.data()); });
    return forward;
}

Eigen::VectorXd Factorization::solve_backward(const Eigen::VectorXd& forward) const
{
    const std::vector<int>& position = impl_->symbolic->position;
    Eigen::VectorXd permuted = forward, solution(forward.size());
    impl_->symbolic->walk.down(impl_->solve_flops(),
                               [&](int s) { impl_->solve_backward(s, permuted.data()); });
    for (int i = 0; i < forward.size(); ++i) solution[i] = permuted[position[i]];
    return solution;
}

const std::vector<int>& Factorization::position() const
{
    return impl_->symbolic->position;
}
const EliminationTree& Factorization::tree() const
{
    return impl_->symbolic->tree;
}
Supernode Factorization::supernode(int s) const
{
    const EliminationTree& tree = impl_->symbolic->tree;
    return {tree.first_column[s], tree.columns(s), tree.rows.data() + tree.first_row[s], tree.row_count(s),
            impl_->values.data() + tree.first_value[s]};
}

double Factorization::nonzeros() const
{
    return static_cast<double>(impl_->symbolic->tree.value_count());
}

double Factorization::flops() const
{
    return impl_->symbolic->flops;
}

double Factorization::critical_flops() const
{
    return impl_->symbolic->walk.critical_flops();
}

}  // namespace arris
