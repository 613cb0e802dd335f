// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "physics/cloth_elements.h"
#include "physics/linearization.h"
#include "physics/term.h"

namespace arris {

/// A u = b of a few vertices of a cloth the rest of which is held and does not move; nothing flows, and no
/// vertex has a basis of its own. The same numbers as LinearSystem's, without what a sparse pattern costs.
class DenseSystem {
  public:
    /// `places` tells of each vertex of the cloth which of the system's `count` it is, or -1.
    DenseSystem(std::vector<int> places, int count);

    /// Sums all terms but loads at `at`.
    void assemble(const ClothElements& elements, const Terms& terms, const Linearization& at);

    const Eigen::MatrixXd& matrix() const { return matrix_; }  ///< its lower triangle
    const Eigen::VectorXd& rhs() const { return rhs_; }

    /// Adds to the diagonal block of one of the system's vertices.
    void add_to_vertex(int place, const Mat3& block) { matrix_.block<3, 3>(3 * place, 3 * place) += block; }

  private:
    template <int N>
    void scatter(const std::array<int, N>& vertices, const LocalSystem<N>& local);

    std::vector<int> places_;
    Eigen::MatrixXd matrix_;
    Eigen::VectorXd rhs_;
};

}  // namespace arris
