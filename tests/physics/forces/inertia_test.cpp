// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/forces/inertia.h"

#include <gtest/gtest.h>

#include "tests/physics/eulerian_cloth.h"

namespace arris {
namespace {

constexpr double kRoundOff = 1e-12;

TEST(CornerVelocities, AVertexThatSlidesInAFlatSheetMovesNoMaterial)
{
    // Adding (dx, dX) = (F s, s) to any vertices leaves corner velocities, energy, momenta and rows of the
    // system unchanged.
    Generator random(16);
    ClothMesh mesh = crumpled_sheet({6, 5}, GridPattern::Cross, 17);
    Mat32 F;
    F << 1.1, 0.2, -0.1, 0.9, 0.3, 0.4;
    for (std::size_t v = 0; v < mesh.world.size(); ++v) mesh.world[v] = F * mesh.material[v];
    const ClothElements elements = make_elements(mesh, make_topology(mesh.vertex_count(), mesh.faces));
    const std::size_t n = mesh.world.size();
    std::vector<Vec3> velocity, sliding;
    std::vector<Vec2> flow;
    for (std::size_t v = 0; v < n; ++v) {
        flow.push_back(random2(random, 3.0));
        velocity.push_back(random3(random, 1.0));
        sliding.push_back(velocity[v] + F * flow[v]);
    }
    const CornerVelocities plain =
        compute_corner_velocities(elements, mesh.world, velocity, std::vector<Vec2>(n, Vec2::Zero()));
    const CornerVelocities corners = compute_corner_velocities(elements, mesh.world, sliding, flow);
    for (std::size_t f = 0; f < corners.size(); ++f)
        for (int i = 0; i < 3; ++i) EXPECT_LT((corners[f][i] - plain[f][i]).norm(), 1e-12);

    const double density = 0.15;
    EXPECT_EQ(kinetic_energy(Material{density}, elements, plain),
              kinetic_energy(Material{density}, elements, velocity));
    EXPECT_EQ(linear_momentum(Material{density}, elements, plain),
              linear_momentum(Material{density}, elements, velocity));
    EXPECT_EQ(angular_momentum(Material{density}, elements, mesh.world, plain),
              angular_momentum(Material{density}, elements, mesh.world, velocity));
    EXPECT_NEAR(kinetic_energy(Material{density}, elements, corners),
                kinetic_energy(Material{density}, elements, velocity), 1e-13);
    EXPECT_LT((linear_momentum(Material{density}, elements, corners) -
               linear_momentum(Material{density}, elements, velocity))
                  .norm(),
              1e-13);
    EXPECT_LT((angular_momentum(Material{density}, elements, mesh.world, corners) -
               angular_momentum(Material{density}, elements, mesh.world, velocity))
                  .norm(),
              1e-13);
    const std::vector<Vec3> mean = mean_corner_velocities(elements, corners, sliding, flow);
    for (std::size_t v = 0; v < n; ++v) EXPECT_LT((mean[v] - velocity[v]).norm(), 1e-12);
    EXPECT_EQ(mean_corner_velocities(elements, plain, velocity, std::vector<Vec2>(n, Vec2::Zero())),
              velocity);

    // With u = (x along the normal and one direction, X along another) the mass matrix must agree with the
    // unreduced one.
    Linearization at = linearization_at_rest(mesh, 18);
    for (std::size_t v = 0; v < n; ++v) {
        at.flow->is_eulerian[v] = 1;
        at.basis[v] << random3(random, 1.0), random3(random, 1.0), Vec3::Zero();
        at.flow->basis[v] << Vec2::Zero(), Vec2::Zero(), random2(random, 1.0);
    }
    const Eigen::MatrixXd eulerian =
        assemble(mesh, only(std::make_unique<Inertia>(Material{density})), at).matrix;
    for (std::size_t v = 0; v < n; ++v) {
        at.has_basis[v] = 1;
        at.basis[v] -= F * at.flow->basis[v];
    }
    at.flow.reset();
    const Eigen::MatrixXd plain_matrix =
        assemble(mesh, only(std::make_unique<Inertia>(Material{density})), at).matrix;
    EXPECT_LT((eulerian - plain_matrix).norm(), kRoundOff * plain_matrix.norm());
}

}  // namespace
}  // namespace arris
