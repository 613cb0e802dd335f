// SPDX-License-Identifier: GPL-3.0-or-later
// The reduced coordinates of EOL vertices: the system's matrix is positive definite, flat or folded, and as
// well conditioned as the directions of its coordinates are apart.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "eulerian_cloth.h"
#include "physics/inertia.h"
#include "sliding_cloth.h"

namespace arris {
namespace {

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
