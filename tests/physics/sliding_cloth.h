// SPDX-License-Identifier: GPL-3.0-or-later
// A minimal time stepper for the assembled system with EOL vertices: BDF2, dense factorisation, given
// permanent contacts.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "physics/system/linear_system.h"

namespace arris {

/// v' = basis u, V' = material_basis u; some components of u may be known.
struct VertexCoordinates {
    Mat3 basis = Mat3::Identity();
    Mat23 material_basis = Mat23::Zero();
    std::array<std::optional<double>, 3> known = {};  ///< m/s

    bool is_eulerian() const { return !material_basis.isZero(0.0); }
};

/// Coordinates on a face with unit normal n: u = (along n, two along the face), with the first 0.
VertexCoordinates on_face(const Vec3& n);

/// EOL coordinates on an edge or wire with unit tangent t: u = (along nbar, along t, material along
/// `direction`), with the first 0.
VertexCoordinates on_edge(const Vec3& t, const Vec3& nbar, const Vec2& direction);

/// EOL coordinates on a corner or a lone point: u = (along nbar, material along u, material along v), with
/// the first 0.
VertexCoordinates on_point(const Vec3& nbar);

/// A cloth and its history.
struct SlidingCloth {
    /// Each vertex's coordinates for the next step, as a function of the present cloth.
    using Coordinates = std::function<std::vector<VertexCoordinates>(const SlidingCloth&)>;

    Terms terms;
    ClothMesh mesh;
    ClothElements elements;  ///< of the present `mesh`
    Coordinates coordinates;
    bool has_convection = true;  ///< whether inertia includes 2 Fdot V

    std::vector<Vec3> velocity, previous_world, previous_velocity;
    std::vector<Vec2> material_velocity, previous_material, previous_material_velocity;
    bool has_history = false;
    double time = 0.0;

    SlidingCloth(Terms some_terms, ClothMesh a_mesh, Coordinates some_coordinates);

    /// A step of BDF2 with equal steps; the first step is implicit Euler. The test fails if the matrix is not
    /// positive definite.
    void step(double h);

    /// Makes `steps` equal steps.
    void advance(double duration, int steps);

    /// Kinetic and potential energy, J.
    double total_energy(double density) const;

    Linearization linearize(const std::vector<VertexCoordinates>& at, double h) const;

  private:
    LinearSystem system_;
};

}  // namespace arris
