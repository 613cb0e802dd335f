// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/system/feature_impulse.h"
#include "physics/forces/make_terms.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/physics/eulerian_cloth.h"

namespace arris {
namespace {

constexpr double kRoundOff = 1e-12;  // relative to the largest of sums over some tens of elements

Eigen::VectorXd some_velocity(int vertices)
{
    Generator random(41);
    Eigen::VectorXd u(3 * vertices);
    for (int v = 0; v < vertices; ++v) u.segment<3>(3 * v) = random3(random, 1.0);
    return u;
}

TEST(FeatureImpulse, AlongWhatMovesNoMaterialIsTheSystemsResidual)
{
    const ClothMesh mesh = crumpled_sheet({6, 5}, GridPattern::Alternating, 42);
    const int n = mesh.vertex_count();
    Linearization at = random_linearization(mesh, 43);
    for (int v = 0; v < n; ++v) {
        at.flow->basis[v].col(0).setZero();
        if (v % 4 == 1) at.flow->basis[v].setZero();
    }
    const Terms terms =
        make_terms(Material{0.15, 500.0, 0.3, 1e-4, 0.01, 1e-3}, Gravity{}, Wind{Vec3(1, 2, 3), 1.2, 1.0, {}},
                   {Pull{{Vec2(0, 0), Vec2(0.5, 1)}, Vec3(1, 0, 0)}});
    const ClothElements elements = make_elements(mesh, make_topology(n, mesh.faces));
    const Assembled system = assemble(mesh, terms, at);
    const Eigen::VectorXd u = some_velocity(n);
    const Eigen::VectorXd residual = system.matrix * u - system.rhs;
    const std::vector<Vec3> impulse = compute_feature_impulses(mesh, elements, terms, at, u);
    int checked = 0;
    for (int v = 0; v < n; ++v) {
        if (!at.flow->is_eulerian[v]) {
            EXPECT_EQ(impulse[v], Vec3::Zero());
            continue;
        }
        const Vec3 along = at.basis[v].transpose() * impulse[v];
        const int known = v % 4 == 1 ? 3 : 1;  // coordinates in which no material moves
        EXPECT_LT((along - residual.segment<3>(3 * v)).head(known).norm(), kRoundOff * residual.norm()) << v;
        checked += known;
    }
    EXPECT_GT(checked, n);
}

TEST(FeatureImpulse, IsNoneWhereNoMaterialFlows)
{
    const ClothMesh mesh = crumpled_sheet({3, 3}, GridPattern::Diagonal, 44);
    Linearization at = random_linearization(mesh, 45);
    at.flow.reset();
    const Terms terms = make_terms(Material{0.15, 500.0, 0.3, 1e-4, 0.0, 1e-3}, Gravity{}, {}, {});
    const ClothElements elements = make_elements(mesh, make_topology(mesh.vertex_count(), mesh.faces));
    for (const Vec3& impulse :
         compute_feature_impulses(mesh, elements, terms, at, some_velocity(mesh.vertex_count())))
        EXPECT_EQ(impulse, Vec3::Zero());
}

}  // namespace
}  // namespace arris
