// SPDX-License-Identifier: GPL-3.0-or-later
// The assembled system: its mass is the cloth's, and its matrix is symmetric positive definite in any state
// of the cloth.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "cloth_run.h"
#include "grid_patterns.h"
#include "physics/forces/inertia.h"
#include "physics/forces/make_terms.h"

namespace arris {
namespace {

constexpr double kRoundOff = 1e-13;

using Generator = std::mt19937_64;

Linearization at_rest(const ClothMesh& mesh, double dt)
{
    const std::size_t n = mesh.world.size();
    Linearization at;
    at.gamma = at.time = dt;
    at.position = mesh.world;
    at.v_predicted = at.v_expansion = at.v_last = at.drift = std::vector<Vec3>(n, Vec3::Zero());
    at.basis.assign(n, Mat3::Identity());
    at.has_basis.assign(n, 0);
    return at;
}

struct Assembled {
    Eigen::MatrixXd matrix;
    Eigen::VectorXd rhs;
    double asymmetry;  ///< of the diagonal blocks, which are stored in full
};

Assembled assemble(const ClothMesh& mesh, const Terms& terms, const Linearization& at)
{
    const ClothElements elements = make_elements(mesh, make_topology(mesh.vertex_count(), mesh.faces));
    LinearSystem system;
    system.make_pattern(elements);
    system.assemble(mesh, elements, terms, at);
    const Eigen::MatrixXd stored = system.matrix();
    Assembled result{stored.selfadjointView<Eigen::Lower>(), system.rhs(), 0.0};
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Mat3 block = stored.block<3, 3>(3 * v, 3 * v);
        result.asymmetry = std::max(result.asymmetry, (block - block.transpose()).norm() / block.norm());
    }
    return result;
}

/// Mass matrix of the assembled system: inertia is the only term.
Eigen::MatrixXd mass_matrix(const ClothMesh& mesh, double density)
{
    Terms terms;
    terms.faces.push_back(std::make_unique<Inertia>(Material{density}));
    return assemble(mesh, terms, at_rest(mesh, 0.01)).matrix;
}

Eigen::VectorXd stack(const std::vector<Vec3>& vectors)
{
    Eigen::VectorXd stacked(3 * vectors.size());
    for (std::size_t v = 0; v < vectors.size(); ++v)
        stacked.segment<3>(3 * static_cast<Eigen::Index>(v)) = vectors[v];
    return stacked;
}

TEST(Mass, OfARigidTranslationIsTheWholeCloths)
{
    const double density = 0.15, mass = density * 0.8 * 0.5;
    for (const GridPattern pattern : kPatterns) {
        const ClothMesh mesh = make_sheet(Vec2(0.8, 0.5), {7, 4}, pattern);
        const Eigen::MatrixXd M = mass_matrix(mesh, density);
        const Vec3 velocity(1.0, -2.0, 0.5);
        const Eigen::VectorXd v = stack(std::vector<Vec3>(mesh.world.size(), velocity));
        EXPECT_NEAR(0.5 * v.dot(M * v), 0.5 * mass * velocity.squaredNorm(), kRoundOff);
    }
}

TEST(Mass, OfARigidRotationIsThePlatesMomentOfInertia)
{
    // The velocity of a rotation is linear in space: consistent mass is exact for it on any mesh.
    const double density = 0.15, a = 0.8, b = 0.5, mass = density * a * b;
    for (const GridPattern pattern : kPatterns) {
        const ClothMesh mesh =
            make_sheet(Vec2(a, b), {7, 4}, pattern, pattern == GridPattern::Cross ? 17.0 : 0.0);
        const Eigen::MatrixXd M = mass_matrix(mesh, density);
        const std::array<Vec3, 3> principal = {Vec3(b * b, 0.0, 0.0), Vec3(0.0, a * a, 0.0),
                                               Vec3(0.0, 0.0, a * a + b * b)};
        for (int axis = 0; axis < 3; ++axis) {
            std::vector<Vec3> velocity;
            for (const Vec3& x : mesh.world)
                velocity.push_back(Vec3::Unit(axis).cross(x - Vec3(0.5 * a, 0.5 * b, 0.0)));
            const Eigen::VectorXd v = stack(velocity);
            EXPECT_NEAR(v.dot(M * v), mass * principal[axis][axis] / 12.0, kRoundOff);
            const ClothElements elements =
                make_elements(mesh, make_topology(mesh.vertex_count(), mesh.faces));
            EXPECT_NEAR(0.5 * v.dot(M * v), kinetic_energy(Material{density}, elements, velocity), kRoundOff);
            // About the origin L = I omega + m c x (omega x c); the sheet's centre does not move.
            EXPECT_NEAR(angular_momentum(Material{density}, elements, mesh.world, velocity)[axis],
                        mass * principal[axis][axis] / 12.0, kRoundOff);
        }
    }
}

struct Shape {
    const char* name;
    std::function<Vec3(const Vec3&, Generator&)> move;
};

Vec3 noise(Generator& random, double size)
{
    std::uniform_real_distribution<double> uniform(-size, size);
    return {uniform(random), uniform(random), uniform(random)};
}

const std::vector<Shape> kNastyShapes = {
    {"at rest", [](const Vec3& x, Generator&) { return x; }},
    {"collapsed to a point", [](const Vec3&, Generator&) -> Vec3 { return Vec3::Ones(); }},
    {"collapsed to a line",
     [](const Vec3& x, Generator&) -> Vec3 {
         return {x.x(), 0.0, 0.0};
     }},
    {"compressed to 1e-4", [](const Vec3& x, Generator&) -> Vec3 { return 1e-4 * x; }},
    {"compressed along u to 1e-4",
     [](const Vec3& x, Generator&) -> Vec3 {
         return {1e-4 * x.x(), x.y(), 0.0};
     }},
    {"stretched 1000 times", [](const Vec3& x, Generator&) -> Vec3 { return 1e3 * x; }},
    {"turned inside out",
     [](const Vec3& x, Generator&) -> Vec3 {
         return {-x.x(), x.y(), 0.0};
     }},
    {"folded flat onto itself",
     [](const Vec3& x, Generator&) -> Vec3 {
         return {std::abs(x.x() - 0.5), x.y(), 0.0};
     }},
    {"crumpled", [](const Vec3& x, Generator& g) -> Vec3 { return x + noise(g, 0.5); }},
    {"scattered", [](const Vec3&, Generator& g) -> Vec3 { return noise(g, 100.0); }},
    {"crumpled, far away",
     [](const Vec3& x, Generator& g) -> Vec3 { return x + noise(g, 0.5) + Vec3(1e6, -1e6, 1e6); }},
};

TEST(AssembledMatrix, IsSymmetricPositiveDefiniteWhateverTheClothLooksLike)
{
    Wind wind;
    wind.velocity = Vec3(3.0, 2.0, 1.0);
    for (const GridPattern pattern : kPatterns)
        for (const Shape& shape : kNastyShapes)
            for (const double modulus : {10.0, 1e6})
                for (const double dt : {1e-5, 5e-3, 1.0}) {
                    SCOPED_TRACE(testing::Message() << shape.name << ", E = " << modulus << ", dt = " << dt);
                    ClothMesh mesh = make_sheet(Vec2(1.0, 1.0), {4, 4}, pattern);
                    Generator random(1);
                    for (Vec3& x : mesh.world) x = shape.move(x, random);
                    Material material{0.05, modulus, 0.45, 1e-2, 0.01, 1e-3};
                    Linearization at = at_rest(mesh, dt);
                    at.damping = {material.damping};
                    for (Vec3& v : at.v_last) v = noise(random, 10.0);
                    const Assembled system = assemble(mesh, make_terms(material, Gravity{}, wind, {}), at);
                    ASSERT_TRUE(system.matrix.allFinite() && system.rhs.allFinite());
                    EXPECT_LT(system.asymmetry, 1e-12);
                    EXPECT_EQ(Eigen::LLT<Eigen::MatrixXd>(system.matrix).info(), Eigen::Success);

                    // The matrix less its mass must be positive semi-definite.
                    const Eigen::MatrixXd added = system.matrix - mass_matrix(mesh, material.density);
                    const double least =
                        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(added, Eigen::EigenvaluesOnly)
                            .eigenvalues()[0];
                    EXPECT_GT(least, -1e-12 * system.matrix.norm());
                }
}

TEST(AssembledForces, OfTheClothOnItselfBalance)
{
    for (const GridPattern pattern : kPatterns)
        for (const Shape& shape : kNastyShapes) {
            SCOPED_TRACE(shape.name);
            ClothMesh mesh = make_sheet(Vec2(1.0, 1.0), {5, 5}, pattern);
            Generator random(2);
            for (Vec3& x : mesh.world) x = shape.move(x, random);
            const Material material{0.05, 500.0, 0.3, 1e-2, 0.0, 1e-3};
            const Assembled system = assemble(mesh, make_terms(material, {}, {}, {}), at_rest(mesh, 1.0));
            Vec3 net = Vec3::Zero(), torque = Vec3::Zero();
            double size = 0.0, force_size = 0.0;
            for (int v = 0; v < mesh.vertex_count(); ++v) {
                const Vec3 force = system.rhs.segment<3>(3 * v), arm = mesh.world[v] - mesh.world[0];
                net += force;
                torque += arm.cross(force);
                size = std::max({size, arm.norm(), 1e-3});
                force_size += force.norm();
            }
            // Where forces vanish, only round-off of stiffness times size remains.
            const double scale = force_size + 1e-3 * system.matrix.norm() * size;
            EXPECT_LT(net.norm(), 1e-12 * scale);
            EXPECT_LT(torque.norm(), 1e-12 * scale * size);
        }
}

}  // namespace
}  // namespace arris
