// SPDX-License-Identifier: GPL-3.0-or-later
// Elements with EOL vertices in the assembled system, against matrices written out from the kinematics.
#include "physics/elements/eulerian_element.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <Eigen/Dense>

#include "physics/forces/bending.h"
#include "physics/forces/gravity_force.h"
#include "physics/forces/inertia.h"
#include "physics/forces/make_terms.h"
#include "physics/forces/membrane.h"
#include "physics/forces/pull_force.h"
#include "physics/forces/wind_force.h"
#include "tests/physics/eulerian_cloth.h"

namespace arris {
namespace {

constexpr double kRoundOff = 1e-12;

/// Reduction matrix: from the three coordinates u of each vertex to its five components of x and X.
Eigen::MatrixXd reduction(const Linearization& at)
{
    const Eigen::Index n = static_cast<Eigen::Index>(at.basis.size());
    Eigen::MatrixXd P = Eigen::MatrixXd::Zero(5 * n, 3 * n);
    for (Eigen::Index v = 0; v < n; ++v) {
        P.block<3, 3>(5 * v, 3 * v) = at.basis[v];
        P.block<2, 3>(5 * v + 3, 3 * v) = at.flow->basis[v];
    }
    return P;
}

Eigen::VectorXd stack(const std::vector<Vec3>& world, const std::vector<Vec2>& material)
{
    Eigen::VectorXd stacked(5 * world.size());
    for (Eigen::Index v = 0; v < static_cast<Eigen::Index>(world.size()); ++v) {
        stacked.segment<3>(5 * v) = world[v];
        stacked.segment<2>(5 * v + 3) = material[v];
    }
    return stacked;
}

TEST(EulerianElement, InertiaIsTheReportsElementMatrixReduced)
{
    // M = rho A / 12 [2I I I -2F -F -F; I 2I I -F -2F -F; ...; likewise F^T F], in the extrapolated state.
    const double density = 0.15;
    for (const GridPattern pattern : {GridPattern::Diagonal, GridPattern::Cross}) {
        const ClothMesh mesh = crumpled_sheet({4, 3}, pattern, 1);
        Linearization at = random_linearization(mesh, 2);
        at.flow->extrapolated.velocity.assign(mesh.world.size(), Vec3(1, 2, 3));
        // Without flow 2 Fdot V vanishes.
        at.flow->extrapolated.material_velocity.assign(mesh.world.size(), Vec2::Zero());
        const Eigen::Index n = mesh.vertex_count();
        Eigen::MatrixXd M = Eigen::MatrixXd::Zero(5 * n, 5 * n);
        for (const Face& face : mesh.faces) {
            const FaceElement element = make_face_element(at.flow->extrapolated.material, face);
            const Mat32 F = FaceState(element, at.flow->extrapolated.position).F;
            Eigen::Matrix<double, 5, 5> block;
            block << Mat3::Identity(), -F, -F.transpose(), F.transpose() * F;
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    M.block<5, 5>(5 * face[i], 5 * face[j]) +=
                        density * element.area / 12.0 * (i == j ? 2.0 : 1.0) * block;
        }
        const Eigen::MatrixXd P = reduction(at);
        const Assembled system = assemble(mesh, only(std::make_unique<Inertia>(Material{density})), at);
        const Eigen::MatrixXd reduced = P.transpose() * M * P;
        EXPECT_LT((system.matrix - reduced).norm(), kRoundOff * reduced.norm());

        std::vector<Vec3> v = at.v_predicted;
        for (std::size_t k = 0; k < v.size(); ++k) v[k] -= at.drift[k];
        const Eigen::VectorXd rhs = P.transpose() * (M * stack(v, at.flow->v_predicted));
        EXPECT_LT((system.rhs - rhs).norm(), kRoundOff * rhs.norm());
    }
}

/// Independent element sum for face terms: corner velocities in place of vertex velocities, then G^T . G.
Assembled sum_by_corners(const ClothMesh& mesh, const FaceTerm& term, const Linearization& at,
                         const std::vector<Vec3>& x, const std::vector<Vec2>& X)
{
    const Eigen::Index n = mesh.vertex_count();
    Assembled sum{Eigen::MatrixXd::Zero(3 * n, 3 * n), Eigen::VectorXd::Zero(3 * n)};
    for (const Face& face : mesh.faces) {
        const FaceElement element = make_face_element(X, face);
        const FaceState state(element, x);
        Linearization corners = at;
        corners.flow.reset();
        for (const int v : face) {
            corners.v_last[v] -= state.F * at.flow->v_last[v];
            corners.v_expansion[v] -= state.F * at.flow->v_expansion[v];
            corners.v_predicted[v] -= state.F * at.flow->v_predicted[v];
        }
        FaceSystem local(corners, face);
        term.add(state, local);
        std::array<Mat3, 3> G;
        for (int i = 0; i < 3; ++i) G[i] = at.basis[face[i]] - state.F * at.flow->basis[face[i]];
        for (int i = 0; i < 3; ++i) {
            sum.rhs.segment<3>(3 * face[i]) += G[i].transpose() * local.rhs(i);
            for (int j = 0; j < 3; ++j) {
                const Mat3 block = i >= j ? local.matrix(i, j) : Mat3(local.matrix(j, i).transpose());
                sum.matrix.block<3, 3>(3 * face[i], 3 * face[j]) += G[i].transpose() * block * G[j];
            }
        }
    }
    return sum;
}

/// Drag in every direction. (Wind acts along the normal only, so flow along the face does not affect it.)
class Drag : public FaceTerm {
  public:
    void add(const FaceState& face, FaceSystem& system) const override
    {
        for (int i = 0; i < 3; ++i) {
            system.add_force(i, -face.element.area * system.v_last(i));
            system.add_viscosity(i, i, face.element.area * Mat3::Identity());
        }
    }
};

TEST(EulerianElement, LoadsAndViscosityActOnTheMaterialWhereItIsExtrapolatedTo)
{
    const ClothMesh mesh = crumpled_sheet({4, 3}, GridPattern::Cross, 3);
    const Linearization at = random_linearization(mesh, 4);
    Wind wind;
    wind.velocity = Vec3(3.0, 1.0, -4.0);
    std::vector<std::unique_ptr<const FaceTerm>> loads;
    loads.push_back(std::make_unique<WindForce>(wind));
    loads.push_back(std::make_unique<GravityForce>(Material{0.15}, Gravity{}));
    loads.push_back(std::make_unique<Drag>());
    for (auto& term : loads) {
        // Only Lagrangian faces are evaluated at q^; here every face has an EOL corner.
        for (const Face& face : mesh.faces) ASSERT_TRUE(has_eulerian_vertex(*at.flow, face));
        const Assembled expected =
            sum_by_corners(mesh, *term, at, at.flow->extrapolated.position, at.flow->extrapolated.material);
        const Assembled system = assemble(mesh, only(std::move(term)), at);
        EXPECT_LT((system.matrix - expected.matrix).norm(), kRoundOff * (1e-3 + expected.matrix.norm()));
        EXPECT_LT((system.rhs - expected.rhs).norm(), kRoundOff * expected.rhs.norm());
        EXPECT_GT(expected.rhs.norm(), 0.0);
    }
}

TEST(EulerianElement, ElasticStiffnessIsThatOfTheCornersAtTheExpansionPoint)
{
    const ClothMesh mesh = crumpled_sheet({4, 3}, GridPattern::Diagonal, 5);
    const Linearization at = random_linearization(mesh, 6);
    const Assembled expected =
        sum_by_corners(mesh, Membrane(Material{0.0, 500.0, 0.3}), at, at.position, at.flow->position);
    const Assembled system = assemble(mesh, only(std::make_unique<Membrane>(Material{0.0, 500.0, 0.3})), at);
    EXPECT_LT((system.matrix - expected.matrix).norm(), kRoundOff * expected.matrix.norm());

    // The right-hand side also contains the energy that flows into the faces: -gamma E^T sum V b_i.
    Eigen::VectorXd rhs = expected.rhs;
    for (const Face& face : mesh.faces) {
        const FaceElement element = make_face_element(at.flow->position, face);
        const double V = Membrane(Material{0.0, 500.0, 0.3}).energy(FaceState(element, at.position));
        for (int i = 0; i < 3; ++i)
            rhs.segment<3>(3 * face[i]) -=
                at.gamma * V * (at.flow->basis[face[i]].transpose() * element.gradients[i]);
    }
    EXPECT_LT((system.rhs - rhs).norm(), 1e-11 * rhs.norm());
}

TEST(EulerianElement, HingeStiffnessIsThatOfTheMeanCornersAtTheExpansionPoint)
{
    // One hinge with an EOL edge; X^ is far from the material coordinates of the mesh.
    ClothMesh mesh;
    mesh.material = {Vec2(0, 0), Vec2(0.1, 1), Vec2(-1, 0.4), Vec2(0.8, 0.5)};
    mesh.world = {Vec3(0, 0, 0), Vec3(0, 1, 0.1), Vec3(-0.9, 0.4, -0.3), Vec3(0.7, 0.5, -0.4)};
    mesh.faces = {{0, 1, 2}, {1, 0, 3}};
    Linearization at = random_linearization(mesh, 21);
    MaterialFlow& flow = *at.flow;
    flow.is_eulerian = {1, 1, 1, 1};
    flow.position = {Vec2(0.1, -0.1), Vec2(0.2, 1.1), Vec2(-1, 0.4), Vec2(0.8, 0.5)};
    flow.basis[0] = flow.basis[1];
    flow.basis[2] = flow.basis[3];
    const double K = 0.1;
    Terms terms;
    terms.hinges.push_back(std::make_unique<Bending>(std::vector<double>{K}));
    const Assembled system = assemble(mesh, terms, at);

    const ClothElements elements = [&] {
        ClothMesh there = mesh;
        there.material = flow.position;
        return make_elements(there, make_topology(4, mesh.faces));
    }();
    const HingeElement& hinge = elements.hinges.at(0);
    std::array<Mat32, 2> F;
    for (int f = 0; f < 2; ++f) F[f] = FaceState(elements.faces[hinge.faces[f]], at.position).F;
    std::array<Mat32, 4> at_corner = {0.5 * (F[0] + F[1]), 0.5 * (F[0] + F[1]), F[0], F[1]};
    Linearization plain = at;
    plain.flow.reset();
    HingeSystem local(plain, hinge.vertices);
    Bending({K}).add(HingeState(hinge, at.position), local);
    std::array<Mat3, 4> G;
    for (int i = 0; i < 4; ++i)
        G[i] = at.basis[hinge.vertices[i]] - at_corner[i] * flow.basis[hinge.vertices[i]];
    double size = 0.0;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j <= i; ++j) {
            const Mat3 expected = G[i].transpose() * local.matrix(i, j) * G[j];
            const Mat3 found = system.matrix.block<3, 3>(3 * hinge.vertices[i], 3 * hinge.vertices[j]);
            size += expected.norm();
            EXPECT_LT((found - expected).norm(), kRoundOff * system.matrix.norm()) << i << ", " << j;
        }
    EXPECT_GT(size, 0.0);
}

TEST(EulerianElement, PullFindsItsMaterialWhereItHasFlowedTo)
{
    ClothMesh mesh = crumpled_sheet({4, 4}, GridPattern::Diagonal, 22);
    const Linearization at = random_linearization(mesh, 23);
    Terms terms;
    terms.loads.push_back(
        std::make_unique<PullForce>(Pull{{Vec2(0.2, 0.3), Vec2(0.62, 0.9)}, Vec3(1, 2, 3)}));
    const Eigen::VectorXd flowed = assemble(mesh, terms, at).rhs;
    const Eigen::VectorXd still = [&] {
        Linearization before = at;
        before.flow->extrapolated.material = mesh.material;
        return assemble(mesh, terms, before).rhs;
    }();
    EXPECT_GT((flowed - still).norm(), 1e-3 * flowed.norm());
    mesh.material = at.flow->extrapolated.material;
    EXPECT_EQ(assemble(mesh, terms, at).rhs, flowed);
}

TEST(EulerianElement, IsBitIdenticalWithoutEolVerticesAndForAnyNumberOfThreads)
{
    const ClothMesh mesh = crumpled_sheet({30, 30}, GridPattern::Alternating, 12);
    const Terms terms =
        make_terms(Material{0.15, 500.0, 0.3, 1e-4, 0.01, 1e-3}, Gravity{}, Wind{Vec3(1, 2, 3), 1.2, 1.0, {}},
                   {Pull{{Vec2(0, 0), Vec2(0.5, 1)}, Vec3(1, 0, 0)}});
    Linearization at = random_linearization(mesh, 13);
    const ClothElements elements = make_elements(mesh, make_topology(mesh.vertex_count(), mesh.faces));
    LinearSystem system;
    system.make_pattern(elements);
    const auto values = [&] {
        system.assemble(mesh, elements, terms, at);
        std::vector<double> all(system.matrix().valuePtr(),
                                system.matrix().valuePtr() + system.matrix().nonZeros());
        all.insert(all.end(), system.rhs().begin(), system.rhs().end());
        return all;
    };
    const std::vector<double> first = values();
    for (const int threads : {1, 2, 4}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        EXPECT_EQ(values(), first) << threads << " threads";
    }

    MaterialFlow& flow = *at.flow;
    const std::size_t n = mesh.world.size();
    flow.is_eulerian.assign(n, 0);
    flow.basis.assign(n, Mat23::Zero());
    for (auto* velocities :
         {&flow.v_predicted, &flow.v_expansion, &flow.v_last, &flow.extrapolated.material_velocity})
        velocities->assign(n, Vec2::Zero());
    flow.position = flow.extrapolated.material = mesh.material;
    const std::vector<double> with_flow = values();
    at.flow.reset();
    EXPECT_EQ(with_flow, values());
}

}  // namespace
}  // namespace arris
