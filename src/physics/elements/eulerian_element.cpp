// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/elements/eulerian_element.h"

namespace arris {

namespace {

/// Fdot = sum_j w_j b_j^T in the extrapolated state.
Mat32 deformation_rate(const FaceState& face, const ExtrapolatedState& state)
{
    Mat32 rate = Mat32::Zero();
    std::array<Vec3, 3> w;
    for (int j = 0; j < 3; ++j) {
        const int v = face.element.vertices[j], p = face.element.points[j];
        w[j] = state.velocity[v] - face.F * state.material_velocity[p];
        // Use differences, as for F: a translation, however fast, causes no deformation.
        if (j > 0) rate += (w[j] - w[0]) * face.element.gradients[j].transpose();
    }
    return rate;
}

}  // namespace

FaceSystem eulerian_inertia_and_loads(const FaceElement& face, const Terms& terms, const Linearization& at)
{
    const ExtrapolatedState& there = at.flow->extrapolated;
    const FaceElement element = move_element(face, there.material);
    const FaceState state(element, there.position);
    FaceSystem local(at, face.vertices, face.points, face.piece, {state.F, state.F, state.F});
    const Mat32 F_rate = deformation_rate(state, there);
    for (int i = 0; i < 3; ++i)
        local.add_convection(i, 2.0 * (F_rate * there.material_velocity[face.points[i]]));
    for (const auto& term : terms.faces)
        if (!term->is_elastic()) term->add(state, local);
    return local;
}

FaceSystem eulerian_elasticity(const FaceElement& face, const Terms& terms, const Linearization& at)
{
    const FaceElement element = move_element(face, at.flow->position);
    const FaceState state(element, at.position);
    FaceSystem local(at, face.vertices, face.points, face.piece, {state.F, state.F, state.F});
    for (const auto& term : terms.faces)
        if (term->is_elastic()) term->add(state, local);
    return local;
}

std::array<Mat32, 4> find_hinge_deformation(const HingeElement& hinge, const FaceElement& c,
                                            const FaceElement& d, const Linearization& at)
{
    // Vertices a and b belong to both faces, c and d to one each.
    const Mat32 F_c = FaceState(c, at.position).F, F_d = FaceState(d, at.position).F;
    const Mat32 turned = hinge.is_seam ? Mat32(F_d * turn_over(at.flow->position, hinge, c, d)) : F_d;
    const Mat32 mean = 0.5 * (F_c + turned);
    return {mean, mean, F_c, F_d};
}

HingeSystem eulerian_hinge(const HingeElement& hinge, const HingeMoment* moment,
                           const ClothElements& elements, const Terms& terms, const Linearization& at)
{
    const std::vector<Vec2>& X = at.flow->position;
    const FaceElement c = move_element(elements.faces[hinge.faces[0]], X);
    const FaceElement d = move_element(elements.faces[hinge.faces[1]], X);
    HingeElement element = hinge;
    set_hinge(X, c, d, element);
    HingeState state(element, at.position, moment);
    state.weight_gradients = compute_hinge_weight_gradients(X, hinge, c, d);

    HingeSystem local(at, hinge.vertices, points_of(hinge, c, d), hinge.pieces[0],
                      find_hinge_deformation(hinge, c, d, at));
    for (const auto& term : terms.hinges) term->add(state, local);
    return local;
}

}  // namespace arris
