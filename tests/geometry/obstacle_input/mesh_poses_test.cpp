// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/deform/mesh_poses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "geometry/input_error.h"
#include "tests/app/error_of.h"

namespace arris {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

using Samples = std::vector<std::vector<Vec3>>;

/// A cache in memory, with samples half a second apart.
class MemoryCache : public VertexCache {
  public:
    explicit MemoryCache(Samples samples)
        : VertexCache(times(samples.size()), false), samples_(std::move(samples))
    {
    }

    std::string describe(std::size_t sample) const override
    {
        return "m.pc2: sample " + std::to_string(sample);
    }
    void read(std::size_t sample, std::vector<Vec3>& vertices) override { vertices = samples_.at(sample); }

  private:
    static std::vector<double> times(std::size_t count)
    {
        std::vector<double> times;
        for (std::size_t k = 0; k < count; ++k) times.push_back(0.5 * static_cast<double>(k));
        return times;
    }

    Samples samples_;
};

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A square of two faces. Its file has 6 vertices: 0 is unused, 5 is joined with 2.
struct Square {
    ObstacleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}, {}, {}};
    VertexOrigins origins{6, {1, 2, 3, 4}, {{2, 5}}, 1e-6};
    FileFrame frame;

    static std::vector<Vec3> vertices()
    {
        return {{kNan, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, 5e-7}};
    }

    /// Points of the last sample.
    std::vector<Vec3> read(const Samples& samples, PoseSurvey* survey = nullptr) const
    {
        MemoryCache cache(samples);
        MeshPoses poses(cache, mesh, origins, frame);
        std::vector<Vec3> points;
        for (std::size_t k = 0; k < samples.size(); ++k) poses.read_next(points);
        if (survey) *survey = poses.survey();
        return points;
    }
    std::string refusal(const Samples& samples) const
    {
        const std::string error = error_of([&] { read(samples); });
        EXPECT_EQ(error.find('\n'), std::string::npos);
        return error;
    }
};

std::vector<Vec3> with(int vertex, const Vec3& place)
{
    std::vector<Vec3> vertices = Square::vertices();
    vertices[vertex] = place;
    return vertices;
}

TEST(MeshPoses, TakeEachPointFromItsVertex)
{
    const Square square;
    EXPECT_EQ(square.read({Square::vertices()}), square.mesh.points);
}

TEST(MeshPoses, GoThroughUnitAxisAndScaleOfTheMesh)
{
    Square square;
    for (Vec3& point : square.mesh.points) point = 3.0 * Vec3(0.01 * point.x(), 0, 0.01 * point.y());
    square.frame = {0.01, 'y', 3.0};
    const std::vector<Vec3> points = square.read({Square::vertices()});
    for (std::size_t p = 0; p < 4; ++p) EXPECT_LT((points[p] - square.mesh.points[p]).norm(), 1e-15);
}

TEST(MeshPoses, APlaceMustBeFiniteAndNear)
{
    const Square square;
    EXPECT_EQ(square.refusal({Square::vertices(), with(3, {kNan, 1, 0})}),
              "m.pc2: sample 1, vertex 4 (nan, 1, 0): allowed: finite and within 1e+06 m of the origin");
    for (const Vec3& wrong : {Vec3(1.1e6, 1, 0), Vec3(0, kNan, 1), Vec3(0, 1, kNan), Vec3(-INFINITY, 0, 0)})
        EXPECT_THAT(square.refusal({with(3, wrong)}), HasSubstr("sample 0, vertex 4"));
    EXPECT_THAT(square.refusal({with(5, {kNan, 1, 0})}), HasSubstr("vertex 6"));
}

TEST(MeshPoses, JoinedVerticesMustStayTogether)
{
    const Square square;
    EXPECT_EQ(
        square.refusal({Square::vertices(), with(5, {1, 0, 2e-6})}),
        "m.pc2: sample 1, vertices 3 and 6 are 2e-06 m apart, but are one point of the mesh, where they "
        "coincide; allowed: at most 1e-06 m");
}

TEST(MeshPoses, AnotherUnitOrOrderIsFoundAtTheFirstSample)
{
    Square square;
    square.origins.joined.clear();
    square.frame.metres_per_unit = 0.01;
    EXPECT_THAT(square.refusal({Square::vertices()}),
                AllOf(HasSubstr("its edges are 0.01 times as long"), HasSubstr("a factor of at most 3")));
    square.frame.metres_per_unit = 2.9;
    EXPECT_EQ(square.refusal({Square::vertices()}), "");
    square.frame.metres_per_unit = 1.0 / 2.9;
    EXPECT_EQ(square.refusal({Square::vertices()}), "");
}

TEST(MeshPoses, PointsOfTheRepairHaveNoVertex)
{
    Square square;
    square.origins.of_points[2] = -1;
    EXPECT_THAT(square.refusal({Square::vertices()}),
                HasSubstr("1 of its points come from the mesh's repair"));
}

TEST(MeshPoses, SurveyTellsTheWorstSamples)
{
    std::vector<Vec3> flat = Square::vertices(), far = flat;
    flat[3] = {0.5, 0, 0};  // the first face: three points of a line
    far[4] = {0, 3, 0};
    PoseSurvey survey;
    Square().read({Square::vertices(), flat, flat, far}, &survey);
    EXPECT_EQ(survey.most_collapsed, 1);
    EXPECT_EQ(survey.collapsed_at, 1U);
    EXPECT_EQ(survey.greatest_move, 2.0);
    EXPECT_EQ(survey.moved_at, 3U);
    EXPECT_EQ(survey.moved_vertex, 4);
    EXPECT_EQ(survey.greatest_speed, 4.0);
    Square().read({Square::vertices()}, &survey);
    EXPECT_EQ(survey.most_collapsed, 0);
    EXPECT_EQ(survey.greatest_speed, 0.0);
}

}  // namespace
}  // namespace arris
