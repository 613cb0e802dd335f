// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/elements/momentum_flux.h"

#include <array>

#include "physics/elements/eulerian_element.h"

namespace arris {

namespace {

/// A crease from a to b at the extrapolated state, with face c on its left and face d on its right.
struct Crease {
    std::array<int, 2> vertices, points;
    Mat32 F_c, F_d;
    Vec2 across;  ///< m, to the right in the material, as long as the crease
};

Crease find_crease(const HingeElement& hinge, const ClothElements& elements, const ExtrapolatedState& there)
{
    const auto deformation = [&](int face) {
        const FaceElement element = move_element(elements.faces[face], there.material);
        return FaceState(element, there.position).F;
    };
    const std::array<int, 4> points = points_of(hinge, elements);
    const Vec2 along = there.material[points[1]] - there.material[points[0]];
    return {{hinge.vertices[0], hinge.vertices[1]},
            {points[0], points[1]},
            deformation(hinge.faces[0]),
            deformation(hinge.faces[1]),
            {along.y(), -along.x()}};
}

/// Integral over the crease of N_i (V . n) (w_c - w_d), m^3/s^2, for both ends i. All three factors are
/// linear along the crease; the mean values of N_i^3 and N_i^2 N_j are 1/4 and 1/12.
std::array<Vec3, 2> turned_flow(const Crease& crease, const std::vector<Vec2>& material_velocity)
{
    std::array<double, 2> passing;
    std::array<Vec3, 2> jump;
    for (int i = 0; i < 2; ++i) {
        const Vec2& V = material_velocity[crease.points[i]];
        passing[i] = V.dot(crease.across);
        jump[i] = (crease.F_d - crease.F_c) * V;
    }
    std::array<Vec3, 2> turned;
    for (const auto& [i, j] : {std::pair{0, 1}, {1, 0}})
        turned[i] = passing[i] * jump[i] / 4.0 +
                    (passing[i] * jump[j] + passing[j] * jump[i] + passing[j] * jump[j]) / 12.0;
    return turned;
}

}  // namespace

std::vector<CreaseForce> find_momentum_flux(const Materials& materials, const ClothElements& elements,
                                            const Linearization& at)
{
    std::vector<CreaseForce> found;
    if (!at.flow) return found;
    for (const HingeElement& hinge : elements.hinges) {
        if (hinge.is_seam) continue;  // material flows along it, never over it
        if (!has_eulerian_vertex<2>(*at.flow, {hinge.vertices[0], hinge.vertices[1]})) continue;
        const Crease crease = find_crease(hinge, elements, at.flow->extrapolated);
        const std::array<Vec3, 2> turned = turned_flow(crease, at.flow->extrapolated.material_velocity);
        const double density = materials[hinge.pieces[0]].density;
        found.push_back({crease.vertices,
                         crease.points,
                         {-density * turned[0], -density * turned[1]},
                         0.5 * (crease.F_c + crease.F_d)});
    }
    return found;
}

void add_momentum_flux(const Materials& materials, const ClothElements& elements, const Linearization& at,
                       Eigen::VectorXd& rhs)
{
    for (const CreaseForce& crease : find_momentum_flux(materials, elements, at))
        for (int i = 0; i < 2; ++i) {
            const int v = crease.vertices[i];
            const Mat3 G = corner_matrix(crease.F, at.basis[v], at.flow->basis[crease.points[i]]);
            rhs.segment<3>(3 * v) += at.gamma * (G.transpose() * crease.force[i]);
        }
}

}  // namespace arris
