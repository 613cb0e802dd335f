// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/untangle/smooth_move.h"

#include <gtest/gtest.h>

#include "tests/geometry/untangle/tangled_cloth.h"

namespace arris {
namespace {

constexpr double kShortfall = 0.07;  // of a row: a vertex has some 6 edges, and a row weighs as much as 100

/// A level sheet of 20 x 20 cells.
ClothMesh sheet()
{
    return samples::dipped_sheet(0.0, 0.0).mesh;
}

int vertex_at(const ClothMesh& mesh, const Vec2& place)
{
    int nearest = 0;
    for (int v = 0; v < mesh.vertex_count(); ++v)
        if ((mesh.material[v] - place).norm() < (mesh.material[nearest] - place).norm()) nearest = v;
    return nearest;
}

/// The middle of the sheet; material coordinates begin at u = 1 m.
const Vec2 kMiddle(1.2, 0.2);

TEST(SmoothMove, FulfilsARowAndDecaysAroundIt)
{
    const ClothMesh cloth = sheet();
    const CollisionMesh mesh(cloth, samples::self_request());
    const int v = vertex_at(cloth, kMiddle);
    const std::vector<Vec3> move = find_smooth_move(mesh, {{{{v, Vec3::UnitZ()}}, 0.01}}, 2.0).move;
    EXPECT_GE(move[v].z(), (1.0 - kShortfall) * 0.01);
    EXPECT_LE(move[v].z(), 0.01);
    double last = move[v].z();
    for (int k = 1; k < 10; ++k) {
        const double next = move[vertex_at(cloth, kMiddle + Vec2(0.02 * k, 0.0))].z();
        EXPECT_LE(next, last);
        last = next;
    }
    EXPECT_EQ(last, 0.0);  // farther than three reaches
}

TEST(SmoothMove, ARowThatOthersExceedDoesNotPullBack)
{
    const ClothMesh cloth = sheet();
    const CollisionMesh mesh(cloth, samples::self_request());
    const int v = vertex_at(cloth, kMiddle), w = vertex_at(cloth, kMiddle + Vec2(0.02, 0.0));
    const MoveRow far{{{v, Vec3::UnitZ()}}, 0.01}, near{{{w, Vec3::UnitZ()}}, 0.001};
    const SmoothMove one = find_smooth_move(mesh, {far}, 4.0),
                     both = find_smooth_move(mesh, {far, near}, 4.0);
    EXPECT_NEAR(both.move[w].z(), one.move[w].z(), 1e-6);
    EXPECT_GT(both.move[w].z(), 0.002);
    EXPECT_NEAR(both.work, one.work, 1e-3 * one.work);
}

TEST(SmoothMove, HeldVerticesStay)
{
    const ClothMesh cloth = sheet();
    const int v = vertex_at(cloth, kMiddle), held = vertex_at(cloth, kMiddle + Vec2(0.02, 0.0));
    const CollisionMesh mesh(cloth, samples::self_request({held}));
    const std::vector<Vec3> move = find_smooth_move(mesh, {{{{v, Vec3::UnitZ()}}, 0.01}}, 4.0).move;
    EXPECT_GT(move[v].z(), 0.009);
    EXPECT_EQ(move[held], Vec3::Zero());
}

TEST(SmoothMove, APieceThatIsFreeMovesAsAWhole)
{
    const ClothMesh cloth = sheet();
    const CollisionMesh mesh(cloth, samples::self_request());
    const int corner = vertex_at(cloth, {1.0, 0.0});
    const std::vector<Vec3> move = find_smooth_move(mesh, {{{{corner, Vec3::UnitX()}}, 0.01}}, 1e4).move;
    for (const Vec3& u : move) EXPECT_NEAR((u - Vec3(0.01, 0.0, 0.0)).norm(), 0.0, 1e-5);
}

}  // namespace
}  // namespace arris
