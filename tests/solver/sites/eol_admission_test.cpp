// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/sites/eol_decision.h"

#include <gtest/gtest.h>

#include "tests/geometry/sample_obstacles.h"
#include "tests/solver/eol_cloth.h"

namespace arris {
namespace {

/// Whether a vertex at the offset `off` (m) from the tip of a ridge of 60 degrees may be EOL there.
bool may_be_at(const Vec3& off)
{
    testing::EolCloth cloth = testing::lying(0.0, 0.5 * testing::kLyingCell);
    const int v = cloth.vertex_at(0.2, 0.2);
    cloth.state.mesh.world[v] = Vec3(0.0, cloth.state.mesh.world[v].y(), 0.0) + off;
    const int entry = cloth.add_eol(v, false, testing::tip_of(cloth.scene.obstacles[0].shape()));
    const ClothStars stars = cloth.stars();
    const TraceMesh trace(cloth.scene, cloth.state, stars, {});
    return EolAdmission(cloth.scene, cloth.state, stars, trace, 0.02).is_in_plane(cloth.state.eol[entry]);
}

TEST(EolAdmission, OnAnEdgeOnlyInThePlaneInWhichAVertexMayMove)
{
    constexpr double kNear = 2.0 * testing::kThickness;
    EXPECT_TRUE(may_be_at(Vec3(0.0, 0.0, kNear)));
    EXPECT_FALSE(may_be_at(Vec3(kNear, 0.0, 0.0)));
    EXPECT_FALSE(may_be_at(Vec3(0.5 * kNear, 0.0, kNear)));
}

// A free fold is beyond both faces of its edge. A vertex beside one of the faces belongs to no fold. Held to
// the edge as an EOL vertex, it made a pleat at a table's corner snag.
TEST(EolAdmission, OfWhatHasLeftAnEdgeOnlyBeyondBothItsFaces)
{
    constexpr double kFar = 20.0 * testing::kThickness;
    for (const double side : {-1.0, 1.0}) {
        EXPECT_TRUE(may_be_at(Vec3(side * 0.3 * kFar, 0.0, kFar)));
        EXPECT_FALSE(may_be_at(Vec3(side * kFar, 0.0, 0.0)));
        EXPECT_FALSE(may_be_at(Vec3(side * kFar, 0.0, -kFar)));
    }
}

struct FineFeatures {
    const char* name;
    ObstacleMesh mesh;
    int edges;    ///< that cells of 50 mm cannot follow; -1: all
    int corners;  ///< where one of the obstacle's corners has a vertex within half a cell; -1: all but that
                  ///< one
};

// A post, a small box or the facets of a rough stone would get an EOL vertex at each corner and edge, with
// faces as small as they are. Cloth has room for one vertex there.
TEST(EolAdmission, OfWhatIsFinerThanTheCellsOnlyOneCorner)
{
    const auto box = [](double x, double y, double z) { return samples::box({0, 0, 0}, {x, y, z}); };
    const auto scaled = [](const ObstacleMesh& mesh, double by) {
        return samples::moved(mesh, [by](const Vec3& x) -> Vec3 { return by * x; });
    };
    const FineFeatures kCases[] = {
        {"post of 2 mm", box(0.002, 0.002, 0.1), 8, -1},
        {"cube below a cell", box(0.049, 0.049, 0.049), 12, -1},
        {"cube above a cell", box(0.051, 0.051, 0.051), 0, 0},
        {"blade, of whose corners two edges go on", box(0.3, 0.002, 0.3), 4, 0},
        {"thin plate", box(0.3, 0.3, 0.002), 4, 0},
        {"table", box(1.0, 0.7, 0.7), 0, 0},
        {"ball of small facets", scaled(samples::sphere(6, 8), 0.02), -1, -1},
        {"ball of large facets", scaled(samples::sphere(6, 8), 1.0), 0, 0},
        {"rim of many short edges", samples::cylinder(40), 0, 0},
        {"nails", samples::nails({{0, 0, 0}, {0.001, 0, 0}}), 0, 0},
        {"frame of short wires",
         samples::wire({{0, 0, 0}, {0.01, 0, 0}, {0.01, 0.01, 0}, {0, 0.01, 0}}, true), 0, 0},
        {"small sheet's border", scaled(samples::sheet(2, 2, [](int, int) { return 0.0; }), 0.01), 0, 0},
    };
    for (const FineFeatures& one : kCases) {
        SCOPED_TRACE(one.name);
        testing::EolCloth cloth(MovingObstacle("it", one.mesh, {}, {}, 14.0),
                                testing::make_draped({8, 0.0, 180.0, 1.0}));
        const ObstacleFeatures& features = cloth.scene.obstacles[0].shape().features();
        const int v = cloth.vertex_at(0.2, 0.2);
        const ClothStars stars = cloth.stars();
        const auto count = [&](bool is_corner) {
            const TraceMesh trace(cloth.scene, cloth.state, stars, {});
            const EolAdmission admission(cloth.scene, cloth.state, stars, trace, 0.02);
            const std::size_t size = is_corner ? features.corners.size() : features.edges.size();
            int found = 0;
            for (int k = 0; k < static_cast<int>(size); ++k) {
                const FeatureId on = is_corner ? FeatureId::corner(0, k) : FeatureId::edge(0, k);
                const FeatureSite site{on, Vec2(0.21, 0.2), cloth.state.ids[v], Vec3::UnitZ()};
                found += admission.find_refusal(site, v, Vec2::Zero()) == ConstraintCause::Unresolved;
            }
            return found;
        };
        EXPECT_EQ(count(false), one.edges < 0 ? static_cast<int>(features.edges.size()) : one.edges);
        EXPECT_EQ(count(true), 0) << "none has a vertex yet";
        if (features.corners.empty()) continue;
        cloth.add_eol(v, true, 0);
        EXPECT_EQ(count(true), one.corners < 0 ? static_cast<int>(features.corners.size()) - 1 : one.corners);
    }
}

}  // namespace
}  // namespace arris
