// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>

#include "geometry/vectors.h"

namespace arris {

/// How far the faces (a, b, c) and (b, a, d) at world positions a, b, c, d are folded: the signed angle theta
/// between their normals.
struct HingeAngle {
    Vec3 normal_c, normal_d;    ///< unit
    double length_c, length_d;  ///< m^2, norms of the unnormalised normals: twice the areas
    double softening;           ///< 1; less where a face has almost collapsed

    /// sin^2(theta/2) = |n_c - n_d|^2 / 4   no cancellation where the faces are flat
    double squared_sine() const { return 0.25 * (normal_c - normal_d).squaredNorm(); }
    double squared_cosine() const { return 0.25 * (normal_c + normal_d).squaredNorm(); }  ///< of theta/2
};

/// Nothing where a face has collapsed to a line: the hinge has no angle then.
std::optional<HingeAngle> find_hinge_angle(const std::array<Vec3, 4>& x);

/// sin(theta) of a hinge at these positions.
double sine_of_angle(const HingeAngle& angle, const std::array<Vec3, 4>& x);

/// d theta / dx of the four vertices, 1/m. As a face collapses, the gradient fades to zero.
std::array<Vec3, 4> angle_gradient(const HingeAngle& angle, const std::array<Vec3, 4>& x);

}  // namespace arris
