// SPDX-License-Identifier: GPL-3.0-or-later
// Elements with EOL vertices in the assembled system: against matrices written out from the kinematics,
// against differences of energies in x and X, and their conditioning.
#include "physics/eulerian_element.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>

#include "geometry/cloth_grid.h"
#include "physics/bending.h"
#include "physics/energies.h"
#include "physics/gravity_force.h"
#include "physics/inertia.h"
#include "physics/linear_system.h"
#include "physics/membrane.h"
#include "physics/pull_force.h"
#include "physics/wind_force.h"
#include "sliding_cloth.h"

namespace arris {
namespace {

constexpr double kRoundOff = 1e-12;
constexpr double kStep = 1e-6;         // m, of central differences; the sheet is 1 m
constexpr double kFdTolerance = 1e-7;  // truncation and eps / h, relative to the forces' scale

using Generator = std::mt19937_64;

double uniform(Generator& random, double size)
{
    return std::uniform_real_distribution<double>(-size, size)(random);
}

Vec3 random3(Generator& random, double size)
{
    return {uniform(random, size), uniform(random, size), uniform(random, size)};
}

Vec2 random2(Generator& random, double size)
{
    return {uniform(random, size), uniform(random, size)};
}

Eigen::MatrixXd dense(const LinearSystem& system)
{
    const Eigen::MatrixXd lower = system.matrix();
    return lower.selfadjointView<Eigen::Lower>();
}

/// A crumpled sheet whose mesh follows no lines.
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

/// Everything of the linearisation random, one vertex in two EOL, the mesh at q^ and where it is extrapolated
/// to a little different.
Linearization random_linearization(const ClothMesh& mesh, unsigned seed)
{
    Generator random(seed);
    const int n = mesh.vertex_count();
    const double size = 0.01 / std::sqrt(n);
    Linearization at;
    at.time = at.gamma = 0.005;
    at.damping = 0.01;
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

struct Assembled {
    Eigen::MatrixXd matrix;
    Eigen::VectorXd rhs;
};

Assembled assemble(const ClothMesh& mesh, const Terms& terms, const Linearization& at)
{
    const ClothElements elements = make_elements(mesh, make_topology(mesh.vertex_count(), mesh.faces));
    LinearSystem system;
    system.make_pattern(elements);
    system.assemble(mesh, elements, terms, at);
    return {dense(system), system.rhs()};
}

Terms only(std::unique_ptr<const FaceTerm> term)
{
    Terms terms;
    terms.faces.push_back(std::move(term));
    return terms;
}

/// x and X of every vertex, five a vertex, from the three of u.
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
    // rho A / 12 [2I I I -2F -F -F; I 2I I -F -2F -F; ...; F^T F blocks alike], where it is extrapolated to.
    const double density = 0.15;
    for (const GridPattern pattern : {GridPattern::Diagonal, GridPattern::Cross}) {
        const ClothMesh mesh = crumpled_sheet({4, 3}, pattern, 1);
        Linearization at = random_linearization(mesh, 2);
        at.flow->extrapolated.velocity.assign(mesh.world.size(), Vec3(1, 2, 3));
        at.flow->extrapolated.material_velocity.assign(mesh.world.size(), Vec2::Zero());  // no 2 Fdot V
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
        const Assembled system = assemble(mesh, only(std::make_unique<Inertia>(density)), at);
        const Eigen::MatrixXd reduced = P.transpose() * M * P;
        EXPECT_LT((system.matrix - reduced).norm(), kRoundOff * reduced.norm());

        std::vector<Vec3> v = at.v_predicted;
        for (std::size_t k = 0; k < v.size(); ++k) v[k] -= at.drift[k];
        const Eigen::VectorXd rhs = P.transpose() * (M * stack(v, at.flow->v_predicted));
        EXPECT_LT((system.rhs - rhs).norm(), kRoundOff * rhs.norm());
    }
}

/// The element sum written once more, for matrices of faces alone: corner velocities as if they were
/// vertices', then G^T . G.
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

/// Drag in every direction: wind does not see how material flows, as that is along the face.
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
    loads.push_back(std::make_unique<GravityForce>(0.15, Gravity{}));
    loads.push_back(std::make_unique<Drag>());
    for (auto& term : loads) {
        // Only Lagrangian faces are taken at q^, and here every face has an EOL corner.
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
    const Assembled expected = sum_by_corners(mesh, Membrane(500.0, 0.3), at, at.position, at.flow->position);
    const Assembled system = assemble(mesh, only(std::make_unique<Membrane>(500.0, 0.3)), at);
    EXPECT_LT((system.matrix - expected.matrix).norm(), kRoundOff * expected.matrix.norm());

    // What the right-hand side has besides are the energies let into the faces: -gamma E^T sum V b_i.
    Eigen::VectorXd rhs = expected.rhs;
    for (const Face& face : mesh.faces) {
        const FaceElement element = make_face_element(at.flow->position, face);
        const double V = Membrane(500.0, 0.3).energy(FaceState(element, at.position));
        for (int i = 0; i < 3; ++i)
            rhs.segment<3>(3 * face[i]) -=
                at.gamma * V * (at.flow->basis[face[i]].transpose() * element.gradients[i]);
    }
    EXPECT_LT((system.rhs - rhs).norm(), 1e-11 * rhs.norm());
}

TEST(EulerianElement, HingeStiffnessIsThatOfTheMeanCornersAtTheExpansionPoint)
{
    // One hinge whose edge is EOL, with X^ far from where the mesh was made.
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
    terms.hinges.push_back(std::make_unique<Bending>(K));
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
    Bending(K).add(HingeState(hinge, at.position), local);
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

/// gamma = 1, everything at rest: rhs = B^T f_x + E^T f_X.
Linearization at_rest(const ClothMesh& mesh, unsigned seed)
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

/// Checks rhs against central differences of `energy_of(mesh)` along each vertex's coordinates, where
/// `is_checked` says so.
template <typename EnergyOf, typename IsChecked>
void expect_gradient(const ClothMesh& mesh, const Terms& terms, const Linearization& at,
                     const EnergyOf& energy_of, const IsChecked& is_checked)
{
    const Assembled system = assemble(mesh, terms, at);
    const double scale = system.rhs.cwiseAbs().maxCoeff();
    ASSERT_GT(scale, 0.0);
    for (int k = 0; k < 3 * mesh.vertex_count(); ++k) {
        const int v = k / 3;
        if (!is_checked(v)) continue;
        const auto energy_at = [&](double offset) {
            ClothMesh moved = mesh;
            moved.world[v] += offset * at.basis[v].col(k % 3);
            moved.material[v] += offset * at.flow->basis[v].col(k % 3);
            return energy_of(moved);
        };
        const double difference = -(energy_at(kStep) - energy_at(-kStep)) / (2.0 * kStep);
        EXPECT_NEAR(system.rhs[k], difference, kFdTolerance * (scale + std::abs(energy_of(mesh))))
            << "vertex " << v << (at.flow->is_eulerian[v] ? ", EOL" : "") << ", coordinate " << k % 3;
    }
}

double total(const Energies& energies)
{
    return energies.gravity + energies.stretch + energies.bending;
}

TEST(EulerianElement, ForcesAreMinusTheGradientsOfTheWholeSheetsEnergy)
{
    // Gravity's is one of the whole sheet only: material that leaves a face enters the next. At the border
    // material cannot flow out.
    for (const GridPattern pattern : {GridPattern::Diagonal, GridPattern::Alternating, GridPattern::Cross})
        for (const char* effect : {"stretch", "bending", "gravity", "all"}) {
            SCOPED_TRACE(effect);
            const ClothMesh mesh = crumpled_sheet({4, 4}, pattern, 7);
            const std::string name = effect;
            Terms terms;
            if (name == "stretch" || name == "all")
                terms.faces.push_back(std::make_unique<Membrane>(5.0, 0.3));
            if (name == "bending" || name == "all") terms.hinges.push_back(std::make_unique<Bending>(1e-2));
            if (name == "gravity" || name == "all")
                terms.faces.push_back(std::make_unique<GravityForce>(0.15, Gravity{}));
            const MeshTopology topology = make_topology(mesh.vertex_count(), mesh.faces);
            const bool has_gravity = name == "gravity" || name == "all";
            expect_gradient(
                mesh, terms, at_rest(mesh, 8),
                [&](const ClothMesh& moved) {
                    return total(compute_energies(make_elements(moved, topology), terms, moved.world));
                },
                [&](int v) { return !has_gravity || !topology.is_border[v]; });
        }
}

TEST(EulerianElement, PullDoesTheWorkOfItsForceOnTheMaterialInItsBox)
{
    // Its potential is -p . (mean x over the box), whatever vertices carry it there.
    const Vec3 p(1.0, -2.0, 0.5);
    const MaterialBox boxes[] = {
        {Vec2(0.2, 0.3), Vec2(0.62, 0.9)}, {Vec2(-1, -1), Vec2(2, 2)}, {Vec2(0.31, 0.1), Vec2(0.31, 0.93)}};
    for (const MaterialBox& box : boxes) {
        const ClothMesh mesh = crumpled_sheet({4, 4}, GridPattern::Diagonal, 9);
        const std::vector<char> is_border = make_topology(mesh.vertex_count(), mesh.faces).is_border;
        Terms terms;
        terms.loads.push_back(std::make_unique<PullForce>(Pull{box, p}));
        expect_gradient(
            mesh, terms, at_rest(mesh, 10),
            [&](const ClothMesh& moved) {
                double potential = 0.0;
                for (const LoadShare& share : spread_over_box(moved, box))
                    potential -= share.weight * p.dot(moved.world[share.vertex]);
                return potential;
            },
            [&](int v) { return !is_border[v]; });
    }
}

TEST(EulerianElement, InertiaIsThatOfMaterialPointsAsTheyAreSeenToMove)
{
    // One face whose corners move along parabolas in x and X; a material point's acceleration is the second
    // difference of where it is. rhs - M u with v' - v~ = xddot, V' - V~ = Xddot, gamma = 1.
    Generator random(11);
    for (int trial = 0; trial < 20; ++trial) {
        ClothMesh mesh;
        mesh.material = {Vec2(0, 0) + random2(random, 0.2), Vec2(1, 0) + random2(random, 0.2),
                         Vec2(0, 1) + random2(random, 0.2)};
        mesh.faces = {{0, 1, 2}};
        Linearization at;
        at.gamma = 1.0;
        MaterialFlow flow;
        flow.is_eulerian = {1, 1, 1};
        Eigen::VectorXd u(9);
        std::vector<Vec3> x_rate, x_second;
        std::vector<Vec2> X_rate, X_second;
        for (int v = 0; v < 3; ++v) {
            mesh.world.push_back(random3(random, 1.0));
            x_rate.push_back(random3(random, 1.0));
            x_second.push_back(random3(random, 1.0));
            X_rate.push_back(random2(random, 1.0));
            X_second.push_back(random2(random, 1.0));
            const Vec3 own = random3(random, 1.0);
            u.segment<3>(3 * v) = own;
            at.basis.push_back(Mat3::Identity());
            flow.basis.push_back(X_second[v] * own.transpose() / own.squaredNorm());
            at.drift.push_back(x_second[v] - own);
        }
        at.has_basis.assign(3, 0);
        at.position = flow.extrapolated.position = mesh.world;
        flow.position = flow.extrapolated.material = mesh.material;
        flow.extrapolated.velocity = x_rate;
        flow.extrapolated.material_velocity = X_rate;
        at.v_predicted = at.v_expansion = at.v_last = std::vector<Vec3>(3, Vec3::Zero());
        flow.v_predicted = flow.v_expansion = flow.v_last = std::vector<Vec2>(3, Vec2::Zero());
        at.flow = flow;
        const double density = 0.3;
        const Assembled system = assemble(mesh, only(std::make_unique<Inertia>(density)), at);

        // Where the material point that is at N now is at time t.
        const auto where = [&](const Vec3& N, double t) -> Vec3 {
            Vec2 point = Vec2::Zero();
            std::vector<Vec3> x = mesh.world;
            std::vector<Vec2> X = mesh.material;
            for (int v = 0; v < 3; ++v) {
                point += N[v] * mesh.material[v];
                x[v] += t * x_rate[v] + 0.5 * t * t * x_second[v];
                X[v] += t * X_rate[v] + 0.5 * t * t * X_second[v];
            }
            const FaceElement element = make_face_element(X, {0, 1, 2});
            return x[0] + FaceState(element, x).F * (point - X[0]);
        };
        const FaceElement element = make_face_element(mesh.material, {0, 1, 2});
        const Mat32 F = FaceState(element, mesh.world).F;
        Eigen::VectorXd expected = Eigen::VectorXd::Zero(9);
        constexpr double kTime = 1e-4;  // of second differences: error t^2 and eps / t^2, both 1e-8
        for (int edge = 0; edge < 3; ++edge) {
            // Midpoints of the edges: exact for the product of two linear functions.
            Vec3 N = Vec3::Constant(0.5);
            N[edge] = 0.0;
            const Vec3 a = (where(N, kTime) - 2.0 * where(N, 0.0) + where(N, -kTime)) / (kTime * kTime);
            for (int i = 0; i < 3; ++i)
                expected.segment<3>(3 * i) +=
                    density * element.area / 3.0 * N[i] * ((at.basis[i] - F * flow.basis[i]).transpose() * a);
        }
        const Eigen::VectorXd inertia = system.matrix * u - system.rhs;
        EXPECT_LT((inertia - expected).norm(), 1e-6 * (expected.norm() + 1.0));
    }
}

TEST(EulerianElement, IsBitIdenticalWithoutEolVerticesAndForAnyNumberOfThreads)
{
    const ClothMesh mesh = crumpled_sheet({30, 30}, GridPattern::Alternating, 12);
    const Terms terms =
        make_terms({0.15, 500.0, 0.3, 1e-4, 0.01, 1e-3}, Gravity{}, Wind{Vec3(1, 2, 3), 1.2, 1.0, {}},
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
    flow.extrapolated.material = mesh.material;
    const std::vector<double> with_flow = values();
    at.flow.reset();
    EXPECT_EQ(with_flow, values());
}

TEST(EulerianElement, UpdatedElementsAreThoseMadeAnew)
{
    ClothMesh mesh = crumpled_sheet({5, 4}, GridPattern::Cross, 14);
    const MeshTopology topology = make_topology(mesh.vertex_count(), mesh.faces);
    ClothElements updated = make_elements(mesh, topology);
    const double weight_before = updated.hinges[7].weight;
    Generator random(15);
    std::vector<char> is_moved(mesh.material.size(), 0);
    for (int v = 0; v < mesh.vertex_count(); v += 3) {
        is_moved[v] = 1;
        mesh.material[v] += random2(random, 0.01);
    }
    update_elements(mesh, is_moved, updated);
    const ClothElements anew = make_elements(mesh, topology);
    for (std::size_t f = 0; f < anew.faces.size(); ++f) {
        EXPECT_EQ(updated.faces[f].area, anew.faces[f].area);
        for (int i = 0; i < 3; ++i) EXPECT_EQ(updated.faces[f].gradients[i], anew.faces[f].gradients[i]);
    }
    for (std::size_t h = 0; h < anew.hinges.size(); ++h)
        EXPECT_EQ(updated.hinges[h].weight, anew.hinges[h].weight);
    EXPECT_NE(anew.hinges[7].weight, weight_before);
}

TEST(CornerVelocities, AVertexThatSlidesInAFlatSheetMovesNoMaterial)
{
    // (dx, dX) = (F s, s) on any vertices: the same corner velocities, energy, momenta and rows of the
    // system.
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
    EXPECT_EQ(kinetic_energy(density, elements, plain), kinetic_energy(density, elements, velocity));
    EXPECT_EQ(linear_momentum(density, elements, plain), linear_momentum(density, elements, velocity));
    EXPECT_EQ(angular_momentum(density, elements, mesh.world, plain),
              angular_momentum(density, elements, mesh.world, velocity));
    EXPECT_NEAR(kinetic_energy(density, elements, corners), kinetic_energy(density, elements, velocity),
                1e-13);
    EXPECT_LT(
        (linear_momentum(density, elements, corners) - linear_momentum(density, elements, velocity)).norm(),
        1e-13);
    EXPECT_LT((angular_momentum(density, elements, mesh.world, corners) -
               angular_momentum(density, elements, mesh.world, velocity))
                  .norm(),
              1e-13);
    const std::vector<Vec3> mean = mean_corner_velocities(elements, corners, sliding, flow);
    for (std::size_t v = 0; v < n; ++v) EXPECT_LT((mean[v] - velocity[v]).norm(), 1e-12);
    EXPECT_EQ(mean_corner_velocities(elements, plain, velocity, std::vector<Vec2>(n, Vec2::Zero())),
              velocity);

    // u = (x along the normal and one direction, X along another) finds the same mass as it would without.
    Linearization at = at_rest(mesh, 18);
    for (std::size_t v = 0; v < n; ++v) {
        at.flow->is_eulerian[v] = 1;
        at.basis[v] << random3(random, 1.0), random3(random, 1.0), Vec3::Zero();
        at.flow->basis[v] << Vec2::Zero(), Vec2::Zero(), random2(random, 1.0);
    }
    const Eigen::MatrixXd eulerian = assemble(mesh, only(std::make_unique<Inertia>(density)), at).matrix;
    for (std::size_t v = 0; v < n; ++v) {
        at.has_basis[v] = 1;
        at.basis[v] -= F * at.flow->basis[v];
    }
    at.flow.reset();
    const Eigen::MatrixXd plain_matrix = assemble(mesh, only(std::make_unique<Inertia>(density)), at).matrix;
    EXPECT_LT((eulerian - plain_matrix).norm(), kRoundOff * plain_matrix.norm());
}

/// Of D^-1/2 A D^-1/2, D the diagonal: what units and bases cannot mend. Negative or infinite where A is not
/// positive definite.
double condition(const Eigen::MatrixXd& A)
{
    const Eigen::VectorXd scale = A.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled = scale.asDiagonal() * A * scale.asDiagonal();
    const Eigen::VectorXd values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly).eigenvalues();
    return values[values.size() - 1] / values[0];
}

struct Conditions {
    double mass;  ///< of the mass alone
    double step;  ///< of a step of 5 ms of soft cloth, over that of the same cloth without EOL vertices
};

Conditions find_conditions(const ClothMesh& mesh, const std::vector<VertexCoordinates>& coordinates)
{
    const Terms terms = make_terms({0.05, 50.0, 0.3, 1e-5, 0.0, 1e-3}, {}, {}, {});
    const SlidingCloth cloth({}, mesh, {});
    Linearization at = cloth.linearize(coordinates, 0.005);
    const Eigen::MatrixXd step = assemble(mesh, terms, at).matrix;
    EXPECT_EQ(Eigen::LLT<Eigen::MatrixXd>(step).info(), Eigen::Success);
    const double mass = condition(assemble(mesh, only(std::make_unique<Inertia>(0.05)), at).matrix);
    at = cloth.linearize(std::vector<VertexCoordinates>(mesh.world.size()), 0.005);
    return {mass, condition(step) / condition(assemble(mesh, terms, at).matrix)};
}

/// Cells of 1/6 m whose columns lean by `lean` (a right angle: none) against the border v = 0, folded by
/// `fold` along the middle column, which lies on an edge with tangent y and whose nbar leans by `tilt` from
/// the fold's own bisector. All radians.
struct FoldedPatch {
    double fold = 0.0, lean = 0.5 * std::numbers::pi, tilt = 0.0;
};

Conditions find_conditions(const FoldedPatch& patch, GridPattern pattern)
{
    constexpr double kMiddle = 0.5;
    ClothGrid grid;
    grid.resolution = {6, 6};
    grid.pattern = pattern;
    ClothMesh mesh = make_cloth_grid(grid);
    const std::vector<char> is_border = make_topology(mesh.vertex_count(), mesh.faces).is_border;
    std::vector<VertexCoordinates> coordinates;
    // Across the trace in material and along it.
    const Vec2 across(std::sin(patch.lean), -std::cos(patch.lean)), along(-across.y(), across.x());
    const double half = 0.5 * patch.fold;
    const Vec3 nbar(std::sin(patch.tilt), 0.0, std::cos(patch.tilt));
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const double u = mesh.material[v].x() - kMiddle;
        Vec2& X = mesh.material[v];
        X.x() = u + X.y() / std::tan(patch.lean);
        const double s = across.dot(X);
        mesh.world[v] = Vec3(s * std::cos(half), along.dot(X), -std::abs(s) * std::sin(half));
        const bool is_on_edge = std::abs(u) < 1e-9;
        if (!is_on_edge)
            coordinates.emplace_back();
        else
            coordinates.push_back(on_edge(Vec3::UnitY(), nbar, is_border[v] ? Vec2(Vec2::UnitX()) : across));
    }
    return find_conditions(mesh, coordinates);
}

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::array kFolds = {0.0, 1.0, 10.0, 45.0, 90.0, 135.0, 170.0, 179.0, 180.0};
constexpr double kConsistentMass = 4.0;  // of a sheet without EOL vertices: of linear triangles' mass matrix

/// What two unit directions that are `angle` from parallel cost where they are coordinates of one vertex:
/// the condition of [1, cos; cos, 1].
double condition_of_skew(double angle)
{
    const double cosine = std::abs(std::cos(angle));
    return (1.0 + cosine) / (1.0 - cosine);
}

TEST(EulerianCoordinates, AreAsGoodAsLagrangianOnesOnAnEdgeHoweverTheClothIsFolded)
{
    // Flat, over an edge, and on both sides of a knife's edge or a wire.
    for (const GridPattern pattern : {GridPattern::Diagonal, GridPattern::Alternating, GridPattern::Cross})
        for (const double fold : kFolds) {
            SCOPED_TRACE(fold);
            FoldedPatch patch;
            patch.fold = fold * kDegree;
            const Conditions c = find_conditions(patch, pattern);
            EXPECT_GT(c.mass, 0.0);
            EXPECT_LT(c.mass, 1.1 * kConsistentMass);
            EXPECT_LT(c.step, 1.1);
        }
}

TEST(EulerianCoordinates, AreAsGoodAsTheAngleBetweenTraceAndBorder)
{
    // On the border material flows along it, and u along the edge is skew to that.
    for (const double lean : {70.0, 45.0, 30.0, 20.0})
        for (const double fold : kFolds) {
            SCOPED_TRACE(testing::Message() << "lean " << lean << ", fold " << fold);
            FoldedPatch patch;
            patch.fold = fold * kDegree;
            patch.lean = lean * kDegree;
            const Conditions c = find_conditions(patch, GridPattern::Diagonal);
            EXPECT_GT(c.mass, 0.0);
            EXPECT_LT(c.mass, 1.1 * kConsistentMass * condition_of_skew(patch.lean));
            EXPECT_LT(c.step, 2.0);
        }
}

TEST(EulerianCoordinates, AreAsGoodAsTheAngleBetweenClothAndNbarOrTheFold)
{
    // Cloth that leans against an edge or turns a little there, more to one side than nbar is.
    for (const double tilt : {30.0, 60.0, 80.0})
        for (const double fold : kFolds) {
            SCOPED_TRACE(testing::Message() << "tilt " << tilt << ", fold " << fold);
            FoldedPatch patch;
            patch.fold = fold * kDegree;
            patch.tilt = tilt * kDegree;
            const Conditions c = find_conditions(patch, GridPattern::Diagonal);
            EXPECT_GT(c.mass, 0.0);
            EXPECT_LT(c.mass, 1.1 * kConsistentMass * condition_of_skew(0.5 * std::numbers::pi - patch.tilt));
            EXPECT_GT(c.step, 0.0);
        }

    // Flat cloth that contains nbar has none: two of its coordinates are one. A fold of 10 degrees is enough.
    FoldedPatch flat;
    flat.tilt = 89.99 * kDegree;
    EXPECT_GT(find_conditions(flat, GridPattern::Diagonal).mass, 1e6);
    flat.fold = 10.0 * kDegree;
    EXPECT_LT(find_conditions(flat, GridPattern::Diagonal).mass, 2e3);
}

TEST(EulerianCoordinates, AreAsGoodAsTheAngleBetweenClothAndNbarOnAPoint)
{
    // A tent over a nail, from flat to closed, whose nbar leans.
    for (const double slope : {0.0, 1.0, 30.0, 60.0, 89.0, 90.0})
        for (const double tilt : {0.0, 45.0, 80.0}) {
            SCOPED_TRACE(testing::Message() << "slope " << slope << ", tilt " << tilt);
            ClothGrid grid;
            grid.resolution = {6, 6};
            ClothMesh mesh = make_cloth_grid(grid);
            std::vector<VertexCoordinates> coordinates(mesh.world.size());
            const double a = slope * kDegree, b = tilt * kDegree;
            for (int v = 0; v < mesh.vertex_count(); ++v) {
                const Vec2 s = mesh.material[v] - Vec2(0.5, 0.5);
                mesh.world[v] = Vec3(s.x() * std::cos(a), s.y() * std::cos(a), -s.norm() * std::sin(a));
                if (s.norm() < 1e-9) coordinates[v] = on_point(Vec3(std::sin(b), 0.0, std::cos(b)));
            }
            const Conditions c = find_conditions(mesh, coordinates);
            EXPECT_GT(c.mass, 0.0);
            EXPECT_LT(c.mass, 1.1 * kConsistentMass * condition_of_skew(0.5 * std::numbers::pi - b));
            EXPECT_GT(c.step, 0.0);
        }
}

}  // namespace
}  // namespace arris
