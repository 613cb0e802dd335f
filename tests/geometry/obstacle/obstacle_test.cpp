// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle/obstacle.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace arris {
namespace {

/// A rough sheet of n x n squares of `size` (m) around `centre`.
ObstacleMesh make_ground(int n, double size, const Vec3& centre)
{
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> height(-0.3, 0.3);
    ObstacleMesh mesh;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) mesh.points.push_back(centre + size * Vec3(i, j, height(random)));
    const auto at = [n](int i, int j) { return j * (n + 1) + i; };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            mesh.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    mesh.lone_points = {0, n};
    return mesh;
}

Obstacle make_obstacle(ObstacleMesh mesh)
{
    return Obstacle(std::move(mesh), 5.0);
}

Box3 box_of(const ObstacleMesh& mesh, const Face& face)
{
    Box3 box;
    for (const int p : face) box.extend(mesh.points[p]);
    return box;
}

TEST(Obstacle, BoxQueriesFindWhatTouchesAndNothingOutsideTheBox)
{
    for (const double size : {1e-6, 1.0, 1e6})
        for (const Vec3& centre : {Vec3(0, 0, 0), Vec3(1e6 * size, -1e6 * size, 0)}) {
            const Obstacle obstacle = make_obstacle(make_ground(12, size, centre));
            const ObstacleMesh& mesh = obstacle.mesh();
            std::mt19937_64 random(7);
            std::uniform_real_distribution<double> unit(-1.0, 13.0), width(0.0, 2.0);
            std::vector<int> found;
            for (int k = 0; k < 200; ++k) {
                const Vec3 corner =
                    centre + size * Vec3(unit(random), unit(random), 0.1 * unit(random) - 0.5);
                const Box3 box(corner, corner + size * Vec3(width(random), width(random), width(random)));
                obstacle.find_faces(box, found);
                EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
                for (int f = 0; f < static_cast<int>(mesh.faces.size()); ++f) {
                    const bool is_found = std::binary_search(found.begin(), found.end(), f);
                    EXPECT_TRUE(!is_found || box.intersects(box_of(mesh, mesh.faces[f])));
                    bool has_corner_inside = false;
                    for (const int p : mesh.faces[f]) has_corner_inside |= box.contains(mesh.points[p]);
                    EXPECT_TRUE(!has_corner_inside || is_found) << "face " << f;
                }
                obstacle.find_corners(box, found);
                std::vector<int> expected;
                for (int c = 0; c < static_cast<int>(obstacle.features().corners.size()); ++c)
                    if (box.contains(mesh.points[obstacle.features().corners[c].point]))
                        expected.push_back(c);
                EXPECT_EQ(found, expected);
            }
        }
}

TEST(Obstacle, TouchingIsExactForTrianglesSegmentsAndPoints)
{
    const ObstacleMesh sheet{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}, {}, {}};
    const Obstacle obstacle = make_obstacle(sheet);
    using List = std::vector<int>;
    List found;
    obstacle.find_faces_touching({0.5, 0.2, 1}, {0.5, 0.2, -1}, found);
    EXPECT_EQ(found, List({0}));
    obstacle.find_faces_touching({0.5, 0.5, 1}, {0.5, 0.5, 0}, found);
    EXPECT_EQ(found, List({0, 1})) << "ends on the common edge";
    obstacle.find_faces_touching({0.5, 0.2, 1}, {0.5, 0.2, 1e-300}, found);
    EXPECT_TRUE(found.empty()) << "ends just above";
    obstacle.find_faces_touching({-1, 0.2, 1e-17}, {2, 0.2, 1e-17}, {0.5, 3, 1e-17}, found);
    EXPECT_TRUE(found.empty()) << "parallel, just above";
    obstacle.find_faces_touching({-1, 0.2, 0}, {2, 0.2, 0}, {0.5, 3, 0}, found);
    EXPECT_EQ(found, List({0, 1})) << "in its plane";
    // Degenerate queries: a triangle that is a line, one that is a point, a segment that is a point.
    obstacle.find_faces_touching({0.9, 0.1, -1}, {0.9, 0.1, 2}, {0.9, 0.1, 0.5}, found);
    EXPECT_EQ(found, List({0}));
    obstacle.find_faces_touching({0.1, 0.9, 0}, {0.1, 0.9, 0}, {0.1, 0.9, 0}, found);
    EXPECT_EQ(found, List({1}));
    obstacle.find_faces_touching({0.1, 0.9, 1e-300}, {0.1, 0.9, 1e-300}, found);
    EXPECT_TRUE(found.empty());
    // An obstacle without faces.
    const Obstacle nail = make_obstacle({{{0, 0, 0}}, {}, {}, {0}});
    nail.find_faces_touching({-1, 0, 0}, {1, 0, 0}, {0, 1, 0}, found);
    EXPECT_TRUE(found.empty());
    nail.find_corners(Box3(Vec3(-1, -1, -1), Vec3(0, 0, 0)), found);
    EXPECT_EQ(found, List({0}));
}

}  // namespace
}  // namespace arris
