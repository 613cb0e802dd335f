// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "geometry/vectors.h"
#include "physics/cloth_elements.h"
#include "physics/effects.h"
#include "physics/linearization.h"
#include "physics/material.h"

namespace arris {

/// One element's part of the linear system, in the velocities of its N corners (see linearization.h). A term
/// adds its force, mass, stiffness and viscosity; the right-hand side that goes with each is kept up here,
/// once for all.
template <int N>
class LocalSystem {
  public:
    LocalSystem(const Linearization& at, const std::array<int, N>& vertices);

    double time() const { return time_; }
    const Vec3& v_last(int i) const { return v_last_[i]; }  ///< m/s, of corner i

    void add_force(int i, const Vec3& force);                   ///< N
    void add_mass(int i, int j, double mass);                   ///< kg; i >= j, the other half is implied
    void add_stiffness(int i, int j, const Mat3& minus_df_dx);  ///< N/m; i >= j
    void add_viscosity(int i, int j, const Mat3& minus_df_dv);  ///< N s/m; i >= j

    const Mat3& matrix(int i, int j) const { return matrix_[i * (i + 1) / 2 + j]; }  ///< i >= j
    const Vec3& rhs(int i) const { return rhs_[i]; }

    /// Maps to the reduced coordinates: block -> G_i^T block G_j, rhs -> G_i^T rhs.
    void reduce(const std::array<const Mat3*, N>& corner_matrices);

  private:
    void add_block(int i, int j, double weight, const Mat3& block, const std::array<Vec3, N>& times);

    double time_, gamma_, stiffness_weight_;
    std::array<Vec3, N> v_last_, mass_rhs_, stiffness_rhs_, viscosity_rhs_;
    std::array<Mat3, N*(N + 1) / 2> matrix_;
    std::array<Vec3, N> rhs_;
};

using FaceSystem = LocalSystem<3>;
using HingeSystem = LocalSystem<4>;

/// A face where it is now.
struct FaceState {
    const FaceElement& element;
    std::array<Vec3, 3> x;  ///< m
    Mat32 F;                ///< deformation gradient

    FaceState(const FaceElement& face, const std::vector<Vec3>& position);
};

/// A hinge where it is now.
struct HingeState {
    const HingeElement& element;
    std::array<Vec3, 4> x;  ///< m

    HingeState(const HingeElement& hinge, const std::vector<Vec3>& position);
};

/// What kind of energy a term's is: the columns of steps.csv.
enum class EnergyKind { None, Gravity, Stretch, Bending };

/// An effect with a contribution from each face. Stiffness and viscosity must be positive semi-definite.
class FaceTerm {
  public:
    virtual ~FaceTerm() = default;
    virtual EnergyKind energy_kind() const { return EnergyKind::None; }
    virtual double energy(const FaceState&) const { return 0.0; }  ///< J
    virtual bool is_drive() const { return false; }  ///< without an energy, but may do work on the cloth
    virtual void add(const FaceState& face, FaceSystem& system) const = 0;
};

/// An effect with a contribution from each hinge.
class HingeTerm {
  public:
    virtual ~HingeTerm() = default;
    virtual EnergyKind energy_kind() const { return EnergyKind::None; }
    virtual double energy(const HingeState&) const { return 0.0; }  ///< J
    virtual void add(const HingeState& hinge, HingeSystem& system) const = 0;
};

/// An effect that loads vertices.
class LoadTerm {
  public:
    virtual ~LoadTerm() = default;
    /// Adds to `force` (N, one a vertex) what acts on `mesh` during the step at `at`.
    virtual void add(const ClothMesh& mesh, const Linearization& at, std::vector<Vec3>& force) const = 0;
};

/// The effects of a scene, made at load. What is absent is not in a list.
struct Terms {
    std::vector<std::unique_ptr<const FaceTerm>> faces;
    std::vector<std::unique_ptr<const HingeTerm>> hinges;
    std::vector<std::unique_ptr<const LoadTerm>> loads;
};

/// Inertia and membrane always; the others where their effect is there. Adding a term is one file and one
/// line here.
Terms make_terms(const Material& material, const std::optional<Gravity>& gravity,
                 const std::optional<Wind>& wind, const std::vector<Pull>& pulls);

}  // namespace arris
