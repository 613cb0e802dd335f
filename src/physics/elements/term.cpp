// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/elements/term.h"

#include <cassert>

namespace arris {

template <int N>
LocalSystem<N>::LocalSystem(const Linearization& at, const std::array<int, N>& vertices, int piece)
    : time_(at.time), gamma_(at.gamma), damping_(piece == kUndamped ? 0.0 : at.damping[piece])
{
    stiffness_weight_ = at.gamma * at.gamma + at.gamma * damping_;
    for (int i = 0; i < N; ++i) {
        const int v = vertices[i];
        const Vec3& drift = at.drift[v];
        v_last_[i] = at.v_last[v];
        mass_rhs_[i] = at.v_predicted[v] - drift;
        stiffness_rhs_[i] = gamma_ * gamma_ * (at.v_expansion[v] - drift) - gamma_ * damping_ * drift;
        viscosity_rhs_[i] = gamma_ * (at.v_last[v] - drift);
        rhs_[i].setZero();
    }
    for (Mat3& block : matrix_) block.setZero();
}

template <int N>
LocalSystem<N>::LocalSystem(const Linearization& at, const std::array<int, N>& vertices,
                            const std::array<int, N>& points, int piece,
                            const std::array<Mat32, N>& deformation)
    : LocalSystem(at, vertices, piece)
{
    is_eulerian_ = true;
    deformation_ = deformation;
    const MaterialFlow& flow = *at.flow;
    for (int i = 0; i < N; ++i) {
        const int p = points[i];
        const Mat32& F = deformation[i];
        v_last_[i] -= F * flow.v_last[p];
        mass_rhs_[i] -= F * flow.v_predicted[p];
        stiffness_rhs_[i] -= gamma_ * gamma_ * (F * flow.v_expansion[p]);
        viscosity_rhs_[i] -= gamma_ * (F * flow.v_last[p]);
        material_rhs_[i].setZero();
    }
}

template <int N>
void LocalSystem<N>::add_force(int i, const Vec3& force)
{
    rhs_[i] += gamma_ * force;
}

template <int N>
void LocalSystem<N>::add_elastic_force(int i, const Vec3& force)
{
    add_force(i, force);
    // G^T f + E^T F^T f = B^T f: at fixed X no material moves.
    if (is_eulerian_) material_rhs_[i] += gamma_ * (deformation_[i].transpose() * force);
}

template <int N>
void LocalSystem<N>::add_material_force(int i, const Vec2& force)
{
    assert(is_eulerian_ && "only where material flows has it a force of its own");
    material_rhs_[i] += gamma_ * force;
}

template <int N>
void LocalSystem<N>::add_mass(int i, int j, double mass)
{
    matrix_[i * (i + 1) / 2 + j].diagonal().array() += mass;
    rhs_[i] += mass * mass_rhs_[j];
    if (i != j) rhs_[j] += mass * mass_rhs_[i];
}

template <int N>
void LocalSystem<N>::add_block(int i, int j, double weight, const Mat3& block,
                               const std::array<Vec3, N>& times)
{
    matrix_[i * (i + 1) / 2 + j] += weight * block;
    rhs_[i] += block * times[j];
    if (i != j) rhs_[j] += block.transpose() * times[i];
}

template <int N>
void LocalSystem<N>::add_stiffness(int i, int j, const Mat3& minus_df_dx)
{
    add_block(i, j, stiffness_weight_, minus_df_dx, stiffness_rhs_);
}

template <int N>
void LocalSystem<N>::add_viscosity(int i, int j, const Mat3& minus_df_dv)
{
    add_block(i, j, gamma_, minus_df_dv, viscosity_rhs_);
}

template <int N>
void LocalSystem<N>::reduce(const std::array<const Mat3*, N>& corner_matrices)
{
    for (int i = 0; i < N; ++i) {
        const Mat3 G_i_transposed = corner_matrices[i]->transpose();
        rhs_[i] = (G_i_transposed * rhs_[i]).eval();
        for (int j = 0; j <= i; ++j) {
            Mat3& block = matrix_[i * (i + 1) / 2 + j];
            block = (G_i_transposed * block * *corner_matrices[j]).eval();
        }
    }
}

template <int N>
void LocalSystem<N>::reduce_eulerian(const std::array<const Mat3*, N>& bases,
                                     const std::array<const Mat23*, N>& material_bases)
{
    assert(is_eulerian_);
    std::array<Mat3, N> G;
    std::array<const Mat3*, N> corner_matrices;
    for (int i = 0; i < N; ++i) {
        G[i] = corner_matrix(deformation_[i], *bases[i], *material_bases[i]);
        corner_matrices[i] = &G[i];
    }
    reduce(corner_matrices);
    for (int i = 0; i < N; ++i) rhs_[i] += material_bases[i]->transpose() * material_rhs_[i];
}

template class LocalSystem<2>;
template class LocalSystem<3>;
template class LocalSystem<4>;

FaceState::FaceState(const FaceElement& face, const std::vector<Vec3>& position) : element(face)
{
    F.setZero();
    for (int i = 0; i < 3; ++i) {
        x[i] = position[face.vertices[i]];
        // F from edges, not from positions: no cancellation far from the origin.
        if (i > 0) F += (x[i] - x[0]) * face.gradients[i].transpose();
    }
}

HingeState::HingeState(const HingeElement& hinge, const std::vector<Vec3>& position,
                       const HingeMoment* moment_of_hinge)
    : element(hinge), moment(moment_of_hinge)
{
    for (int i = 0; i < 4; ++i) x[i] = position[hinge.vertices[i]];
}

const HingeTerm* Terms::coupled_hinges() const
{
    for (const auto& term : hinges)
        if (term->is_coupled()) return term.get();
    return nullptr;
}

HingeStates::HingeStates(const ClothElements& elements, const Terms& terms, const std::vector<Vec3>& position)
    : elements_(elements), position_(position)
{
    if (const HingeTerm* coupled = terms.coupled_hinges())
        moments_ = coupled->find_moments(elements, position, nullptr);
}

HingeStates::HingeStates(const ClothElements& elements, const Terms& terms, const Linearization& at)
    : elements_(elements), position_(at.position)
{
    if (const HingeTerm* coupled = terms.coupled_hinges())
        moments_ = coupled->find_moments(elements, at.position, &at);
}

}  // namespace arris
