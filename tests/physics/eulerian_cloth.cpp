// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/physics/eulerian_cloth.h"

#include <Eigen/Dense>
#include <cmath>

namespace arris {

namespace {

double uniform(Generator& random, double size)
{
    return std::uniform_real_distribution<double>(-size, size)(random);
}

}  // namespace

Vec2 random2(Generator& random, double size)
{
    return {uniform(random, size), uniform(random, size)};
}

Vec3 random3(Generator& random, double size)
{
    return {uniform(random, size), uniform(random, size), uniform(random, size)};
}

ClothMesh crumpled_sheet(std::array<int, 2> resolution, GridPattern pattern, unsigned seed)
{
    ClothGrid grid;
    grid.resolution = resolution;
    grid.pattern = pattern;
    ClothMesh mesh = make_cloth_grid(grid);
    const std::vector<char> is_border = make_topology(mesh.vertex_count(), mesh.faces).is_border;
    Generator random(seed);
    const double size = 0.15 / resolution[0];
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        mesh.world[v] += random3(random, size);
        if (!is_border[v]) mesh.material[v] += random2(random, 0.5 * size);
    }
    return mesh;
}

Linearization random_linearization(const ClothMesh& mesh, unsigned seed)
{
    Generator random(seed);
    const int n = mesh.vertex_count();
    const double size = 0.01 / std::sqrt(n);
    Linearization at;
    at.time = at.gamma = 0.005;
    at.damping = {0.01};
    at.position = mesh.world;
    MaterialFlow flow;
    flow.position = mesh.material;
    flow.extrapolated.position = mesh.world;
    flow.extrapolated.material = mesh.material;
    for (int v = 0; v < n; ++v) {
        const bool is_eulerian = v % 2 == 1;
        at.v_predicted.push_back(random3(random, 1.0));
        at.v_expansion.push_back(random3(random, 1.0));
        at.v_last.push_back(random3(random, 1.0));
        at.drift.push_back(random3(random, 1.0));
        at.basis.push_back(Mat3::Identity() + Mat3(random3(random, 0.3).asDiagonal()));
        at.has_basis.push_back(1);
        at.position[v] += random3(random, size);
        const double moves = is_eulerian ? 1.0 : 0.0;
        flow.is_eulerian.push_back(is_eulerian);
        Mat23 E;
        for (int c = 0; c < 3; ++c) E.col(c) = moves * random2(random, 1.0);
        flow.basis.push_back(E);
        flow.v_predicted.push_back(moves * random2(random, 1.0));
        flow.v_expansion.push_back(moves * random2(random, 1.0));
        flow.v_last.push_back(moves * random2(random, 1.0));
        flow.position[v] += moves * random2(random, size);
        flow.extrapolated.position[v] += random3(random, size);
        flow.extrapolated.velocity.push_back(random3(random, 1.0));
        flow.extrapolated.material[v] += moves * random2(random, size);
        flow.extrapolated.material_velocity.push_back(moves * random2(random, 1.0));
    }
    at.flow = std::move(flow);
    return at;
}

Linearization linearization_at_rest(const ClothMesh& mesh, unsigned seed)
{
    Linearization at = random_linearization(mesh, seed);
    at.gamma = at.time = 1.0;
    at.position = at.flow->extrapolated.position = mesh.world;
    at.flow->position = at.flow->extrapolated.material = mesh.material;
    for (auto* velocities :
         {&at.v_predicted, &at.v_expansion, &at.v_last, &at.drift, &at.flow->extrapolated.velocity})
        velocities->assign(mesh.world.size(), Vec3::Zero());
    for (auto* velocities : {&at.flow->v_predicted, &at.flow->v_expansion, &at.flow->v_last,
                             &at.flow->extrapolated.material_velocity})
        velocities->assign(mesh.world.size(), Vec2::Zero());
    return at;
}

Assembled assemble(const ClothMesh& mesh, const Terms& terms, const Linearization& at)
{
    const ClothElements elements = make_elements(mesh, make_topology(mesh.vertex_count(), mesh.faces));
    LinearSystem system;
    system.make_pattern(elements);
    system.assemble(mesh, elements, terms, at);
    const Eigen::MatrixXd lower = system.matrix();
    return {lower.selfadjointView<Eigen::Lower>(), system.rhs()};
}

Terms only(std::unique_ptr<const FaceTerm> term)
{
    Terms terms;
    terms.faces.push_back(std::move(term));
    return terms;
}

}  // namespace arris
