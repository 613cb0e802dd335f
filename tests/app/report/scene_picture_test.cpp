// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/report/scene_picture.h"

#include <gtest/gtest.h>

#include "tests/app/stretching_obstacle.h"

namespace arris {
namespace {

/// A square of cloth of this size at this height above the origin.
Frame square(double size, double height)
{
    Frame frame;
    for (const auto& [x, y] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
        frame.world.emplace_back(0.5 * size * x, 0.5 * size * y, height);
    frame.faces = {{0, 1, 2}, {0, 2, 3}};
    return frame;
}

/// A square of an obstacle.
ObstacleRecord sheet(double size, double height)
{
    const Frame frame = square(size, height);
    ObstacleRecord record;
    record.mesh.points = frame.world;
    record.mesh.faces = frame.faces;
    return record;
}

TEST(ScenePicture, IsTheSameForASceneOfAnySizeAnywhere)
{
    const std::string here = draw_scene(square(1.0, 0.0), {sheet(1.5, -0.5)}, 0.0);
    EXPECT_EQ(draw_scene(square(1024.0, 0.0), {sheet(1536.0, -512.0)}, 0.0), here);
}

TEST(ScenePicture, ShowsClothAboveAnObstacleAndHidesItBelow)
{
    const std::string alone = draw_scene(square(1.0, 0.0), {}, 0.0);
    const std::string above = draw_scene(square(1.0, 0.0), {sheet(0.5, -0.01)}, 0.0);
    const std::string below = draw_scene(square(1.0, 0.0), {sheet(0.5, 0.01)}, 0.0);
    EXPECT_EQ(above, alone);  // the cloth covers the small sheet
    EXPECT_NE(below, alone);
}

TEST(ScenePicture, LooksFromASideFromWhichTheClothIsSeen)
{
    // A wall just in front of the cloth, as wide and as high as it hides all of the cloth from its side. From
    // each of the four sides a wall is met once: the picture must still depend on the cloth.
    for (const double degrees : {-60.0, 30.0, 120.0, 210.0}) {
        ObstacleRecord wall = sheet(3.0, 0.0);
        const Mat3 turn = rotation_about(Vec3::UnitZ(), degrees);
        for (Vec3& p : wall.mesh.points) p = turn * Vec3(1.0, p[0], p[1]);
        Frame folded = square(1.0, 0.0);
        const std::string flat = draw_scene(folded, {wall}, 0.0);
        folded.world[2][2] += 0.05;
        folded.world[3][2] += 0.05;
        EXPECT_NE(draw_scene(folded, {wall}, 0.0), flat) << degrees;
    }
}

TEST(ScenePicture, MovesObstaclesAndDrawsWiresAndNails)
{
    ObstacleRecord nail;
    nail.mesh.points = {Vec3(0.0, 0.0, 0.1), Vec3(0.3, 0.0, 0.1)};
    nail.mesh.lone_points = {0};
    ObstacleRecord wire = nail;
    wire.mesh.lone_points.clear();
    wire.mesh.segments = {{0, 1}};
    ObstacleRecord moving = nail;
    moving.motion.velocity = Vec3(0.1, 0.0, 0.0);
    const Frame cloth = square(1.0, 0.0);
    const std::string alone = draw_scene(cloth, {}, 0.0), still = draw_scene(cloth, {nail}, 0.0);
    EXPECT_NE(still, alone);
    EXPECT_NE(draw_scene(cloth, {wire}, 0.0), still);
    EXPECT_EQ(draw_scene(cloth, {moving}, 0.0), still);
    EXPECT_NE(draw_scene(cloth, {moving}, 1.0), still);
}

TEST(ScenePicture, DrawsAnObstacleThatDeformsAsItIsAtTheTime)
{
    const ObstacleRecord body = make_stretching("body", sheet(0.5, 0.1).mesh);
    ObstacleRecord wide = body;
    for (Vec3& p : wide.mesh.points) p = stretched(p, 2.0);
    wide.deformation = nullptr;
    const Frame cloth = square(2.0, 0.0);
    EXPECT_EQ(draw_scene(cloth, {body}, 2.0), draw_scene(cloth, {wide}, 0.0));
    EXPECT_NE(draw_scene(cloth, {body}, 2.0), draw_scene(cloth, {body}, 0.0));
}

}  // namespace
}  // namespace arris
