// SPDX-License-Identifier: GPL-3.0-or-later
// The reduced coordinates of EOL vertices keep the system's matrix positive definite, for flat and folded
// cloth. The angles between the coordinates' directions bound its condition number.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "physics/forces/inertia.h"
#include "physics/forces/make_terms.h"
#include "tests/physics/eulerian_cloth.h"
#include "tests/physics/sliding_cloth.h"

namespace arris {
namespace {

/// Condition number of D^-1/2 A D^-1/2 with D the diagonal of A, which no choice of units can improve.
/// Negative or infinite if A is not positive definite.
double condition(const Eigen::MatrixXd& A)
{
    const Eigen::VectorXd scale = A.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled = scale.asDiagonal() * A * scale.asDiagonal();
    const Eigen::VectorXd values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly).eigenvalues();
    return values[values.size() - 1] / values[0];
}

struct Conditions {
    double mass;  ///< condition number of the mass matrix
    double step;  ///< of a step of 5 ms of soft cloth, over that of this cloth without EOL vertices
};

Conditions find_conditions(const ClothMesh& mesh, const std::vector<VertexCoordinates>& coordinates)
{
    const Terms terms = make_terms(Material{0.05, 50.0, 0.3, 1e-5, 0.0, 1e-3}, {}, {}, {});
    const SlidingCloth cloth({}, mesh, {});
    Linearization at = cloth.linearize(coordinates, 0.005);
    const Eigen::MatrixXd step = assemble(mesh, terms, at).matrix;
    EXPECT_EQ(Eigen::LLT<Eigen::MatrixXd>(step).info(), Eigen::Success);
    const double mass = condition(assemble(mesh, only(std::make_unique<Inertia>(Material{0.05})), at).matrix);
    at = cloth.linearize(std::vector<VertexCoordinates>(mesh.world.size()), 0.005);
    return {mass, condition(step) / condition(assemble(mesh, terms, at).matrix)};
}

/// Cells of 1/6 m whose columns meet the border v = 0 at the angle `lean`. The cloth is folded by `fold`
/// along the middle column, which lies on an edge with tangent y. There nbar leans by `tilt` from the fold's
/// bisector. All angles are in radians.
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
    // Material directions across the trace and along it.
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
// Condition number of linear triangles' mass matrix without EOL vertices.
constexpr double kConsistentMass = 4.0;

/// Condition number of [1, cos; cos, 1]: the factor caused by two unit directions at `angle` as coordinates
/// of one vertex.
double condition_of_skew(double angle)
{
    const double cosine = std::abs(std::cos(angle));
    return (1.0 + cosine) / (1.0 - cosine);
}

TEST(EulerianCoordinates, AreAsGoodAsLagrangianOnesOnAnEdgeHoweverTheClothIsFolded)
{
    // The folds are flat, over an edge, and on both sides of a knife's edge or a wire.
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
    // On the border, material flows along the border, which is oblique to the world coordinate along the
    // edge.
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
    // The cloth leans against an edge, so nbar differs from the fold's bisector.
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

    // In flat cloth that contains nbar two coordinates coincide. A fold of 10 degrees is enough to separate
    // them.
    FoldedPatch flat;
    flat.tilt = 89.99 * kDegree;
    EXPECT_GT(find_conditions(flat, GridPattern::Diagonal).mass, 1e6);
    flat.fold = 10.0 * kDegree;
    EXPECT_LT(find_conditions(flat, GridPattern::Diagonal).mass, 2e3);
}

TEST(EulerianCoordinates, AreAsGoodAsTheAngleBetweenClothAndNbarOnAPoint)
{
    // A tent over a nail, from flat to closed, with a tilted nbar.
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
