// SPDX-License-Identifier: GPL-3.0-or-later
// Slip of two layers of cloth, with material that flows through a vertex of either one. The expected slip is
// written out from the motion of the layers' material.
#include "solver/friction/friction_pairs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/self_contact/self_contact_search.h"
#include "solver/step.h"

namespace arris {
namespace {

constexpr double kThickness = 1e-3;  // m
constexpr double kRoundOff = 1e-14;  // of slips of about 1 m/s

// The lower layer: four faces around vertex 0, compressed by 20 % where x < 0.
//
//          3
//        / | \         .
//      /   |   \       .
//     2 -- 0 -- 1      .
//      \   |   /       .
//        \ | /         .
//          4
//
// The upper layer is made alike, above the faces with x < 0: vertex 5 is its middle.
constexpr int kLower = 0, kUpper = 5;
constexpr double kShare = 0.8;          // of its length, compressed cloth
constexpr Face kBelow = {0, 3, 2};      // the lower face that is touched
const Vec3 kTouched(-0.02, 0.03, 0.0);  // m, under vertex 5

ClothMesh make_layers()
{
    ClothMesh mesh;
    for (const Vec3& place : {Vec3(0, 0, 0), Vec3(kTouched + kThickness * Vec3::UnitZ())}) {
        const int first = mesh.vertex_count();
        for (const Vec2& X : {Vec2(0, 0), Vec2(.1, 0), Vec2(-.1, 0), Vec2(0, .1), Vec2(0, -.1)}) {
            mesh.material.push_back(X + Vec2(first, 0));
            mesh.world.push_back(place + Vec3(X.x() < 0.0 ? kShare * X.x() : X.x(), X.y(), 0.0));
        }
        for (const Face& face : {Face{0, 1, 3}, Face{0, 3, 2}, Face{0, 2, 4}, Face{0, 4, 1}})
            mesh.faces.push_back({first + face[0], first + face[1], first + face[2]});
    }
    return mesh;
}

Mat32 stretched(double along_x)
{
    Mat32 F = Mat32::Identity();
    F(0, 0) = along_x;
    return F;
}

/// The two layers, with coordinates of vertex `flowing` as on a feature: u = (up, along y, material along x).
struct Layers {
    Scene scene;
    State state;
    ClothStars stars;
    ClothElements elements;
    Prediction prediction;
    Carriers carriers;
    Linearization at;
    int flowing;

    explicit Layers(int vertex) : flowing(vertex)
    {
        scene.materials[0] = {0.2, 50.0, 0.3, 1e-5, 0.0, kThickness};
        scene.self_contact = ClothContact{kThickness};
        scene.friction = Friction{{0.3}, {}, {}};
        state = make_state(scene, make_layers(), Vec3::Zero());
        stars = make_stars(state.mesh);
        elements = make_elements(state.mesh, stars.topology);
        prediction = predict(state, Integrator::ImplicitEuler, 0.005);
        carriers = move_obstacles(scene, state, stars.topology.edges, prediction, {}, 0.005);
        const std::size_t n = state.mesh.world.size();
        at.drift.assign(n, Vec3::Zero());
        at.basis.assign(n, Mat3::Identity());
        at.basis[vertex].col(0) = Vec3::UnitZ();
        at.basis[vertex].col(2).setZero();
        at.flow.emplace();
        at.flow->is_eulerian.assign(n, 0);
        at.flow->is_eulerian[vertex] = 1;
        at.flow->basis.assign(n, Mat23::Zero());
        at.flow->basis[vertex](0, 2) = 1.0;
    }

    /// Slip, m/s, in the world.
    Vec3 slip(const ClothPointPair& pair, const Eigen::VectorXd& u) const
    {
        const std::vector<Contact> contacts = {place_contact(
            make_self_contact(pair, Vec3::UnitZ(), state.mesh.world, kThickness), carriers, prediction)};
        VelocityProblem problem;
        const std::vector<SlipContact> slipping = add_friction_pairs(
            {scene, state, stars, elements, prediction, carriers, {}, contacts, at}, problem);
        Vec3 slip = Vec3::Zero();
        for (int d = 0; d < 2; ++d) {
            const ConstraintRow& row = problem.friction.at(0).slip[d];
            double along = -row.lower;
            for (int k = 0; k < row.count; ++k) along += row.coefficient[k] * u[row.coordinate[k]];
            slip += along * slipping.at(0).directions[d];
        }
        return slip;
    }

    /// The difference of the velocities of the pair's material, m/s, if faces at the flowing vertex have `F`.
    Vec3 expected(const ClothPointPair& pair, const Eigen::VectorXd& u, const Mat32& F) const
    {
        Vec3 sum = Vec3::Zero();
        for (int i = 0; i < 4; ++i) {
            const int v = pair.vertices[i];
            const Vec3 own = u.segment<3>(3 * v);
            sum +=
                pair.weights[i] * (v == flowing ? Vec3(-F.col(0) * own[2] + Vec3(0.0, own[1], own[0])) : own);
        }
        return Vec3(sum.x(), sum.y(), 0.0);
    }

    Eigen::VectorXd some_velocity() const
    {
        Eigen::VectorXd u(3 * state.mesh.vertex_count());
        for (int i = 0; i < u.size(); ++i) u[i] = std::sin(1.0 + 2.0 * i);
        return u;
    }
};

/// The place in the cloth that is `weights` of the face's corners, which begin with corner `turn`.
ClothPointPair over_face(int vertex, const Face& face, const std::array<double, 3>& weights, int turn)
{
    ClothPointPair pair = {SelfContactKind::VertexFace, {vertex, 0, 0, 0}, {1.0, 0.0, 0.0, 0.0}};
    for (int k = 0; k < 3; ++k) {
        pair.vertices[k + 1] = face[(k + turn) % 3];
        pair.weights[k + 1] = -weights[(k + turn) % 3];
    }
    return pair;
}

TEST(FrictionPairs, AVertexSlipsAgainstTheMaterialOfTheFaceBelow)
{
    const std::array<double, 3> weights = {0.45, 0.3, 0.25};
    const Layers layers(kLower);
    const Eigen::VectorXd u = layers.some_velocity();
    for (int turn = 0; turn < 3; ++turn) {
        const ClothPointPair pair = over_face(kUpper, kBelow, weights, turn);
        EXPECT_LT((layers.slip(pair, u) - layers.expected(pair, u, stretched(kShare))).norm(), kRoundOff)
            << "corner " << turn << " first";
    }
}

TEST(FrictionPairs, MaterialThatFlowsThroughAVertexSlipsByItsMeanFlow)
{
    const std::array<double, 3> weights = {0.45, 0.3, 0.25};
    const Layers layers(kUpper);
    const Eigen::VectorXd u = layers.some_velocity();
    const Mat32 mean = stretched(0.5 * (1.0 + kShare));  // faces with x < 0 and those with x > 0
    for (int turn = 0; turn < 3; ++turn) {
        const ClothPointPair pair = over_face(kUpper, kBelow, weights, turn);
        EXPECT_LT((layers.slip(pair, u) - layers.expected(pair, u, mean)).norm(), kRoundOff)
            << "corner " << turn << " first";
    }
}

TEST(FrictionPairs, CrossingEdgesSlipByTheMaterialOfTheFacesBesideThem)
{
    for (const int flowing : {kLower, kUpper}) {
        const Layers layers(flowing);
        const Eigen::VectorXd u = layers.some_velocity();
        // Both faces at the edge from the middle to x < 0 are compressed.
        const ClothPointPair pair = {
            SelfContactKind::EdgeEdge, {kUpper, kUpper + 2, kLower, kLower + 2}, {0.7, 0.3, -0.4, -0.6}};
        EXPECT_LT((layers.slip(pair, u) - layers.expected(pair, u, stretched(kShare))).norm(), kRoundOff)
            << "vertex " << flowing;
    }
}

}  // namespace
}  // namespace arris
