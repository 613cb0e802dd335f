// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/system/dense_system.h"
#include "physics/forces/make_terms.h"

#include <gtest/gtest.h>

#include <random>

#include "geometry/cloth_input/cloth_grid.h"
#include "physics/system/linear_system.h"

namespace arris {
namespace {

/// A crumpled sheet at rest.
struct Sheet {
    ClothMesh mesh;
    ClothElements elements;
    Terms terms = make_terms(Material{0.15, 500.0, 0.3, 1e-3, 0.0, 1e-3}, Gravity{}, {}, {});
    Linearization at;

    Sheet()
    {
        ClothGrid grid;
        grid.resolution = {5, 4};
        grid.pattern = GridPattern::Cross;
        mesh = make_cloth_grid(grid);
        std::mt19937_64 random(7);
        std::uniform_real_distribution<double> noise(-0.05, 0.05);
        for (Vec3& x : mesh.world) x += Vec3(noise(random), noise(random), noise(random));
        const int n = mesh.vertex_count();
        elements = list_elements(mesh, make_topology(n, mesh.faces));
        at.gamma = 0.005;
        at.position = mesh.world;
        at.v_last = at.v_predicted = at.v_expansion = at.drift = std::vector<Vec3>(n, Vec3::Zero());
        at.basis.assign(n, Mat3::Identity());
        at.has_basis.assign(n, 0);
    }
};

/// Two of three vertices belong to the system, in an order of its own.
std::vector<int> make_places(int count, int& taken)
{
    std::vector<int> places(count, -1);
    taken = 0;
    for (int v = count - 1; v >= 0; --v)
        if (v % 3 != 0) places[v] = taken++;
    return places;
}

TEST(DenseSystem, HasTheNumbersOfTheSparseOne)
{
    const Sheet sheet;
    int count = 0;
    const std::vector<int> places = make_places(sheet.mesh.vertex_count(), count);
    DenseSystem dense(places, count);
    LinearSystem sparse;
    sparse.make_pattern(sheet.elements, places);
    for (int round = 0; round < 2; ++round) {  // the second round must not contain entries of the first
        dense.assemble(sheet.elements, sheet.terms, sheet.at);
        sparse.assemble(sheet.mesh, sheet.elements, sheet.terms, sheet.at);
        const Mat3 spring = 40.0 * Vec3(1, 2, 2) * Vec3(1, 2, 2).transpose();
        dense.add_to_vertex(count / 2, spring);
        sparse.add_to_vertex(count / 2, spring);
        const Eigen::MatrixXd truth = sparse.matrix().toDense().triangularView<Eigen::Lower>();
        const Eigen::MatrixXd found = dense.matrix().triangularView<Eigen::Lower>();
        constexpr double kRoundOff = 1e-14;  // of sums in another order
        EXPECT_LT((found - truth).cwiseAbs().maxCoeff(), kRoundOff * truth.cwiseAbs().maxCoeff());
        EXPECT_LT((dense.rhs() - sparse.rhs()).cwiseAbs().maxCoeff(),
                  kRoundOff * sparse.rhs().cwiseAbs().maxCoeff());
        EXPECT_GT(sparse.rhs().norm(), 0.0);
    }
}

}  // namespace
}  // namespace arris
