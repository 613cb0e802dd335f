// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/factorization.h"

#include <cholmod.h>
#include <omp.h>
#include <openblas_config.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <new>
#include <stdexcept>

extern "C" void openblas_set_num_threads(int);

namespace arris {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

/// A's lower triangle in elimination order, with the destination of each entry of A.
struct PermutedMatrix {
    std::vector<int> start, row;
    std::vector<double> value;
    std::vector<int> destination;  ///< one per entry of A; -1 above the diagonal
};

/// Columns are not sorted: the supernodal factorisation scatters them.
PermutedMatrix permute_pattern(const Matrix& matrix, const std::vector<int>& position)
{
    const int size = static_cast<int>(matrix.cols());
    PermutedMatrix permuted;
    permuted.start.assign(static_cast<std::size_t>(size) + 1, 0);
    permuted.destination.assign(static_cast<std::size_t>(matrix.nonZeros()), -1);
    const int *outer = matrix.outerIndexPtr(), *inner = matrix.innerIndexPtr();
    for (int column = 0; column < size; ++column)
        for (int k = outer[column]; k < outer[column + 1]; ++k)
            if (inner[k] >= column) ++permuted.start[std::min(position[inner[k]], position[column]) + 1];
    for (int column = 0; column < size; ++column) permuted.start[column + 1] += permuted.start[column];

    std::vector<int> next(permuted.start.begin(), permuted.start.end() - 1);
    permuted.row.resize(static_cast<std::size_t>(permuted.start.back()));
    permuted.value.resize(permuted.row.size());
    for (int column = 0; column < size; ++column)
        for (int k = outer[column]; k < outer[column + 1]; ++k) {
            if (inner[k] < column) continue;
            const auto [low, high] = std::minmax(position[inner[k]], position[column]);
            permuted.destination[k] = next[low]++;
            permuted.row[permuted.destination[k]] = high;
        }
    return permuted;
}

cholmod_sparse lower_triangle(int size, const int* start, const int* row, double* value)
{
    cholmod_sparse sparse = {};
    sparse.nrow = sparse.ncol = static_cast<std::size_t>(size);
    sparse.nzmax = static_cast<std::size_t>(start[size]);
    sparse.p = const_cast<int*>(start);
    sparse.i = const_cast<int*>(row);
    sparse.x = value;
    sparse.stype = -1;
    sparse.itype = CHOLMOD_INT;
    sparse.xtype = value ? CHOLMOD_REAL : CHOLMOD_PATTERN;
    sparse.dtype = CHOLMOD_DOUBLE;
    sparse.packed = 1;
    return sparse;
}

cholmod_dense column_vector(std::size_t rows, double* values)
{
    cholmod_dense dense = {};
    dense.nrow = dense.d = dense.nzmax = rows;
    dense.ncol = 1;
    dense.x = values;
    dense.xtype = CHOLMOD_REAL;
    dense.dtype = CHOLMOD_DOUBLE;
    return dense;
}

void throw_if_it_does_not_fit(const cholmod_common& common)
{
    if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    if (common.status < 0) throw std::length_error("the factor is too large");
}

}  // namespace

struct Factorization::Impl {
    VertexOrdering ordering;
    cholmod_common common = {};
    cholmod_factor* factor = nullptr;
    std::vector<int> outer, inner;  ///< pattern that was analysed last
    std::vector<int> position, supernode_of;
    PermutedMatrix permuted;
    Eigen::VectorXd extra;  ///< CHOLMOD's workspace for the rows below a supernode

    explicit Impl(VertexOrdering chosen) : ordering(chosen)
    {
        openblas_set_num_threads(1);
        cholmod_start(&common);
        common.print = 0;
        common.supernodal = CHOLMOD_SUPERNODAL;
        common.nmethods = 1;
        common.method[0].ordering = CHOLMOD_GIVEN;
        common.quick_return_if_not_posdef = 1;
    }
    ~Impl()
    {
        cholmod_free_factor(&factor, &common);
        cholmod_finish(&common);
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    const int* array(void* from) const { return static_cast<const int*>(from); }
    bool has_pattern(const Matrix& matrix) const;
    void analyse(const Matrix& matrix);
    void scatter(const Matrix& matrix, const std::vector<char>& is_pinned);
};

bool Factorization::Impl::has_pattern(const Matrix& matrix) const
{
    return factor != nullptr &&
           std::equal(outer.begin(), outer.end(), matrix.outerIndexPtr(),
                      matrix.outerIndexPtr() + matrix.cols() + 1) &&
           std::equal(inner.begin(), inner.end(), matrix.innerIndexPtr(),
                      matrix.innerIndexPtr() + matrix.nonZeros());
}

void Factorization::Impl::analyse(const Matrix& matrix)
{
    cholmod_free_factor(&factor, &common);
    const int size = static_cast<int>(matrix.cols());
    std::vector<int> order = order_unknowns(matrix, ordering, common);
    cholmod_sparse pattern = lower_triangle(size, matrix.outerIndexPtr(), matrix.innerIndexPtr(), nullptr);
    factor = cholmod_analyze_p(&pattern, order.data(), nullptr, 0, &common);
    throw_if_it_does_not_fit(common);

    // CHOLMOD applies a postorder of the elimination tree to the given order: the order of the factor counts.
    const int* final_order = array(factor->Perm);
    position.resize(static_cast<std::size_t>(size));
    for (int k = 0; k < size; ++k) position[final_order[k]] = k;
    supernode_of.resize(static_cast<std::size_t>(size));
    for (int s = 0; s < static_cast<int>(factor->nsuper); ++s)
        for (int k = array(factor->super)[s]; k < array(factor->super)[s + 1]; ++k) supernode_of[k] = s;
    permuted = permute_pattern(matrix, position);
    extra.resize(static_cast<Eigen::Index>(std::max<std::size_t>(factor->maxesize, 1)));
    outer.assign(matrix.outerIndexPtr(), matrix.outerIndexPtr() + size + 1);
    inner.assign(matrix.innerIndexPtr(), matrix.innerIndexPtr() + matrix.nonZeros());
}

void Factorization::Impl::scatter(const Matrix& matrix, const std::vector<char>& is_pinned)
{
    const double* value = matrix.valuePtr();
    for (int column = 0; column < static_cast<int>(matrix.cols()); ++column)
        for (int k = outer[column]; k < outer[column + 1]; ++k) {
            const int row = inner[k], destination = permuted.destination[k];
            if (destination < 0) continue;
            const bool is_pin = is_pinned[row] || is_pinned[column];
            if (row == column)  // any positive diagonal of a pinned coordinate will do
                permuted.value[destination] = is_pin && !(value[k] > 0.0) ? 1.0 : value[k];
            else
                permuted.value[destination] = is_pin ? 0.0 : value[k];
        }
}

Factorization::Factorization(VertexOrdering ordering) : impl_(std::make_unique<Impl>(ordering)) {}
Factorization::~Factorization() = default;
Factorization::Factorization(Factorization&&) noexcept = default;
Factorization& Factorization::operator=(Factorization&&) noexcept = default;

void Factorization::analyse(const Matrix& matrix)
{
    assert(matrix.isCompressed() && "the pattern is read from the compressed arrays");
    if (!impl_->has_pattern(matrix)) impl_->analyse(matrix);
}

bool Factorization::factorise(const Matrix& matrix, const std::vector<char>& is_pinned)
{
    assert(impl_->has_pattern(matrix) && "analyse comes first");
    impl_->scatter(matrix, is_pinned);
    PermutedMatrix& permuted = impl_->permuted;
    cholmod_sparse lower = lower_triangle(static_cast<int>(matrix.cols()), permuted.start.data(),
                                          permuted.row.data(), permuted.value.data());
    double shift[2] = {0.0, 0.0};
    // CHOLMOD starts four OpenMP threads in loops too short for them; waking the threads took half of the
    // time.
    omp_set_max_active_levels(0);
    cholmod_super_numeric(&lower, nullptr, shift, impl_->factor, &impl_->common);
    throw_if_it_does_not_fit(impl_->common);
    return impl_->common.status == CHOLMOD_OK && impl_->factor->minor == impl_->factor->n;
}

Eigen::VectorXd Factorization::solve_forward(const Eigen::VectorXd& rhs) const
{
    Eigen::VectorXd forward(rhs.size());
    for (int i = 0; i < rhs.size(); ++i) forward[impl_->position[i]] = rhs[i];
    cholmod_dense x = column_vector(impl_->factor->n, forward.data());
    cholmod_dense extra = column_vector(static_cast<std::size_t>(impl_->extra.size()), impl_->extra.data());
    cholmod_super_lsolve(impl_->factor, &x, &extra, &impl_->common);
    return forward;
}

Eigen::VectorXd Factorization::solve_backward(const Eigen::VectorXd& forward) const
{
    Eigen::VectorXd permuted = forward, solution(forward.size());
    cholmod_dense x = column_vector(impl_->factor->n, permuted.data());
    cholmod_dense extra = column_vector(static_cast<std::size_t>(impl_->extra.size()), impl_->extra.data());
    cholmod_super_ltsolve(impl_->factor, &x, &extra, &impl_->common);
    for (int i = 0; i < forward.size(); ++i) solution[i] = permuted[impl_->position[i]];
    return solution;
}

const std::vector<int>& Factorization::position() const
{
    return impl_->position;
}
int Factorization::supernode_count() const
{
    return static_cast<int>(impl_->factor->nsuper);
}
int Factorization::supernode_of(int position) const
{
    return impl_->supernode_of[position];
}
double Factorization::nonzeros() const
{
    return static_cast<double>(impl_->factor->xsize);
}

double Factorization::flops() const
{
    return impl_->common.fl;
}

Supernode Factorization::supernode(int index) const
{
    const cholmod_factor& factor = *impl_->factor;
    const int* first = impl_->array(factor.super) + index;
    const int* rows = impl_->array(factor.pi) + index;
    return {first[0], first[1] - first[0], impl_->array(factor.s) + rows[0], rows[1] - rows[0],
            static_cast<const double*>(factor.x) + impl_->array(factor.px)[index]};
}

int Factorization::parent(int index) const
{
    const Supernode block = supernode(index);
    return block.row_count > block.columns ? impl_->supernode_of[block.rows[block.columns]] : -1;
}

}  // namespace arris
