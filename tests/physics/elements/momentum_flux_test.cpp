// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/elements/momentum_flux.h"

#include <gtest/gtest.h>

#include "physics/forces/inertia.h"
#include "physics/forces/make_terms.h"
#include "tests/physics/eulerian_cloth.h"

namespace arris {
namespace {

constexpr double kDensity = 0.3;     // kg/m^2
constexpr double kRoundOff = 1e-12;  // for sums over some tens of hinges

ClothElements elements_of(const ClothMesh& mesh)
{
    return make_elements(mesh, make_topology(mesh.vertex_count(), mesh.faces));
}

/// A 1 m strip along x goes over the y axis at X = fold and down at 90 degrees. All of its material flows
/// over the fold with `speed` towards +x.
struct FoldedStrip {
    ClothMesh mesh;
    Linearization at;

    FoldedStrip(double fold, double speed)
    {
        mesh.material = {Vec2(0, 0), Vec2(0, 0.2), Vec2(fold, 0), Vec2(fold, 0.2), Vec2(1, 0), Vec2(1, 0.2)};
        mesh.faces = {{0, 2, 1}, {2, 3, 1}, {2, 4, 3}, {4, 5, 3}};
        for (const Vec2& X : mesh.material)
            mesh.world.push_back({std::min(X.x() - fold, 0.0), X.y(), -std::max(X.x() - fold, 0.0)});
        at = random_linearization(mesh, 1);
        MaterialFlow& flow = *at.flow;
        for (int v = 0; v < 6; ++v) {
            const double s = mesh.material[v].x() - fold;
            const bool is_on_fold = v == 2 || v == 3;
            flow.is_eulerian[v] = is_on_fold;
            at.basis[v] = Mat3::Identity();
            flow.basis[v].setZero();
            if (is_on_fold) flow.basis[v].col(2) = Vec2::UnitX();
            flow.extrapolated.material_velocity[v] = is_on_fold ? Vec2(-speed, 0.0) : Vec2(0.0, 0.0);
            flow.extrapolated.velocity[v] = is_on_fold ? Vec3(0, 0, 0)
                                            : s < 0.0  ? Vec3(speed, 0, 0)
                                                       : Vec3(0, 0, -speed);
        }
        for (int v : {2, 3}) at.basis[v].col(2).setZero();
        flow.extrapolated.position = mesh.world;
        flow.extrapolated.material = mesh.material;
        flow.position = mesh.material;
        for (auto* none : {&flow.v_predicted, &flow.v_expansion, &flow.v_last})
            none->assign(mesh.world.size(), Vec2::Zero());
    }

    Eigen::VectorXd force() const
    {
        Eigen::VectorXd rhs = Eigen::VectorXd::Zero(18);
        add_momentum_flux(Material{kDensity}, elements_of(mesh), at, rhs);
        return rhs / at.gamma;
    }
};

TEST(MomentumFlux, OfAStripOverATableEdgeIsMassFlowTimesTheTurnOfItsVelocity)
{
    // For both signs the momentum flux pushes outward; tension would pull inward.
    for (const double speed : {2.0, -2.0}) {
        const FoldedStrip strip(0.6, speed);
        const Eigen::VectorXd force = strip.force();
        const double flow = kDensity * 2.0 * 0.2;  // kg/s
        // u = (c, a, s) with c along x: each of the two vertices has half of the force.
        for (const int v : {2, 3}) EXPECT_NEAR(force[3 * v], 0.5 * flow * 2.0, kRoundOff);
        // Material does not slow down, so there is no force along the flow.
        for (const int v : {2, 3}) EXPECT_NEAR(force[3 * v + 2], 0.0, kRoundOff);
        for (const int v : {0, 1, 4, 5}) EXPECT_EQ(force.segment<3>(3 * v).norm(), 0.0);
    }
}

TEST(MomentumFlux, DoesNotDependOnWhichOfTheTwoFacesComesFirst)
{
    FoldedStrip strip(0.3, 1.5);
    const Eigen::VectorXd force = strip.force();
    std::reverse(strip.mesh.faces.begin(), strip.mesh.faces.end());
    EXPECT_LT((strip.force() - force).norm(), kRoundOff * force.norm());
}

TEST(MomentumFlux, IsNothingWhereClothIsFlatOrNoMaterialFlows)
{
    FoldedStrip still(0.6, 0.0);
    EXPECT_EQ(still.force().norm(), 0.0);
    FoldedStrip flat(0.6, 2.0);
    for (int v = 0; v < 6; ++v) flat.at.flow->extrapolated.position[v] << flat.mesh.material[v], 0.0;
    EXPECT_LT(flat.force().norm(), kRoundOff);
    Linearization none = flat.at;
    none.flow.reset();
    Eigen::VectorXd rhs = Eigen::VectorXd::Zero(18);
    add_momentum_flux(Material{kDensity}, elements_of(flat.mesh), none, rhs);
    EXPECT_EQ(rhs.norm(), 0.0);
}

/// Velocities of a face's corners on the hinge's edge, m/s.
std::array<Vec3, 2> speeds_beside(const ClothMesh& mesh, const Linearization& at, const HingeElement& hinge,
                                  int face)
{
    const ExtrapolatedState& there = at.flow->extrapolated;
    const FaceElement element = make_face_element(there.material, mesh.faces[face]);
    const Mat32 F = FaceState(element, there.position).F;
    std::array<Vec3, 2> w;
    for (int i = 0; i < 2; ++i) {
        const int v = hinge.vertices[i];
        w[i] = there.velocity[v] - F * there.material_velocity[v];
    }
    return w;
}

/// Integral along the crease. Gauss's three points are exact to the fifth degree; the factors are linear
/// between the ends.
template <typename Integrand>
double integrate(const Integrand& at)
{
    const double half = 0.5 * std::sqrt(0.6);
    return 5.0 / 18.0 * (at(0.5 - half) + at(0.5 + half)) + 4.0 / 9.0 * at(0.5);
}

TEST(MomentumFlux, HasThePowerOfTheKineticEnergyThatFlowsFromOneSideToTheOther)
{
    const ClothMesh mesh = crumpled_sheet({5, 4}, GridPattern::Alternating, 31);
    Linearization at = random_linearization(mesh, 32);
    const int n = mesh.vertex_count();
    // u = 1 is the extrapolated motion itself.
    for (int v = 0; v < n; ++v) {
        at.basis[v].setZero();
        at.basis[v].col(0) = at.flow->extrapolated.velocity[v];
        at.flow->basis[v].setZero();
        at.flow->basis[v].col(0) = at.flow->extrapolated.material_velocity[v];
    }
    const ClothElements elements = elements_of(mesh);
    Eigen::VectorXd rhs = Eigen::VectorXd::Zero(3 * n);
    add_momentum_flux(Material{kDensity}, elements, at, rhs);
    const double power = rhs.sum() / at.gamma;

    double expected = 0.0, size = 0.0;
    for (const HingeElement& hinge : elements.hinges) {
        const ExtrapolatedState& there = at.flow->extrapolated;
        const Vec2 e = there.material[hinge.vertices[1]] - there.material[hinge.vertices[0]];
        const Vec2 to_right(e.y(), -e.x());
        const auto left = speeds_beside(mesh, at, hinge, hinge.faces[0]);
        const auto right = speeds_beside(mesh, at, hinge, hinge.faces[1]);
        const double gained = integrate([&](double s) {
            const auto between = [&](const auto& p, const auto& q) { return ((1.0 - s) * p + s * q).eval(); };
            const Vec2 V = between(there.material_velocity[hinge.vertices[0]],
                                   there.material_velocity[hinge.vertices[1]]);
            // Material over which the crease moves towards the right was on the right and is now on the left.
            return 0.5 * kDensity * V.dot(to_right) *
                   (between(left[0], left[1]).squaredNorm() - between(right[0], right[1]).squaredNorm());
        });
        expected -= gained;
        size += std::abs(gained);
    }
    EXPECT_GT(size, 0.0);
    EXPECT_NEAR(power, expected, kRoundOff * size);
}

TEST(MomentumFlux, IsPartOfTheAssembledSystemWhereverThereIsInertia)
{
    const FoldedStrip strip(0.6, 2.0);
    Terms terms;
    terms.materials = Material{kDensity};
    const Eigen::VectorXd with = assemble(strip.mesh, terms, strip.at).rhs;
    EXPECT_LT((with - strip.at.gamma * strip.force()).norm(), kRoundOff * with.norm());
    EXPECT_EQ(make_terms(Material{kDensity, 50.0, 0.3, 0.0, 0.0, 1e-3}, {}, {}, {}).materials[0].density,
              kDensity);
}

}  // namespace
}  // namespace arris
