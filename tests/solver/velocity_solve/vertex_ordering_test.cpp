// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/velocity_solve/vertex_ordering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "geometry/cloth/mesh_topology.h"
#include "geometry/cloth_input/cloth_grid.h"
#include "physics/elements/cloth_elements.h"
#include "physics/system/linear_system.h"
#include "solver/velocity_solve/factorization.h"
#include "tests/solver/cloth_system.h"

namespace arris {
namespace {

struct Sheet {
    Eigen::SparseMatrix<double> matrix;
    std::vector<Vec2> place;
};

Sheet make_sheet(int side, double aspect = 1.0)
{
    testing::ClothShape shape;
    shape.side = side;
    shape.aspect = aspect;
    testing::ClothSystem cloth = testing::make_cloth_system(shape);
    Sheet sheet = {std::move(cloth.matrix), {}};
    for (const Vec3& x : cloth.position) sheet.place.push_back(x.head<2>());
    return sheet;
}

void expect_permutation(std::vector<int> order, std::size_t size)
{
    std::sort(order.begin(), order.end());
    std::vector<int> expected(size);
    std::iota(expected.begin(), expected.end(), 0);
    EXPECT_EQ(order, expected);
}

TEST(Dissection, OrdersEveryVertexOnce)
{
    for (const int side : {1, 2, 3, 9, 20}) {
        const Sheet sheet = make_sheet(side);
        expect_permutation(dissect(VertexGraph(sheet.matrix), sheet.place), sheet.place.size());
    }
}

TEST(Dissection, OrdersVerticesAtOnePlaceAndOnALine)
{
    const Sheet sheet = make_sheet(9);
    const VertexGraph graph(sheet.matrix);
    std::vector<Vec2> line = sheet.place;
    for (Vec2& place : line) place.y() = 0.0;
    expect_permutation(dissect(graph, line), line.size());
    const std::vector<Vec2> point(line.size(), Vec2(0.5, 0.5));
    expect_permutation(dissect(graph, point), point.size());
}

TEST(Dissection, OrdersAGraphWithoutEdgesAndACompleteOne)
{
    const Eigen::MatrixXd diagonal = Eigen::MatrixXd::Identity(30, 30), full = Eigen::MatrixXd::Ones(30, 30);
    const std::vector<Vec2> place = make_sheet(4).place;
    const std::vector<Vec2> ten(place.begin(), place.begin() + 10);
    expect_permutation(dissect(VertexGraph(testing::lower_blocks(diagonal)), ten), 10);
    expect_permutation(dissect(VertexGraph(testing::lower_blocks(full)), ten), 10);
}

/// A separator is eliminated after what it separates: the last vertices of the order cut the sheet in two.
TEST(Dissection, EndsWithASeparator)
{
    const int side = 20;
    const Sheet sheet = make_sheet(side, 3.0);
    const VertexGraph graph(sheet.matrix);
    const std::vector<int> order = dissect(graph, sheet.place);
    // Bending couples vertices two rows apart, so a separator has two rows.
    std::vector<char> is_left(order.size(), 1);
    for (int k = 0; k < 2 * side; ++k) is_left[order[order.size() - 1 - k]] = 0;
    std::vector<int> piece(order.size());
    std::iota(piece.begin(), piece.end(), 0);
    const auto root = [&](int v) {
        while (piece[v] != v) v = piece[v];
        return v;
    };
    for (int v = 0; v < graph.size(); ++v)
        for (int k = graph.start[v]; k < graph.start[v + 1]; ++k)
            if (is_left[v] && is_left[graph.neighbour[k]]) piece[root(v)] = root(graph.neighbour[k]);
    std::vector<int> size(order.size(), 0);
    for (int v = 0; v < graph.size(); ++v)
        if (is_left[v]) ++size[root(v)];
    EXPECT_GE(std::count_if(size.begin(), size.end(), [&](int n) { return n > 5 * side; }), 2);
}

TEST(Dissection, FillsAboutAsLittleAsMetis)
{
    const auto flops_over_those_of_metis = [](GridPattern pattern, int cells) {
        ClothGrid grid;
        grid.resolution = {cells, cells};
        grid.pattern = pattern;
        const ClothMesh mesh = make_cloth_grid(grid);
        LinearSystem system;
        system.make_pattern(make_elements(mesh, make_topology(mesh.vertex_count(), mesh.faces)));
        Factorization by_metis, by_place;
        by_metis.analyse(system.matrix());
        by_place.analyse(system.matrix(), &mesh.material);
        return by_place.flops() / by_metis.flops();
    };
    for (const int cells : {20, 40}) {
        EXPECT_LE(flops_over_those_of_metis(GridPattern::Cross, cells), 1.1);
        EXPECT_LE(flops_over_those_of_metis(GridPattern::Alternating, cells), 1.1);
        EXPECT_LE(flops_over_those_of_metis(GridPattern::Unstructured, cells), 1.15);
        EXPECT_LE(flops_over_those_of_metis(GridPattern::Diagonal, cells), 1.4);
    }
}

}  // namespace
}  // namespace arris
