// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "physics/elements/cloth_elements.h"
#include "physics/elements/linearization.h"
#include "physics/elements/term.h"

namespace arris {

/// A u = b for a few vertices of a cloth whose other vertices are held and do not move. No material flows,
/// and no vertex has a basis of its own. Same numbers as LinearSystem, without the cost of a sparse pattern.
class DenseSystem {
  public:
    /// `places` maps each vertex of the cloth to its index among the system's `count` vertices, or -1.
    DenseSystem(std::vector<int> places, int count);

    /// Sums all terms but loads at `at`.
    void assemble(const ClothElements& elements, const Terms& terms, const Linearization& at);

    const Eigen::MatrixXd& matrix() const { return matrix_; }  ///< lower triangle
    const Eigen::VectorXd& rhs() const { return rhs_; }

    /// Adds to the diagonal block of vertex `place` of the system.
    void add_to_vertex(int place, const Mat3& block) { matrix_.block<3, 3>(3 * place, 3 * place) += block; }

  private:
    template <int N>
    void scatter(const std::array<int, N>& vertices, const LocalSystem<N>& local);

    std::vector<int> places_;
    Eigen::MatrixXd matrix_;
    Eigen::VectorXd rhs_;
};

}  // namespace arris
