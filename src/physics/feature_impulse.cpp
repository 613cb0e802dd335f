// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/feature_impulse.h"

#include "physics/eulerian_element.h"
#include "physics/momentum_flux.h"

namespace arris {

namespace {

/// Adds an element's A w' - b at its EOL corners.
template <int N>
void add_residual(const std::array<int, N>& vertices, const LocalSystem<N>& local, const Linearization& at,
                  const Eigen::VectorXd& u, std::vector<Vec3>& impulse)
{
    std::array<Vec3, N> w;
    for (int j = 0; j < N; ++j) {
        const int v = vertices[j];
        w[j] = corner_matrix(local.deformation(j), at.basis[v], at.flow->basis[v]) * u.segment<3>(3 * v);
    }
    for (int i = 0; i < N; ++i) {
        if (!at.flow->is_eulerian[vertices[i]]) continue;
        Vec3& sum = impulse[vertices[i]];
        sum -= local.rhs(i);
        for (int j = 0; j < N; ++j) {
            if (j <= i)
                sum += local.matrix(i, j) * w[j];
            else
                sum += local.matrix(j, i).transpose() * w[j];
        }
    }
}

/// Subtracts loads on EOL vertices, evaluated at the extrapolated material coordinates.
void subtract_loads(const ClothMesh& mesh, const Terms& terms, const Linearization& at,
                    std::vector<Vec3>& impulse)
{
    if (terms.loads.empty()) return;
    ClothMesh flowed = mesh;
    flowed.material = at.flow->extrapolated.material;
    std::vector<Vec3> load(impulse.size(), Vec3::Zero());
    for (const auto& term : terms.loads) term->add(flowed, at, load);
    for (std::size_t v = 0; v < impulse.size(); ++v)
        if (at.flow->is_eulerian[v]) impulse[v] -= at.gamma * load[v];
}

}  // namespace

std::vector<Vec3> compute_feature_impulses(const ClothMesh& mesh, const ClothElements& elements,
                                           const Terms& terms, const Linearization& at,
                                           const Eigen::VectorXd& u)
{
    std::vector<Vec3> impulse(elements.vertex_count, Vec3::Zero());
    if (!at.flow) return impulse;
    for (const FaceElement& element : elements.faces) {
        const Face& face = element.vertices;
        if (!has_eulerian_vertex(*at.flow, face)) continue;
        add_residual<3>(face, eulerian_inertia_and_loads(face, terms, at), at, u, impulse);
        add_residual<3>(face, eulerian_elasticity(face, terms, at), at, u, impulse);
    }
    if (!terms.hinges.empty())
        for (const HingeElement& hinge : elements.hinges)
            if (has_eulerian_vertex(*at.flow, hinge.vertices))
                add_residual<4>(hinge.vertices, eulerian_hinge(hinge, elements, terms, at), at, u, impulse);
    for (const CreaseForce& crease : find_momentum_flux(terms.density, elements, at))
        for (int i = 0; i < 2; ++i)
            if (at.flow->is_eulerian[crease.vertices[i]])
                impulse[crease.vertices[i]] -= at.gamma * crease.force[i];
    subtract_loads(mesh, terms, at, impulse);
    return impulse;
}

}  // namespace arris
