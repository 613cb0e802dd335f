// SPDX-License-Identifier: GPL-3.0-or-later
// The heavy cantilever of elastica_test.cpp on regular, graded and irregular meshes, with both bending models
// and one K. The plate's rigidity is K on each mesh. The hinges' rigidity is K times a factor of the mesh.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cantilever.h"
#include "cloth_run.h"
#include "elastica.h"
#include "geometry/cloth/mesh_topology.h"
#include "refinement.h"

namespace arris {
namespace {

constexpr double kBending = 1.0;  // K, J
// So large that curvature x width^2 is below it: only bending stiffens.
constexpr double kThickness = 0.04;  // sqrt(12 K / E), m
constexpr double kModulus = 12.0 * kBending / (kThickness * kThickness);

struct Strip {
    const char* name;
    GridPattern pattern;
    int cells_across;
    double grading;   ///< longest over shortest cell; the shortest is at the clamp
    double disorder;  ///< random displacement of vertices in the material, over a cell
};

const std::vector<Strip> kStrips = {
    {"diagonal", GridPattern::Diagonal, 1, 1.0, 0.0},
    {"alternating", GridPattern::Alternating, 1, 1.0, 0.0},
    {"cross", GridPattern::Cross, 1, 1.0, 0.0},
    {"unstructured", GridPattern::Unstructured, 4, 1.0, 0.0},
    {"alternating, graded 1:4", GridPattern::Alternating, 1, 4.0, 0.0},
    {"cross, graded 1:4", GridPattern::Cross, 1, 4.0, 0.0},
    {"irregular", GridPattern::Unstructured, 4, 1.0, 0.25},
    {"irregular, graded 1:4", GridPattern::Unstructured, 4, 4.0, 0.25},
};

/// Moves vertices off the clamp's line and the border at random, as far as no face becomes a sliver.
void disturb(double size, ClothMesh& mesh)
{
    const std::vector<char> is_border = make_topology(mesh.vertex_count(), mesh.faces).is_border;
    const VertexFaces faces_at(mesh.vertex_count(), mesh.faces);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> uniform(-size, size);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Vec2 move(uniform(random), uniform(random));
        if (is_border[v] || std::abs(mesh.material[v].x() - 1.0) < 1e-9) continue;
        mesh.material[v] += move;
        const bool is_good = std::all_of(faces_at[v].begin(), faces_at[v].end(), [&](int f) {
            const auto& [a, b, c] = mesh.faces[f];
            const double least_area = 0.1 * size * size;
            return twice_area(mesh.material[a], mesh.material[b], mesh.material[c]) > least_area;
        });
        if (!is_good) mesh.material[v] -= move;
    }
}

ClothMesh make_strip(const Strip& strip, int cells)
{
    const double width = static_cast<double>(strip.cells_across) / cells;
    ClothGrid grid;
    grid.size = Vec2(2.0, width);
    grid.resolution = {2 * cells, strip.cells_across};
    grid.pattern = strip.pattern;
    if (strip.pattern == GridPattern::Unstructured)  // a fold by 0 degrees: mesh edges on the clamp's line
        grid.folds = {FoldLine{{Vec2(1.0, -1.0), Vec2(1.0, 1.0)}, 0.0}};
    ClothMesh mesh = make_cloth_grid(grid);
    disturb(strip.disorder / cells, mesh);
    for (Vec2& X : mesh.material) {
        // The cell's length grows from the clamp by the factor exp(ln(grading) distance).
        const double rate = std::log(strip.grading), far = X.x() - 1.0;
        if (strip.grading > 1.0)
            X.x() = 1.0 + std::copysign(std::expm1(rate * std::abs(far)) / std::expm1(rate), far);
    }
    lay(mesh, Vec3::Zero());
    return mesh;
}

class ElasticaOnMeshes : public testing::TestWithParam<BendingModel> {};

TEST_P(ElasticaOnMeshes, TipIsThatOfTheRigidityK)
{
    const bool is_plate = GetParam() == BendingModel::Plate;
    const std::vector<int> resolutions = {8, 16, 32, 64};
    std::vector<std::string> head = {"mesh"};
    for (const int weight : {5, 20})
        for (const int cells : resolutions) head.push_back(fmt::format("G = {}, {} cells", weight, cells));
    Table table(is_plate ? "elastica_plate" : "elastica_hinges", head);
    for (const Strip& strip : kStrips) {
        std::vector<std::string> row = {strip.name};
        for (const double weight : {5.0, 20.0})
            for (const int cells : resolutions) {
                SCOPED_TRACE(fmt::format("{}, {} cells, G = {}", strip.name, cells, weight));
                const Material material = {1.0, kModulus, 0.0, kBending, 0.0, 1e-3, GetParam()};
                const Tip tip = settle_cantilever(make_strip(strip, cells), material, weight * kBending, 0.0);
                ASSERT_FALSE(HasFailure());
                const ElasticaTip exact = solve_elastica({weight, 0.0, kBending / kModulus});
                const double error = std::hypot(tip.x - exact.x, tip.y - exact.y);  // lengths of the strip
                row.push_back(fmt::format("{:.2f} %", 100.0 * error));
                constexpr double kAllowed = 0.01;
                if (is_plate && cells >= 32) {
                    EXPECT_LT(error, kAllowed);
                }
            }
        table.add(row);
    }
}

INSTANTIATE_TEST_SUITE_P(All, ElasticaOnMeshes, testing::Values(BendingModel::Hinge, BendingModel::Plate),
                         [](const auto& i) { return i.param == BendingModel::Plate ? "plate" : "hinges"; });

}  // namespace
}  // namespace arris
