// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/physics/sliding_cloth.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "physics/forces/energies.h"
#include "physics/forces/inertia.h"

namespace arris {

namespace {

/// a~ = (4 a_k - a_(k-1)) / 3, or a_k without history.
template <typename Vector>
std::vector<Vector> predict(const std::vector<Vector>& last, const std::vector<Vector>& previous,
                            bool has_history)
{
    std::vector<Vector> predicted = last;
    if (!has_history) return predicted;
    for (std::size_t v = 0; v < last.size(); ++v) predicted[v] += (last[v] - previous[v]) / 3.0;
    return predicted;
}

/// 2 v_k - v_(k-1), or v_k without history.
template <typename Vector>
std::vector<Vector> extrapolate(const std::vector<Vector>& last, const std::vector<Vector>& previous,
                                bool has_history)
{
    std::vector<Vector> ahead = last;
    if (!has_history) return ahead;
    for (std::size_t v = 0; v < last.size(); ++v) ahead[v] += last[v] - previous[v];
    return ahead;
}

template <typename Vector>
std::vector<Vector> moved(std::vector<Vector> position, double gamma, const std::vector<Vector>& velocity)
{
    for (std::size_t v = 0; v < position.size(); ++v) position[v] += gamma * velocity[v];
    return position;
}

/// Solves A u = b with the known components of u eliminated.
Eigen::VectorXd solve(const LinearSystem& system, const std::vector<VertexCoordinates>& coordinates)
{
    std::vector<int> unknown;
    Eigen::VectorXd u = Eigen::VectorXd::Zero(system.rhs().size());
    for (int k = 0; k < u.size(); ++k) {
        const std::optional<double>& known = coordinates[k / 3].known[k % 3];
        if (known)
            u[k] = *known;
        else
            unknown.push_back(k);
    }
    const Eigen::MatrixXd lower = system.matrix();
    const Eigen::MatrixXd A = lower.selfadjointView<Eigen::Lower>();
    const Eigen::VectorXd all = system.rhs() - A * u;
    const auto n = static_cast<Eigen::Index>(unknown.size());
    Eigen::MatrixXd free(n, n);
    Eigen::VectorXd rest(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        rest[i] = all[unknown[i]];
        for (Eigen::Index j = 0; j < n; ++j) free(i, j) = A(unknown[i], unknown[j]);
    }
    const Eigen::LLT<Eigen::MatrixXd> factor(free);
    EXPECT_EQ(factor.info(), Eigen::Success) << "the matrix is positive definite";
    const Eigen::VectorXd found = factor.solve(rest);
    for (Eigen::Index i = 0; i < n; ++i) u[unknown[i]] = found[i];
    return u;
}

}  // namespace

VertexCoordinates on_face(const Vec3& n)
{
    VertexCoordinates c;
    const Vec3 across = n.unitOrthogonal();
    c.basis << n, across, n.cross(across);
    c.known[0] = 0.0;
    return c;
}

VertexCoordinates on_edge(const Vec3& t, const Vec3& nbar, const Vec2& direction)
{
    VertexCoordinates c;
    c.basis << nbar, t, Vec3::Zero();
    c.material_basis.col(2) = direction;
    c.known[0] = 0.0;
    return c;
}

VertexCoordinates on_point(const Vec3& nbar)
{
    VertexCoordinates c;
    c.basis << nbar, Vec3::Zero(), Vec3::Zero();
    c.material_basis << 0, 1, 0, 0, 0, 1;
    c.known[0] = 0.0;
    return c;
}

SlidingCloth::SlidingCloth(Terms some_terms, ClothMesh a_mesh, Coordinates some_coordinates)
    : terms(std::move(some_terms)), mesh(std::move(a_mesh)), coordinates(std::move(some_coordinates))
{
    const std::size_t n = mesh.world.size();
    velocity.assign(n, Vec3::Zero());
    material_velocity.assign(n, Vec2::Zero());
    elements = make_elements(mesh, make_topology(mesh.vertex_count(), mesh.faces));
    system_.make_pattern(elements);
}

Linearization SlidingCloth::linearize(const std::vector<VertexCoordinates>& c, double h) const
{
    const std::size_t n = mesh.world.size();
    Linearization at;
    at.begin = time;
    at.time = time + h;
    at.gamma = has_history ? 2.0 * h / 3.0 : h;
    at.v_predicted = predict(velocity, previous_velocity, has_history);
    at.v_last = velocity;
    at.v_expansion = has_history ? velocity : std::vector<Vec3>(n, Vec3::Zero());
    const std::vector<Vec3> x = predict(mesh.world, previous_world, has_history);
    at.position = moved(x, at.gamma, at.v_expansion);
    at.drift.assign(n, Vec3::Zero());
    MaterialFlow flow;
    for (const VertexCoordinates& vertex : c) {
        at.basis.push_back(vertex.basis);
        at.has_basis.push_back(vertex.basis != Mat3::Identity());
        flow.basis.push_back(vertex.material_basis);
        flow.is_eulerian.push_back(vertex.is_eulerian());
    }
    flow.v_predicted = predict(material_velocity, previous_material_velocity, has_history);
    flow.v_last = material_velocity;
    flow.v_expansion = has_history ? material_velocity : std::vector<Vec2>(n, Vec2::Zero());
    const std::vector<Vec2> X = predict(mesh.material, previous_material, has_history);
    flow.position = moved(X, at.gamma, flow.v_expansion);

    ExtrapolatedState& ahead = flow.extrapolated;
    ahead.velocity = extrapolate(velocity, previous_velocity, has_history);
    ahead.material_velocity = extrapolate(material_velocity, previous_material_velocity, has_history);
    const double reach = has_history ? at.gamma : 0.0;
    ahead.position = moved(x, reach, ahead.velocity);
    ahead.material = moved(X, reach, ahead.material_velocity);
    if (!has_convection) ahead.material_velocity.assign(n, Vec2::Zero());
    at.flow = std::move(flow);
    return at;
}

void SlidingCloth::step(double h)
{
    const std::vector<VertexCoordinates> c = coordinates(*this);
    const Linearization at = linearize(c, h);
    system_.assemble(mesh, elements, terms, at);
    const Eigen::VectorXd u = solve(system_, c);

    std::vector<Vec3> world = predict(mesh.world, previous_world, has_history);
    std::vector<Vec2> material = predict(mesh.material, previous_material, has_history);
    previous_velocity = velocity;
    previous_material_velocity = material_velocity;
    for (std::size_t v = 0; v < world.size(); ++v) {
        const Vec3 u_v = u.segment<3>(3 * static_cast<Eigen::Index>(v));
        velocity[v] = c[v].basis * u_v;
        material_velocity[v] = c[v].material_basis * u_v;
    }
    previous_world = std::exchange(mesh.world, moved(world, at.gamma, velocity));
    previous_material = std::exchange(mesh.material, moved(material, at.gamma, material_velocity));
    update_elements(mesh, at.flow->is_eulerian, elements);
    has_history = true;
    time += h;
}

double SlidingCloth::total_energy(double density) const
{
    const CornerVelocities w = compute_corner_velocities(elements, mesh.world, velocity, material_velocity);
    const Energies energies = compute_energies(elements, terms, mesh.world);
    return kinetic_energy(Material{density}, elements, w) + energies.gravity + energies.stretch +
           energies.bending;
}

void SlidingCloth::advance(double duration, int steps)
{
    for (int k = 0; k < steps; ++k) step(duration / steps);
}

}  // namespace arris
