// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <optional>
#include <vector>

#include "geometry/cloth/cloth_mesh.h"
#include "physics/block_ordering.h"
#include "physics/dense_system.h"
#include "physics/linear_system.h"

namespace arris {

/// A step of implicit Euler from rest, of what is free in a patch of cloth: (M + t^2 H) way = t^2 f.
class PatchEquations {
  public:
    /// `free` are the patch's free vertices, ascending; `places` of each vertex its place in them, or -1.
    /// `step_time` is t, s.
    PatchEquations(std::vector<int> places, std::vector<int> free, double step_time);

    /// The way, m, of each free vertex, three numbers each; nothing where the equations have no factors. Only
    /// where the patch is differs from call to call. Free vertices with one of `normals` (of each vertex;
    /// zero where there is none) keep their height along it.
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

    // One of the two:
    std::optional<DenseSystem> dense_;  ///< of few
    Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> dense_factor_;
    std::optional<LinearSystem> sparse_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, BlockAmdOrdering> sparse_factor_;
};

}  // namespace arris
