// SPDX-License-Identifier: GPL-3.0-or-later
// Elements with an EOL vertex (see linearization.h), in corner velocities until they are reduced. Each
// element is built at the material coordinates at which it is evaluated, and its corner matrices use its own
// F there. Elastic elements are evaluated at q^, inertia and loads at the extrapolated state. `at.flow` must
// be present.
#pragma once

#include <algorithm>
#include <array>

#include "physics/elements/term.h"

namespace arris {

/// Whether material flows through any of an element's vertices.
template <std::size_t N>
bool has_eulerian_vertex(const MaterialFlow& flow, const std::array<int, N>& vertices)
{
    return std::any_of(vertices.begin(), vertices.end(), [&](int v) { return flow.is_eulerian[v] != 0; });
}

/// A face's inertia and loads, with the convection term 2 Fdot V.
FaceSystem eulerian_inertia_and_loads(const FaceElement& face, const Terms& terms, const Linearization& at);

/// A face's elastic terms.
FaceSystem eulerian_elasticity(const FaceElement& face, const Terms& terms, const Linearization& at);

/// A hinge's terms. `moment` is that of the hinge (HingeStates).
HingeSystem eulerian_hinge(const HingeElement& hinge, const HingeMoment* moment,
                           const ClothElements& elements, const Terms& terms, const Linearization& at);

/// F at the corners of a hinge with faces c and d, at q^: the mean over the faces at each corner, on a seam
/// in the material of face c.
std::array<Mat32, 4> find_hinge_deformation(const HingeElement& hinge, const FaceElement& c,
                                            const FaceElement& d, const Linearization& at);

/// Reduces an element to the coordinates of its vertices; `points`: of the material at its corners.
template <int N>
void reduce_eulerian(const std::array<int, N>& vertices, const std::array<int, N>& points,
                     const Linearization& at, LocalSystem<N>& local)
{
    std::array<const Mat3*, N> bases;
    std::array<const Mat23*, N> material_bases;
    for (int i = 0; i < N; ++i) {
        bases[i] = &at.basis[vertices[i]];
        material_bases[i] = &at.flow->basis[points[i]];
    }
    local.reduce_eulerian(bases, material_bases);
}

}  // namespace arris
