// SPDX-License-Identifier: GPL-3.0-or-later
// Forces on vertices through which material flows. They are minus the differences of the whole sheet's energy
// in x and X. Inertia is that of material points in their observed motion.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "physics/forces/bending.h"
#include "physics/forces/energies.h"
#include "physics/forces/gravity_force.h"
#include "physics/forces/inertia.h"
#include "physics/forces/membrane.h"
#include "physics/forces/plate_bending.h"
#include "physics/forces/pull_force.h"
#include "tests/physics/eulerian_cloth.h"

namespace arris {
namespace {

constexpr double kStep = 1e-6;         // m, of central differences; the sheet is 1 m
constexpr double kFdTolerance = 1e-7;  // truncation and eps / h, relative to the forces' scale

/// Checks rhs against central differences of `energy_of(mesh)` in the coordinates of each vertex for which
/// `is_checked` is true.
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

TEST(EulerianForces, ForcesAreMinusTheGradientsOfTheWholeSheetsEnergy)
{
    // Gravity's gradient is exact for the whole sheet only, because material that leaves a face enters the
    // next one. At the border material cannot flow out.
    for (const GridPattern pattern : {GridPattern::Diagonal, GridPattern::Alternating, GridPattern::Cross})
        for (const char* effect : {"stretch", "bending", "plate", "gravity", "all"}) {
            SCOPED_TRACE(effect);
            const ClothMesh mesh = crumpled_sheet({4, 4}, pattern, 7);
            const std::string name = effect;
            Terms terms;
            if (name == "stretch" || name == "all")
                terms.faces.push_back(std::make_unique<Membrane>(Material{0.0, 5.0, 0.3}));
            if (name == "bending" || name == "all")
                terms.hinges.push_back(std::make_unique<Bending>(std::vector<double>{1e-2}));
            if (name == "plate")
                terms.hinges.push_back(
                    std::make_unique<PlateBending>(std::vector<PlateMaterial>{{1e-2, 0.3}}));
            if (name == "gravity" || name == "all")
                terms.faces.push_back(std::make_unique<GravityForce>(Material{0.15}, Gravity{}));
            const MeshTopology topology = make_topology(mesh.vertex_count(), mesh.faces);
            const bool has_gravity = name == "gravity" || name == "all";
            expect_gradient(
                mesh, terms, linearization_at_rest(mesh, 8),
                [&](const ClothMesh& moved) {
                    return total(compute_energies(make_elements(moved, topology), terms, moved.world));
                },
                [&](int v) { return !has_gravity || !topology.is_border[v]; });
        }
}

TEST(EulerianForces, PullDoesTheWorkOfItsForceOnTheMaterialInItsBox)
{
    // The potential is -p . (mean x over the box), for any vertices in the box.
    const Vec3 p(1.0, -2.0, 0.5);
    const MaterialBox boxes[] = {
        {Vec2(0.2, 0.3), Vec2(0.62, 0.9)}, {Vec2(-1, -1), Vec2(2, 2)}, {Vec2(0.31, 0.1), Vec2(0.31, 0.93)}};
    for (const MaterialBox& box : boxes) {
        const ClothMesh mesh = crumpled_sheet({4, 4}, GridPattern::Diagonal, 9);
        const std::vector<char> is_border = make_topology(mesh.vertex_count(), mesh.faces).is_border;
        Terms terms;
        terms.loads.push_back(std::make_unique<PullForce>(Pull{box, p}));
        expect_gradient(
            mesh, terms, linearization_at_rest(mesh, 10),
            [&](const ClothMesh& moved) {
                double potential = 0.0;
                for (const LoadShare& share : spread_over_box(moved, box))
                    potential -= share.weight * p.dot(moved.world[share.vertex]);
                return potential;
            },
            [&](int v) { return !is_border[v]; });
    }
}

TEST(EulerianForces, InertiaIsThatOfMaterialPointsAsTheyAreSeenToMove)
{
    // One face moves with its corners along parabolas in x and X. A material point's acceleration is the
    // second difference of its position. The inertia is rhs - M u with v' - v~ = xddot, V' - V~ = Xddot,
    // gamma = 1.
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
        const Assembled system = assemble(mesh, only(std::make_unique<Inertia>(Material{density})), at);

        // Position at time t of the material point that is at N at time 0.
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
        constexpr double kTime = 1e-4;  // step of second differences: errors t^2 and eps / t^2, both 1e-8
        for (int edge = 0; edge < 3; ++edge) {
            // Quadrature at the edges' midpoints is exact for the product of two linear functions.
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
}  // namespace
}  // namespace arris
