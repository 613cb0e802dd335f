// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace arris {

/// The dense problem of one supernode in a multifrontal factorisation: the lower triangle of
///     | F11     |
///     | F21  F22 |
/// F11 and F21 are columns of the factor, F22 is what its elimination adds to the parent's front.
/// Column-major.
struct Front {
    int columns, row_count;
    double* factor;  ///< F11 over F21: row_count x columns
    double* update;  ///< F22: (row_count - columns) squared

    int below() const { return row_count - columns; }
    /// Leading entry of column `column` of the front, less `column` rows: entry [row] is that of the front's
    /// row.
    double* column(int column) const;
};

/// Replaces F11 by its Cholesky factor L11, F21 by L21 = F21 L11^-T, and F22 by F22 - L21 L21^T. Large fronts
/// are worked on in tiles, by several threads. The result depends on the front alone. False where F11 is not
/// positive definite.
bool eliminate(const Front& front);

/// Flops of the longest chain of tiles in `eliminate`, where each step has as many threads as it has tiles.
double critical_flops_of(int columns, int row_count);

}  // namespace arris
