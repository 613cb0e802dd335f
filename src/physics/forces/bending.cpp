// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/forces/bending.h"

#include <algorithm>
#include <optional>

#include "physics/elements/hinge_angle.h"

namespace arris {

namespace {

/// V / (K w) of a hinge, and its derivative by sigma = sin^2(theta/2).
struct Response {
    double energy, slope;
};

Response find_response(const HingeElement& hinge, double sigma)
{
    // theta = 60 degrees. A right angle within one cell exceeds this; spread over three cells it does not.
    constexpr double kCreased = 0.25;
    if (!hinge.is_crease()) return {sigma, 1.0};
    if (sigma >= kCreased) return {0.5 * kCreased, 0.0};
    return {sigma * (1.0 - 0.5 * sigma / kCreased), 1.0 - sigma / kCreased};
}

}  // namespace

double Bending::stiffness_of(const HingeElement& hinge) const
{
    const double c = stiffness_[hinge.pieces[0]], d = stiffness_[hinge.pieces[1]];
    if (hinge.pieces[0] == hinge.pieces[1] || !(c > 0.0) || !(d > 0.0)) return std::min(c, d);
    return 1.0 / (hinge.share / c + (1.0 - hinge.share) / d);
}

double Bending::energy(const HingeState& hinge) const
{
    const double stiffness = stiffness_of(hinge.element);
    if (!(stiffness > 0.0)) return 0.0;
    const std::optional<HingeAngle> angle = find_hinge_angle(hinge.x);
    if (!angle) return 0.0;
    return stiffness * hinge.element.weight * find_response(hinge.element, angle->squared_sine()).energy;
}

void Bending::add(const HingeState& hinge, HingeSystem& system) const
{
    const double stiffness = stiffness_of(hinge.element);
    if (!(stiffness > 0.0)) return;
    const std::optional<HingeAngle> angle = find_hinge_angle(hinge.x);
    if (!angle) return;
    const std::array<Vec3, 4> gradient = angle_gradient(*angle, hinge.x);

    // dV/dtheta = K w sin(theta/2) cos(theta/2) = K w sin(theta) / 2; the stiffness has the factor 2 K w
    // (cos(theta/2) / 2)^2. A crease scales both by its slope. The part with a crease's curvature is negative
    // and left out.
    const Response response = find_response(hinge.element, angle->squared_sine());
    const double scale = stiffness * hinge.element.weight * response.slope;
    const double sin_theta = sine_of_angle(*angle, hinge.x);
    const double squared_cos_half = angle->squared_cosine();
    for (int i = 0; i < 4; ++i) {
        system.add_elastic_force(i, -0.5 * scale * sin_theta * gradient[i]);
        for (int j = 0; j <= i; ++j)
            system.add_stiffness(i, j,
                                 0.5 * scale * squared_cos_half * gradient[i] * gradient[j].transpose());
    }
    if (!system.is_eulerian()) return;
    // Between two materials, each face's area counts by its own compliance.
    std::array<double, 2> parts = {1.0, 1.0};
    if (hinge.element.pieces[0] != hinge.element.pieces[1])
        for (int side = 0; side < 2; ++side) parts[side] = stiffness / stiffness_[hinge.element.pieces[side]];
    const auto& [by_edge, by_area] = *hinge.weight_gradients;
    for (int i = 0; i < 4; ++i) {
        const Vec2 slope = parts[0] * by_area[0][i] + parts[1] * by_area[1][i] + by_edge[i];
        system.add_material_force(i, -stiffness * response.energy * slope);
    }
}

}  // namespace arris
