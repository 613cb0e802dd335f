// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <optional>
#include <vector>

#include "geometry/cloth/cloth_mesh.h"
#include "physics/system/block_ordering.h"
#include "physics/system/dense_system.h"
#include "physics/system/linear_system.h"

namespace arris {

/// An implicit Euler step from rest for the free vertices of a patch of cloth: (M + t^2 H) way = t^2 f.
class PatchEquations {
  public:
    /// `free`: the patch's free vertices, ascending. `places`: place of each vertex in `free`, or -1.
    /// `step_time`: t, s.
    PatchEquations(std::vector<int> places, std::vector<int> free, double step_time);

    /// Displacement, m, of each free vertex, three numbers each; nothing where the factorisation fails. Only
    /// the positions may differ from call to call. A free vertex with a normal in `normals` (one a vertex;
    /// zero without) keeps its height along that normal.
    std::optional<Eigen::VectorXd> find_way(const ClothMesh& patch, const ClothElements& elements,
                                            const Terms& terms, const std::vector<Vec3>& normals);

  private:
    template <typename System>
    void keep_heights(const std::vector<Vec3>& normals, System& system) const;
    std::optional<Eigen::VectorXd> solve_dense(const ClothElements& elements, const Terms& terms,
                                               const std::vector<Vec3>& normals);
    std::optional<Eigen::VectorXd> solve_sparse(const ClothMesh& patch, const ClothElements& elements,
                                                const Terms& terms, const std::vector<Vec3>& normals);

    std::vector<int> places_, free_;
    double step_time_;  ///< s
    Linearization at_;

    // One of two:
    std::optional<DenseSystem> dense_;  ///< for few free vertices
    Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> dense_factor_;
    std::optional<LinearSystem> sparse_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, BlockAmdOrdering> sparse_factor_;
};

}  // namespace arris
