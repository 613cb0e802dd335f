// SPDX-License-Identifier: GPL-3.0-or-later
// One harness tests every term: a new term is one line in a table below.
#include "physics/elements/term.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <random>

#include "physics/system/linear_system.h"

#include "physics/forces/bending.h"
#include "physics/forces/gravity_force.h"
#include "physics/forces/inertia.h"
#include "physics/forces/membrane.h"
#include "physics/forces/wind_force.h"

namespace arris {
namespace {

constexpr double kStep = 1e-6;         // step of central differences; positions and sizes are about 1
constexpr double kFdTolerance = 2e-8;  // truncation h^2 f''' and round-off eps / h, relative to stiffness
constexpr double kRoundOff = 1e-12;

using Generator = std::mt19937_64;

double uniform(Generator& random, double low, double high)
{
    return std::uniform_real_distribution<double>(low, high)(random);
}

Vec3 random_vector(Generator& random, double size)
{
    return Vec3(uniform(random, -size, size), uniform(random, -size, size), uniform(random, -size, size));
}

Mat3 random_rotation(Generator& random)
{
    return Eigen::Quaterniond(Eigen::Vector4d(uniform(random, -1, 1), uniform(random, -1, 1),
                                              uniform(random, -1, 1), uniform(random, -1, 1))
                                  .normalized())
        .toRotationMatrix();
}

/// One element in a mesh of its own, for evaluating a term's energy, force and matrices.
template <int N>
struct Element;

template <>
struct Element<3> {
    static constexpr int kCorners = 3;
    using Term = FaceTerm;
    using State = FaceState;
    static FaceElement make(Generator& random)
    {
        ClothMesh mesh;
        do {
            mesh.material = {Vec2(uniform(random, -1, 1), uniform(random, -1, 1)),
                             Vec2(uniform(random, -1, 1), uniform(random, -1, 1)),
                             Vec2(uniform(random, -1, 1), uniform(random, -1, 1))};
        } while (twice_area(mesh.material[0], mesh.material[1], mesh.material[2]) < 0.3);
        mesh.world.resize(3);
        mesh.faces = {Face{0, 1, 2}};
        return make_elements(mesh, make_topology(3, mesh.faces)).faces[0];
    }
    /// World positions in the shape of the material.
    static std::vector<Vec3> rest(const FaceElement& face)
    {
        // x_0 = 0 and gradients g: x_i = X_i - X_0 solves g_j . (X_i - X_0) = delta_ij for i, j in {1, 2}.
        Mat2 inverse;
        inverse.row(0) = face.gradients[1].transpose();
        inverse.row(1) = face.gradients[2].transpose();
        const Mat2 edges = inverse.inverse();
        return {Vec3::Zero(), Vec3(edges(0, 0), edges(1, 0), 0), Vec3(edges(0, 1), edges(1, 1), 0)};
    }
};

template <>
struct Element<4> {
    static constexpr int kCorners = 4;
    using Term = HingeTerm;
    using State = HingeState;
    static HingeElement make(Generator& random) { return {{0, 1, 2, 3}, {0, 1}, uniform(random, 1.0, 5.0)}; }
    static std::vector<Vec3> rest(const HingeElement&)
    {
        return {Vec3(0, -0.5, 0), Vec3(0, 0.5, 0), Vec3(-0.8, 0.1, 0), Vec3(0.9, -0.2, 0)};
    }
};

/// Linearisation with gamma = 1 at rest, so that rhs = force and matrix = mass + stiffness + viscosity.
template <int N>
Linearization make_linearization(const std::vector<Vec3>& position)
{
    Linearization at;
    at.gamma = 1.0;
    at.position = position;
    at.v_predicted = at.v_expansion = at.v_last = at.drift = std::vector<Vec3>(N, Vec3::Zero());
    return at;
}

template <int N>
struct Evaluation {
    Eigen::Matrix<double, 3 * N, 1> rhs;
    Eigen::Matrix<double, 3 * N, 3 * N> matrix;
};

template <int N, typename Term, typename ElementType>
Evaluation<N> evaluate(const Term& term, const ElementType& element, const Linearization& at)
{
    std::array<int, N> vertices;
    for (int i = 0; i < N; ++i) vertices[i] = i;
    LocalSystem<N> local(at, vertices);
    term.add(typename Element<N>::State(element, at.position), local);
    Evaluation<N> result;
    for (int i = 0; i < N; ++i) {
        result.rhs.template segment<3>(3 * i) = local.rhs(i);
        for (int j = 0; j <= i; ++j) {
            result.matrix.template block<3, 3>(3 * i, 3 * j) = local.matrix(i, j);
            result.matrix.template block<3, 3>(3 * j, 3 * i) = local.matrix(i, j).transpose();
        }
    }
    return result;
}

/// An element from the material coordinates of its corners, with F at each corner.
template <int N>
struct ElementAt;

template <>
struct ElementAt<3> {
    FaceElement face;
    std::vector<Vec3> x;
    std::array<Mat32, 3> deformation;

    ElementAt(const std::vector<Vec3>& world, const std::vector<Vec2>& material)
        : face(make_face_element(material, {0, 1, 2})), x(world)
    {
        deformation.fill(FaceState(face, x).F);
    }
    const FaceElement& element() const { return face; }
    FaceState state() const { return FaceState(face, x); }
    static std::vector<Vec2> make_material(Generator& random)
    {
        std::vector<Vec2> X;
        do {
            X.clear();
            for (int i = 0; i < 3; ++i) X.emplace_back(uniform(random, -1, 1), uniform(random, -1, 1));
        } while (twice_area(X[0], X[1], X[2]) < 0.3);
        return X;
    }
};

template <>
struct ElementAt<4> {
    FaceElement c, d;
    HingeElement hinge;
    std::vector<Vec3> x;
    HingeWeightGradients weight_gradients;
    std::array<Mat32, 4> deformation;

    ElementAt(const std::vector<Vec3>& world, const std::vector<Vec2>& material, double crease_width = 0.0)
        : c(make_face_element(material, {0, 1, 2})),
          d(make_face_element(material, {1, 0, 3})),
          hinge{{0, 1, 2, 3}, {0, 1}, 0.0, crease_width},
          x(world),
          weight_gradients(compute_hinge_weight_gradients(material, hinge, c, d))
    {
        set_hinge(material, c, d, hinge);
        const Mat32 F_c = FaceState(c, x).F, F_d = FaceState(d, x).F;
        deformation = {0.5 * (F_c + F_d), 0.5 * (F_c + F_d), F_c, F_d};
    }
    const HingeElement& element() const { return hinge; }
    Vec2 weight_gradient(int i) const
    {
        return weight_gradients.by_area[0][i] + weight_gradients.by_area[1][i] + weight_gradients.by_edge[i];
    }
    HingeState state() const
    {
        HingeState state(hinge, x);
        state.weight_gradients = weight_gradients;
        return state;
    }
    static std::vector<Vec2> make_material(Generator& random)
    {
        std::vector<Vec2> X = {Vec2(0, -0.5), Vec2(0, 0.5), Vec2(-0.8, 0.1), Vec2(0.9, -0.2)};
        for (Vec2& p : X) p += Vec2(uniform(random, -0.3, 0.3), uniform(random, -0.3, 0.3));
        return X;
    }
};

/// Shapes for which a term must stay finite; for smooth shapes (`is_smooth`) differences are meaningful.
struct Shape {
    const char* name;
    bool is_smooth;
    std::function<void(Generator&, std::vector<Vec3>&)> deform;
};

const std::vector<Shape> kShapes = {
    {"rest", true, [](Generator&, auto&) {}},
    {"noise 1e-3", true,
     [](Generator& g, auto& x) {
         for (Vec3& p : x) p += random_vector(g, 1e-3);
     }},
    {"noise 0.2", true,
     [](Generator& g, auto& x) {
         for (Vec3& p : x) p += random_vector(g, 0.2);
     }},
    {"stretched 3 x", true,
     [](Generator& g, auto& x) {
         for (Vec3& p : x) p = 3.0 * p + random_vector(g, 0.1);
     }},
    {"compressed 0.5 x", true,
     [](Generator& g, auto& x) {
         for (Vec3& p : x) p = 0.5 * p + random_vector(g, 0.02);
     }},
    {"compressed along one direction", true,
     [](Generator& g, auto& x) {
         for (Vec3& p : x) {
             p.x() *= 0.4;
             p += random_vector(g, 0.01);
         }
     }},
    {"far from the origin", false,
     [](Generator&, auto& x) {
         for (Vec3& p : x) p += Vec3(1e6, -1e6, 1e6);
     }},
    {"huge", false,
     [](Generator&, auto& x) {
         for (Vec3& p : x) p *= 1e6;
     }},
    {"tiny", false,
     [](Generator&, auto& x) {
         for (Vec3& p : x) p *= 1e-6;
     }},
    {"collapsed to a line", false,
     [](Generator&, auto& x) {
         for (Vec3& p : x) p.x() = p.z() = 0.0;
     }},
    {"collapsed to a point", false,
     [](Generator&, auto& x) {
         for (Vec3& p : x) p.setZero();
     }},
    {"sliver", false,
     [](Generator&, auto& x) {
         for (Vec3& p : x) p.x() *= 1e-9;
     }},
    {"turned over", false,
     [](Generator&, auto& x) {
         for (Vec3& p : x) p.x() = -p.x();
     }},
};

enum class Stiffness { Exact, GaussNewton };

template <int N>
struct Case {
    const char* name;
    std::shared_ptr<typename Element<N>::Term> term;
    Stiffness stiffness;
    bool is_invariant;  ///< under rigid motion; net force and torque are then zero

    friend void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }
};

const std::vector<Case<3>> kFaceTerms = {
    {"membrane", std::make_shared<Membrane>(Material{0.0, 500.0, 0.3}), Stiffness::Exact, true},
    {"membrane, nu 0", std::make_shared<Membrane>(Material{0.0, 50.0, 0.0}), Stiffness::Exact, true},
    {"membrane, nu 0.49", std::make_shared<Membrane>(Material{0.0, 2e5, 0.49}), Stiffness::Exact, true},
    {"membrane, nu -0.5", std::make_shared<Membrane>(Material{0.0, 500.0, -0.5}), Stiffness::Exact, true},
    {"gravity", std::make_shared<GravityForce>(Material{0.15}, Gravity{}), Stiffness::Exact, false},
};

const std::vector<Case<4>> kHingeTerms = {
    {"bending", std::make_shared<Bending>(std::vector<double>{1e-2}), Stiffness::GaussNewton, true},
};

template <int N, typename Visit>
void for_each_state(const Visit& visit)
{
    for (const Shape& shape : kShapes) {
        Generator random(7);
        for (int k = 0; k < 50; ++k) {
            const auto element = Element<N>::make(random);
            std::vector<Vec3> x = Element<N>::rest(element);
            shape.deform(random, x);
            const Mat3 rotation = random_rotation(random);
            for (Vec3& p : x) p = rotation * p;
            SCOPED_TRACE(std::string(shape.name) + ", state " + std::to_string(k));
            visit(shape, element, x, random);
        }
    }
}

template <int N>
void expect_force_is_minus_the_gradient(const Case<N>& c)
{
    for_each_state<N>([&](const Shape& shape, const auto& element, std::vector<Vec3> x, Generator&) {
        const auto at = make_linearization<N>(x);
        const Evaluation<N> analytic = evaluate<N>(*c.term, element, at);
        ASSERT_TRUE(analytic.rhs.allFinite());
        if (!shape.is_smooth) return;
        const double scale = analytic.matrix.norm() + analytic.rhs.norm();
        for (int i = 0; i < 3 * N; ++i) {
            const auto energy_at = [&](double offset) {
                std::vector<Vec3> moved = x;
                moved[i / 3][i % 3] += offset;
                return c.term->energy(typename Element<N>::State(element, moved));
            };
            const double difference = -(energy_at(kStep) - energy_at(-kStep)) / (2 * kStep);
            EXPECT_NEAR(analytic.rhs[i], difference, kFdTolerance * scale) << "coordinate " << i;
        }
    });
}

template <int N>
void expect_stiffness_is_the_projected_hessian(const Case<N>& c)
{
    using Matrix = Eigen::Matrix<double, 3 * N, 3 * N>;
    for_each_state<N>([&](const Shape& shape, const auto& element, std::vector<Vec3> x, Generator&) {
        const Evaluation<N> analytic = evaluate<N>(*c.term, element, make_linearization<N>(x));
        ASSERT_TRUE(analytic.matrix.allFinite());
        const double size = analytic.matrix.norm();
        const double least = Eigen::SelfAdjointEigenSolver<Matrix>(analytic.matrix).eigenvalues()[0];
        EXPECT_GE(least, -kRoundOff * size) << "stiffness is positive semi-definite";
        if (!shape.is_smooth || c.stiffness != Stiffness::Exact) return;

        Matrix hessian;
        for (int i = 0; i < 3 * N; ++i) {
            const auto force_at = [&](double offset) {
                std::vector<Vec3> moved = x;
                moved[i / 3][i % 3] += offset;
                return evaluate<N>(*c.term, element, make_linearization<N>(moved)).rhs;
            };
            hessian.col(i) = -(force_at(kStep) - force_at(-kStep)) / (2 * kStep);
        }
        EXPECT_LT((hessian - hessian.transpose()).norm(), kFdTolerance * (size + 1.0));
        // Projection only removes negative eigenvalues, those of the element in its deformation gradient.
        // Without such eigenvalues the matrix equals the Hessian; otherwise it is larger. (The corners'
        // matrix is not the projection of the corners' Hessian.)
        const Matrix symmetric = 0.5 * (hessian + hessian.transpose());
        const Matrix difference = analytic.matrix - symmetric;
        const double tolerance = 10 * kFdTolerance * (size + 1.0);
        EXPECT_GE(Eigen::SelfAdjointEigenSolver<Matrix>(difference).eigenvalues()[0], -tolerance);
        if (Eigen::SelfAdjointEigenSolver<Matrix>(symmetric).eigenvalues()[0] > -tolerance) {
            EXPECT_LT(difference.norm(), tolerance);
        }
    });
}

template <int N>
void expect_rigid_invariance(const Case<N>& c)
{
    for_each_state<N>([&](const Shape&, const auto& element, std::vector<Vec3> x, Generator& random) {
        if (!c.is_invariant) return;
        double extent = 0.0;
        for (const Vec3& p : x) extent = std::max(extent, p.norm());
        const Evaluation<N> here = evaluate<N>(*c.term, element, make_linearization<N>(x));
        Vec3 net = Vec3::Zero(), torque = Vec3::Zero();
        for (int i = 0; i < N; ++i) {
            net += here.rhs.template segment<3>(3 * i);
            torque += (x[i] - x[0]).cross(here.rhs.template segment<3>(3 * i));
        }
        // The round-off of forces is that of positions multiplied by the stiffness.
        const double force_scale = here.rhs.norm() + here.matrix.norm() * extent;
        EXPECT_LE(net.norm(), kRoundOff * force_scale);
        EXPECT_LE(torque.norm(), kRoundOff * force_scale * extent);

        const Mat3 rotation = random_rotation(random);
        std::vector<Vec3> moved = x;
        for (Vec3& p : moved) p = rotation * p;
        const double energy = c.term->energy(typename Element<N>::State(element, x));
        const double same = c.term->energy(typename Element<N>::State(element, moved));
        EXPECT_NEAR(energy, same, 1e-9 * std::abs(energy) + 1e-12 * here.matrix.norm() * extent * extent);
    });
}

/// Force on the material coordinates of an element's corners, by the system's own reduction: V' = (u_1, u_2),
/// v' = 0, so that rhs_i = E^T f_X.
template <int N>
std::array<Vec2, N> material_forces(const typename Element<N>::Term& term, const std::vector<Vec3>& x,
                                    const std::vector<Vec2>& X)
{
    const ElementAt<N> element(x, X);
    Linearization at = make_linearization<N>(x);
    at.flow.emplace();
    at.flow->v_predicted = at.flow->v_expansion = at.flow->v_last = std::vector<Vec2>(N, Vec2::Zero());
    std::array<int, N> vertices;
    std::array<const Mat3*, N> bases;
    std::array<const Mat23*, N> material_bases;
    std::array<Vec2, N> forces;
    const Mat3 none = Mat3::Zero();
    Mat23 both;
    both << 1, 0, 0, 0, 1, 0;
    for (int i = 0; i < N; ++i) {
        vertices[i] = i;
        bases[i] = &none;
        material_bases[i] = &both;
    }
    LocalSystem<N> local(at, vertices, vertices, 0, element.deformation);
    term.add(element.state(), local);
    local.reduce_eulerian(bases, material_bases);
    for (int i = 0; i < N; ++i) forces[i] = local.rhs(i).template head<2>();
    return forces;
}

/// Calls for the states of for_each_state, with the material coordinates of the element.
template <int N, typename Visit>
void for_each_material_state(const Visit& visit)
{
    for (const Shape& shape : kShapes) {
        Generator random(13);
        for (int k = 0; k < 50; ++k) {
            const std::vector<Vec2> X = ElementAt<N>::make_material(random);
            std::vector<Vec3> x;
            for (const Vec2& p : X) x.emplace_back(p.x(), p.y(), 0.0);
            shape.deform(random, x);
            SCOPED_TRACE(std::string(shape.name) + ", state " + std::to_string(k));
            visit(shape, x, X);
        }
    }
}

template <int N>
void expect_material_force_is_minus_the_gradient(const Case<N>& c)
{
    for_each_material_state<N>(
        [&](const Shape& shape, const std::vector<Vec3>& x, const std::vector<Vec2>& X) {
            const std::array<Vec2, N> analytic = material_forces<N>(*c.term, x, X);
            for (const Vec2& force : analytic) ASSERT_TRUE(force.allFinite());
            if (!shape.is_smooth) return;
            const double energy = c.term->energy(ElementAt<N>(x, X).state());
            double scale =
                evaluate<N>(*c.term, ElementAt<N>(x, X).element(), make_linearization<N>(x)).matrix.norm();
            scale += std::abs(energy);
            for (const Vec2& force : analytic) scale += force.norm();
            for (int i = 0; i < 2 * N; ++i) {
                const auto energy_at = [&](double offset) {
                    std::vector<Vec2> moved = X;
                    moved[i / 2][i % 2] += offset;
                    return c.term->energy(ElementAt<N>(x, moved).state());
                };
                const double difference = -(energy_at(kStep) - energy_at(-kStep)) / (2 * kStep);
                EXPECT_NEAR(analytic[i / 2][i % 2], difference, kFdTolerance * scale) << "coordinate " << i;
            }
        });
}

template <int N>
void expect_material_invariance(const Case<N>& c)
{
    for_each_material_state<N>([&](const Shape&, const std::vector<Vec3>& x, const std::vector<Vec2>& X) {
        // The cloth is homogeneous and isotropic: net force and torque on the material vanish, and rotating x
        // changes nothing.
        const std::array<Vec2, N> here = material_forces<N>(*c.term, x, X);
        Vec2 net = Vec2::Zero();
        double torque = 0.0, size = 0.0;
        for (int i = 0; i < N; ++i) {
            net += here[i];
            torque += (X[i] - X[0]).x() * here[i].y() - (X[i] - X[0]).y() * here[i].x();
            size += here[i].norm();
        }
        // For distant or huge x, f_X is a difference of F^T f_x, and F contains the round-off of positions.
        double extent = 1.0;
        for (const Vec3& p : x) extent = std::max(extent, p.norm());
        const Evaluation<N> world =
            evaluate<N>(*c.term, ElementAt<N>(x, X).element(), make_linearization<N>(x));
        size += (world.rhs.norm() + world.matrix.norm()) * extent;
        EXPECT_LE(net.norm(), kRoundOff * size);
        EXPECT_LE(std::abs(torque), kRoundOff * size);

        Generator random(17);
        const Mat3 rotation = random_rotation(random);
        std::vector<Vec3> rotated = x;
        for (Vec3& p : rotated) p = rotation * p;
        const std::array<Vec2, N> same = material_forces<N>(*c.term, rotated, X);
        for (int i = 0; i < N; ++i) EXPECT_LE((same[i] - here[i]).norm(), 1e-9 * size * extent);
    });
}

class FaceTerms : public testing::TestWithParam<Case<3>> {};
TEST_P(FaceTerms, ForceIsMinusTheGradient)
{
    expect_force_is_minus_the_gradient(GetParam());
}
TEST_P(FaceTerms, StiffnessIsTheProjectedHessian)
{
    expect_stiffness_is_the_projected_hessian(GetParam());
}
TEST_P(FaceTerms, RigidMotionChangesNothing)
{
    expect_rigid_invariance(GetParam());
}
TEST_P(FaceTerms, MaterialForceIsMinusTheGradient)
{
    // Other terms are loads on the material; their energy is that of the whole sheet.
    if (GetParam().term->is_elastic()) expect_material_force_is_minus_the_gradient(GetParam());
}
TEST_P(FaceTerms, MaterialForcesBalance)
{
    if (GetParam().term->is_elastic()) expect_material_invariance(GetParam());
}
INSTANTIATE_TEST_SUITE_P(All, FaceTerms, testing::ValuesIn(kFaceTerms),
                         [](const auto& i) { return "n" + std::to_string(i.index); });

class HingeTerms : public testing::TestWithParam<Case<4>> {};
TEST_P(HingeTerms, ForceIsMinusTheGradient)
{
    expect_force_is_minus_the_gradient(GetParam());
}
TEST_P(HingeTerms, StiffnessIsTheProjectedHessian)
{
    expect_stiffness_is_the_projected_hessian(GetParam());
}
TEST_P(HingeTerms, RigidMotionChangesNothing)
{
    expect_rigid_invariance(GetParam());
}
TEST_P(HingeTerms, MaterialForceIsMinusTheGradient)
{
    expect_material_force_is_minus_the_gradient(GetParam());
}
TEST_P(HingeTerms, MaterialForcesBalance)
{
    expect_material_invariance(GetParam());
}
INSTANTIATE_TEST_SUITE_P(All, HingeTerms, testing::ValuesIn(kHingeTerms),
                         [](const auto& i) { return "n" + std::to_string(i.index); });

TEST(Bending, StiffnessIsGaussNewtonInTheSineOfHalfTheAngle)
{
    Generator random(11);
    const double K = 0.7;
    const Bending bending({K});
    for (const double degrees : {0.0, 1e-6, 10.0, 90.0, 150.0, 179.0, 179.999, 180.0}) {
        const HingeElement hinge = Element<4>::make(random);
        std::vector<Vec3> x = Element<4>::rest(hinge);
        x[3] = Eigen::AngleAxisd(degrees * M_PI / 180.0, Vec3::UnitY()) * x[3];
        const Evaluation<4> analytic = evaluate<4>(bending, hinge, make_linearization<4>(x));

        // V = K w s^2, so grad s = grad V / (2 K w s) and the stiffness is 2 K w grad s grad s^T.
        const double sine = std::sqrt(bending.energy(HingeState(hinge, x)) / (K * hinge.weight));
        EXPECT_NEAR(sine, std::sin(degrees * M_PI / 360.0), 1e-12);
        if (sine < 1e-3) continue;
        const Eigen::Matrix<double, 12, 1> gradient = -analytic.rhs / (2 * K * hinge.weight * sine);
        EXPECT_LT((analytic.matrix - 2 * K * hinge.weight * gradient * gradient.transpose()).norm(),
                  1e-9 * (1.0 + analytic.matrix.norm()))
            << degrees;
    }
}

constexpr double kCreaseWidth = 0.7;  // m

/// A crease in the shape of make_material, folded by `degrees` about its edge.
ElementAt<4> folded_crease(double degrees, std::vector<Vec2> X)
{
    std::vector<Vec3> x;
    for (const Vec2& p : X) x.emplace_back(p.x(), p.y(), 0.0);
    const Vec3 axis = (x[1] - x[0]).normalized();
    x[3] = x[0] + Eigen::AngleAxisd(degrees * M_PI / 180.0, axis) * (x[3] - x[0]);
    return {x, X, kCreaseWidth};
}

TEST(Bending, ACreaseForcesAreMinusTheGradientsOfItsEnergy)
{
    constexpr double kTolerance = 1e-8;  // of central differences
    Generator random(21);
    const Bending bending({0.7});
    for (const double degrees : {0.0, 1.0, 30.0, 59.0, 61.0, 90.0, 170.0}) {
        const std::vector<Vec2> X = ElementAt<4>::make_material(random);
        const ElementAt<4> crease = folded_crease(degrees, X);
        const Evaluation<4> analytic = evaluate<4>(bending, crease.hinge, make_linearization<4>(crease.x));
        const auto energy_at = [&](const std::vector<Vec3>& x, const std::vector<Vec2>& material) {
            return bending.energy(ElementAt<4>(x, material, kCreaseWidth).state());
        };
        for (int i = 0; i < 12; ++i) {
            std::vector<Vec3> more = crease.x, less = crease.x;
            more[i / 3][i % 3] += kStep;
            less[i / 3][i % 3] -= kStep;
            const double difference = -(energy_at(more, X) - energy_at(less, X)) / (2.0 * kStep);
            EXPECT_NEAR(analytic.rhs[i], difference, kTolerance) << degrees << " degrees, coordinate " << i;
        }
        for (int i = 0; i < 8; ++i) {
            std::vector<Vec2> more = X, less = X;
            more[i / 2][i % 2] += kStep;
            less[i / 2][i % 2] -= kStep;
            const double derivative = (ElementAt<4>(crease.x, more, kCreaseWidth).hinge.weight -
                                       ElementAt<4>(crease.x, less, kCreaseWidth).hinge.weight) /
                                      (2.0 * kStep);
            EXPECT_NEAR(crease.weight_gradient(i / 2)[i % 2], derivative, kTolerance);
        }
    }
}

TEST(Bending, ACreaseFoldedFarExertsNoForceAndAShallowOneThatOfAHingeOfItsWidth)
{
    const Bending bending({0.7});
    Generator random(22);
    const std::vector<Vec2> X = ElementAt<4>::make_material(random);
    for (const double degrees : {60.001, 90.0, 179.0}) {
        const ElementAt<4> crease = folded_crease(degrees, X);
        const Evaluation<4> result = evaluate<4>(bending, crease.hinge, make_linearization<4>(crease.x));
        EXPECT_EQ(result.rhs.norm(), 0.0) << degrees;
        EXPECT_EQ(result.matrix.norm(), 0.0) << degrees;
    }
    const ElementAt<4> shallow = folded_crease(1.0, X);
    const double sine = std::sin(M_PI / 360.0);
    const double length = (X[1] - X[0]).norm();
    constexpr double kSmallAngle = 2e-4;  // small-angle error: sigma / 2 sigma_0 at one degree
    EXPECT_NEAR(bending.energy(shallow.state()) / (0.7 * 3.0 * length / kCreaseWidth * sine * sine), 1.0,
                kSmallAngle);
}

TEST(Bending, AFoldOnACreaseDoesNoWorkOnMaterialThatFlowsAcrossIt)
{
    // The energy of a crease does not depend on the widths of the faces beside it.
    const Bending bending({0.7});
    Generator random(23);
    const std::vector<Vec2> X = ElementAt<4>::make_material(random);
    const ElementAt<4> crease = folded_crease(50.0, X);
    const Vec2 along = (X[1] - X[0]).normalized();
    const Vec2 across(-along.y(), along.x());
    for (int i = 0; i < 4; ++i)
        EXPECT_NEAR(crease.weight_gradient(i).dot(across), 0.0, 1e-15 * crease.hinge.weight);
    std::vector<Vec2> wider = X;
    wider[2] += 0.1 * across;
    EXPECT_EQ(folded_crease(50.0, wider).hinge.weight, crease.hinge.weight);
}

TEST(Membrane, UniformStretchAnswersWithEPerWidth)
{
    // With stretch e along u and free sides, the force per width is E e to first order.
    const double E = 500.0, nu = 0.3;
    for (const double e : {1e-3, 1e-5, 1e-7}) {
        ClothMesh mesh;
        mesh.material = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
        mesh.faces = {Face{0, 1, 2}, Face{0, 2, 3}};
        for (const Vec2& X : mesh.material)
            mesh.world.emplace_back(X.x() * (1 + e), X.y() * (1 - nu * e), 0.0);
        const ClothElements elements = make_elements(mesh, make_topology(4, mesh.faces));
        Terms terms;
        terms.faces.push_back(std::make_unique<Membrane>(Material{0.0, E, nu}));
        Linearization at = make_linearization<4>(mesh.world);
        at.basis.assign(4, Mat3::Identity());
        at.has_basis.assign(4, 0);
        LinearSystem system;
        system.make_pattern(elements);
        system.assemble(mesh, elements, terms, at);
        // Force on the two vertices at u = 1; the width is 1 m.
        const double force = -(system.rhs()[3] + system.rhs()[6]);
        EXPECT_NEAR(force / (E * e), 1.0, 2 * e + 1e-9 / e * 1e-6);
        EXPECT_NEAR(system.rhs()[4], 0.0, 2 * E * e * e + 1e-12) << "the sides are free";
    }
}

TEST(WindForce, DragsAStillPlateAsTheFormulaSays)
{
    Wind wind;
    wind.velocity = Vec3(3.0, 0.0, 4.0);
    const WindForce force(wind);
    Generator random(3);
    const FaceElement face = Element<3>::make(random);
    const std::vector<Vec3> x = Element<3>::rest(face);
    const Evaluation<3> result = evaluate<3>(force, face, make_linearization<3>(x));
    const Vec3 total = result.rhs.segment<3>(0) + result.rhs.segment<3>(3) + result.rhs.segment<3>(6);
    EXPECT_LT((total - 0.5 * 1.2 * 1.0 * face.area * 4.0 * 4.0 * Vec3::UnitZ()).norm(), 1e-12);
}

TEST(WindForce, ViscosityIsMinusTheDerivativeByVelocity)
{
    Wind wind;
    wind.velocity = Vec3(3.0, 1.0, -4.0);
    const WindForce force(wind);
    Generator random(5);
    for (int k = 0; k < 50; ++k) {
        const FaceElement face = Element<3>::make(random);
        Linearization at = make_linearization<3>(Element<3>::rest(face));
        for (Vec3& v : at.v_last) v = random_vector(random, 10.0);
        for (Vec3& p : at.position) p += random_vector(random, 0.1);
        const auto force_at = [&](int i, double offset) {
            Linearization moved = at;
            moved.v_last[i / 3][i % 3] += offset;
            const Evaluation<3> result = evaluate<3>(force, face, moved);
            Eigen::Matrix<double, 9, 1> v;
            for (int c = 0; c < 3; ++c) v.segment<3>(3 * c) = moved.v_last[c];
            return Eigen::Matrix<double, 9, 1>(result.rhs - result.matrix * v);  // rhs = f + D v_k
        };
        const Evaluation<3> analytic = evaluate<3>(force, face, at);
        for (int i = 0; i < 9; ++i) {
            const Eigen::Matrix<double, 9, 1> difference =
                -(force_at(i, kStep) - force_at(i, -kStep)) / (2 * kStep);
            EXPECT_LT((difference - analytic.matrix.col(i)).norm(), 1e-7 * (1.0 + analytic.matrix.norm()));
        }
        using Matrix9 = Eigen::Matrix<double, 9, 9>;
        EXPECT_GE(Eigen::SelfAdjointEigenSolver<Matrix9>(analytic.matrix).eigenvalues()[0], -1e-12);
    }
}

TEST(WindForce, AGustIsASineWhosePhaseComesFromItsSeed)
{
    Wind wind;
    wind.velocity = Vec3(2.0, 0.0, 0.0);
    wind.gust = Gust{0.3, 0.5, 7};
    double least = 1e9, greatest = -1e9;
    for (int k = 0; k <= 200; ++k) {
        const double speed = WindForce(wind).velocity_at(0.01 * k).x();
        least = std::min(least, speed);
        greatest = std::max(greatest, speed);
    }
    EXPECT_NEAR(least, 1.4, 1e-3);
    EXPECT_NEAR(greatest, 2.6, 1e-3);
    Wind other = wind;
    other.gust->seed = 8;
    EXPECT_NE(WindForce(wind).velocity_at(0.3).x(), WindForce(other).velocity_at(0.3).x());
}

TEST(Inertia, IsTheReportsElementMatrix)
{
    // rho A / 12 [2 I, I, I; I, 2 I, I; I, I, 2 I]
    Generator random(1);
    const FaceElement face = Element<3>::make(random);
    const Evaluation<3> result =
        evaluate<3>(Inertia(Material{0.15}), face, make_linearization<3>(std::vector<Vec3>(3, Vec3::Zero())));
    for (int i = 0; i < 9; ++i)
        for (int j = 0; j < 9; ++j) {
            const double expected = i % 3 != j % 3 ? 0.0 : 0.15 * face.area / 12.0 * (i == j ? 2.0 : 1.0);
            EXPECT_NEAR(result.matrix(i, j), expected, 1e-17);
        }
}

}  // namespace
}  // namespace arris
