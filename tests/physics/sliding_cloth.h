// SPDX-License-Identifier: GPL-3.0-or-later
// The plainest time stepper that uses the assembled system with EOL vertices: BDF2, dense factorisation,
// contacts that neither open nor need to be found.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "physics/linear_system.h"

namespace arris {

/// v' = basis u, V' = material_basis u, with the known ones of u.
struct VertexCoordinates {
    Mat3 basis = Mat3::Identity();
    Mat23 material_basis = Mat23::Zero();
    std::array<std::optional<double>, 3> known = {};  ///< m/s

    bool is_eulerian() const { return !material_basis.isZero(0.0); }
};

/// On a face with unit normal n: u = (out of it, along it twice), the first 0.
VertexCoordinates on_face(const Vec3& n);

/// EOL on an edge or wire with unit tangent t: u = (along nbar, along t, material along `direction`), the
/// first 0.
VertexCoordinates on_edge(const Vec3& t, const Vec3& nbar, const Vec2& direction);

/// EOL on a corner or a lone point: u = (along nbar, material along u, along v), the first 0.
VertexCoordinates on_point(const Vec3& nbar);

/// A cloth and its past.
struct SlidingCloth {
    /// Each vertex's coordinates for the next step, from the cloth as it is.
    using Coordinates = std::function<std::vector<VertexCoordinates>(const SlidingCloth&)>;

    Terms terms;
    ClothMesh mesh;
    ClothElements elements;  ///< of `mesh` as it is
    Coordinates coordinates;
    bool has_convection = true;  ///< 2 Fdot V, which some leave out

    std::vector<Vec3> velocity, previous_world, previous_velocity;
    std::vector<Vec2> material_velocity, previous_material, previous_material_velocity;
    bool has_history = false;
    double time = 0.0;

    SlidingCloth(Terms some_terms, ClothMesh a_mesh, Coordinates some_coordinates);

    /// BDF2 with equal steps, after a first one of implicit Euler. A matrix that is not positive definite
    /// fails the test.
    void step(double h);

    /// `steps` equal steps.
    void advance(double duration, int steps);

    /// Kinetic and potential, J.
    double total_energy(double density) const;

    Linearization linearize(const std::vector<VertexCoordinates>& at, double h) const;

  private:
    LinearSystem system_;
};

}  // namespace arris
