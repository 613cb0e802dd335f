// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "geometry/vectors.h"
#include "physics/elements/cloth_elements.h"
#include "physics/elements/effects.h"
#include "physics/elements/linearization.h"
#include "physics/elements/material.h"

namespace arris {

/// Stands for the piece of an element without stiffness-proportional damping.
inline constexpr int kUndamped = -1;

/// One element's part of the linear system, in the corner velocities of its N corners (see linearization.h).
/// A term adds its force, mass, stiffness and viscosity. This class adds the matching right-hand sides, once
/// for all terms.
template <int N>
class LocalSystem {
  public:
    /// For an element of a piece, without flow of material: corner velocities are those of the vertices. The
    /// piece kUndamped has no stiffness-proportional damping.
    LocalSystem(const Linearization& at, const std::array<int, N>& vertices, int piece = 0);

    /// For an element with an EOL vertex; `at.flow` must be present. `points`: of the material at its
    /// corners; `deformation` is F at each.
    LocalSystem(const Linearization& at, const std::array<int, N>& vertices, const std::array<int, N>& points,
                int piece, const std::array<Mat32, N>& deformation);

    double time() const { return time_; }
    double damping() const { return damping_; }  ///< s, stiffness-proportional
    bool is_eulerian() const { return is_eulerian_; }
    const Vec3& v_last(int i) const { return v_last_[i]; }  ///< m/s, velocity of the material at corner i

    /// Adds the convective acceleration 2 Fdot V, m/s^2, at corner i; call before adding any mass.
    void add_convection(int i, const Vec3& acceleration) { mass_rhs_[i] += gamma_ * acceleration; }

    void add_force(int i, const Vec3& force);                   ///< N, load on the material
    void add_elastic_force(int i, const Vec3& force);           ///< N, -dV/dx_i at fixed X
    void add_material_force(int i, const Vec2& force);          ///< N, -dV/dX_i at fixed x; only if
                                                                ///< is_eulerian()
    void add_mass(int i, int j, double mass);                   ///< kg; i >= j, symmetric
    void add_stiffness(int i, int j, const Mat3& minus_df_dx);  ///< N/m; i >= j
    void add_viscosity(int i, int j, const Mat3& minus_df_dv);  ///< N s/m; i >= j

    const Mat3& matrix(int i, int j) const { return matrix_[i * (i + 1) / 2 + j]; }  ///< i >= j
    const Vec3& rhs(int i) const { return rhs_[i]; }
    const Mat32& deformation(int i) const { return deformation_[i]; }  ///< F there; only if is_eulerian()

    /// Maps to the reduced coordinates: block -> G_i^T block G_j, rhs -> G_i^T rhs.
    void reduce(const std::array<const Mat3*, N>& corner_matrices);

    /// As above for an element with an EOL vertex: G_i = basis_i - F_i material_basis_i.
    void reduce_eulerian(const std::array<const Mat3*, N>& bases,
                         const std::array<const Mat23*, N>& material_bases);

  private:
    void add_block(int i, int j, double weight, const Mat3& block, const std::array<Vec3, N>& times);

    double time_, gamma_, damping_, stiffness_weight_;
    std::array<Vec3, N> v_last_, mass_rhs_, stiffness_rhs_, viscosity_rhs_;
    std::array<Mat3, N*(N + 1) / 2> matrix_;
    std::array<Vec3, N> rhs_;

    // Only if is_eulerian_. `material_rhs_` is the part of the right-hand side for E that is not in G^T rhs_.
    bool is_eulerian_ = false;
    std::array<Mat32, N> deformation_;
    std::array<Vec2, N> material_rhs_;
};

using SpringSystem = LocalSystem<2>;
using FaceSystem = LocalSystem<3>;
using HingeSystem = LocalSystem<4>;

/// A face at its present positions.
struct FaceState {
    const FaceElement& element;
    std::array<Vec3, 3> x;  ///< m
    Mat32 F;                ///< deformation gradient

    FaceState(const FaceElement& face, const std::vector<Vec3>& position);
};

/// What a hinge exerts where all hinges depend on each other (hinge_moments.h).
struct HingeMoment {
    double energy = 0.0;     ///< J, the hinge's share of the whole
    double moment = 0.0;     ///< N m, along the whole edge
    double stiffness = 0.0;  ///< J, upper bound of the moment's derivative by s = 2 sin(theta/2)
    /// N m/s, by which that bound exceeds the rate of the moment at v_k; zero without damping.
    double excess_rate = 0.0;
    /// N, -dV/dX at fixed positions; zero unless the hinge has an EOL vertex.
    std::array<Vec2, 4> material_force = {Vec2::Zero(), Vec2::Zero(), Vec2::Zero(), Vec2::Zero()};
};

/// A hinge at its present positions.
struct HingeState {
    const HingeElement& element;
    const HingeMoment* moment;                             ///< null unless a term is coupled
    std::array<Vec3, 4> x;                                 ///< m
    std::optional<HingeWeightGradients> weight_gradients;  ///< if the hinge has an EOL vertex

    HingeState(const HingeElement& hinge, const std::vector<Vec3>& position,
               const HingeMoment* moment = nullptr);
};

/// Kind of a term's energy: the columns of steps.csv.
enum class EnergyKind { None, Gravity, Stretch, Bending, Seam };

/// A spring at its present positions.
struct SpringState {
    const SpringElement& element;
    std::array<Vec3, 2> x;  ///< m

    SpringState(const SpringElement& spring, const std::vector<Vec3>& position)
        : element(spring), x{position[spring.vertices[0]], position[spring.vertices[1]]}
    {
    }
};

/// An effect with a contribution from each face. Stiffness and viscosity must be positive semi-definite.
class FaceTerm {
  public:
    virtual ~FaceTerm() = default;
    /// Whether the force is -dV of an energy of the face's shape (add_elastic_force, add_material_force).
    /// Elastic terms of a face with an EOL corner are evaluated at q^, inertia and loads at the extrapolated
    /// state.
    virtual bool is_elastic() const { return false; }
    virtual EnergyKind energy_kind() const { return EnergyKind::None; }
    virtual double energy(const FaceState&) const { return 0.0; }  ///< J
    virtual bool is_drive() const { return false; }  ///< has no energy, but may do work on the cloth
    virtual void add(const FaceState& face, FaceSystem& system) const = 0;
};

/// An elastic effect with a contribution from each hinge: add_elastic_force, add_material_force.
class HingeTerm {
  public:
    virtual ~HingeTerm() = default;
    virtual EnergyKind energy_kind() const { return EnergyKind::None; }
    /// Whether a hinge depends on the others, by way of `moment` in its state. At most one term of a scene
    /// may.
    virtual bool is_coupled() const { return false; }
    /// `moment` of each hinge, for a coupled term. `at` is null where only energies are asked for.
    virtual std::vector<HingeMoment> find_moments(const ClothElements&, const std::vector<Vec3>& /*position*/,
                                                  const Linearization* /*at*/) const
    {
        return {};
    }
    virtual double energy(const HingeState&) const { return 0.0; }  ///< J
    virtual void add(const HingeState& hinge, HingeSystem& system) const = 0;
};

/// An elastic effect with a contribution from each spring.
class SpringTerm {
  public:
    virtual ~SpringTerm() = default;
    virtual EnergyKind energy_kind() const = 0;
    virtual double energy(const SpringState&) const = 0;  ///< J
    virtual void add(const SpringState& spring, SpringSystem& system) const = 0;
};

/// The piece whose damping an element has; on a seam that of its first side.
inline int piece_of(const FaceElement& face)
{
    return face.piece;
}
inline int piece_of(const HingeElement& hinge)
{
    return hinge.pieces[0];
}

inline int piece_of(const SpringElement&)
{
    return kUndamped;
}

/// Sums the terms of one element (FaceState, HingeState or SpringState) without flow of material.
template <int N, typename State, typename ElementTerms>
LocalSystem<N> sum_terms(const State& state, const ElementTerms& terms, const Linearization& at)
{
    LocalSystem<N> local(at, state.element.vertices, piece_of(state.element));
    for (const auto& term : terms) term->add(state, local);
    return local;
}

/// A load on one corner of a face, N.
struct CornerLoad {
    int face, corner;
    Vec3 force;
};

/// An effect that loads vertices.
class LoadTerm {
  public:
    virtual ~LoadTerm() = default;
    /// Adds to `force` (N, one entry per vertex) the load on `mesh` during the step at `at`.
    virtual void add(const ClothMesh& mesh, const Linearization& at, std::vector<Vec3>& force) const = 0;
    /// The load by faces. The faces on which a load at an EOL vertex acts decide how material flows.
    virtual std::vector<CornerLoad> corner_loads(const ClothMesh& mesh, const Linearization& at) const = 0;
};

/// The effects of a scene, made when the scene is loaded. Absent effects are in no list.
struct Terms {
    std::vector<std::unique_ptr<const FaceTerm>> faces;
    std::vector<std::unique_ptr<const HingeTerm>> hinges;
    std::vector<std::unique_ptr<const SpringTerm>> springs;
    std::vector<std::unique_ptr<const LoadTerm>> loads;
    Materials materials;  ///< as used by the inertia in `faces`

    /// The hinge term whose hinges depend on each other; null if there is none.
    const HingeTerm* coupled_hinges() const;
};

/// All hinges of `elements` at `position`, with their moments if a term is coupled.
class HingeStates {
  public:
    /// For energies.
    HingeStates(const ClothElements& elements, const Terms& terms, const std::vector<Vec3>& position);
    /// For forces at `at.position`, which must outlive this.
    HingeStates(const ClothElements& elements, const Terms& terms, const Linearization& at);

    const HingeMoment* moment(std::size_t h) const { return moments_.empty() ? nullptr : &moments_[h]; }
    HingeState operator[](std::size_t h) const { return {elements_.hinges[h], position_, moment(h)}; }

  private:
    const ClothElements& elements_;
    const std::vector<Vec3>& position_;
    std::vector<HingeMoment> moments_;
};

}  // namespace arris
