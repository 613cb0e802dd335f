// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/mesh_change/patch_equations.h"

#include <utility>

namespace arris {

namespace {

/// A linearization of `count` vertices at rest, in world coordinates; positions are set later.
Linearization at_rest(std::size_t count, double step_time)
{
    Linearization at;
    at.gamma = step_time;
    at.v_predicted = at.v_expansion = at.v_last = at.drift = std::vector<Vec3>(count, Vec3::Zero());
    at.basis.assign(count, Mat3::Identity());
    at.has_basis.assign(count, 0);
    return at;
}

}  // namespace

PatchEquations::PatchEquations(std::vector<int> places, std::vector<int> free, double step_time)
    : places_(std::move(places)),
      free_(std::move(free)),
      step_time_(step_time),
      at_(at_rest(places_.size(), step_time))
{
}

std::optional<Eigen::VectorXd> PatchEquations::find_way(const ClothMesh& patch, const ClothElements& elements,
                                                        const Terms& terms, const std::vector<Vec3>& normals)
{
    constexpr std::size_t kFew = 25;  // free vertices, up to which dense equations are faster
    at_.position = patch.world;
    at_.damping.assign(static_cast<std::size_t>(terms.materials.count()), 0.0);
    std::optional<Eigen::VectorXd> velocity = free_.size() <= kFew
                                                  ? solve_dense(elements, terms, normals)
                                                  : solve_sparse(patch, elements, terms, normals);
    if (!velocity || !velocity->allFinite()) return std::nullopt;
    *velocity *= step_time_;
    return velocity;
}

std::optional<Eigen::VectorXd> PatchEquations::solve_dense(const ClothElements& elements, const Terms& terms,
                                                           const std::vector<Vec3>& normals)
{
    if (!dense_) dense_.emplace(places_, static_cast<int>(free_.size()));
    dense_->assemble(elements, terms, at_);
    keep_heights(normals, *dense_);
    dense_factor_.compute(dense_->matrix());
    if (dense_factor_.info() != Eigen::Success) return std::nullopt;
    return dense_factor_.solve(dense_->rhs());
}

std::optional<Eigen::VectorXd> PatchEquations::solve_sparse(const ClothMesh& patch,
                                                            const ClothElements& elements, const Terms& terms,
                                                            const std::vector<Vec3>& normals)
{
    const bool is_first = !sparse_;
    if (is_first) sparse_.emplace().make_pattern(elements, places_);
    sparse_->assemble(patch, elements, terms, at_);
    keep_heights(normals, *sparse_);
    if (is_first) sparse_factor_.analyzePattern(sparse_->matrix());
    sparse_factor_.factorize(sparse_->matrix());
    if (sparse_factor_.info() != Eigen::Success) return std::nullopt;
    return sparse_factor_.solve(sparse_->rhs());
}

template <typename System>
void PatchEquations::keep_heights(const std::vector<Vec3>& normals, System& system) const
{
    constexpr double kStiff = 1e6;  // times the greatest stiffness: holds the height
    const double stiff = kStiff * system.matrix().diagonal().maxCoeff();
    for (std::size_t k = 0; k < free_.size(); ++k)
        if (const Vec3& normal = normals[free_[k]]; !normal.isZero(0.0))
            system.add_to_vertex(static_cast<int>(k), stiff * normal * normal.transpose());
}

}  // namespace arris
