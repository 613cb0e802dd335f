// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/export/resampled_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "geometry/cloth/cloth_mesh.h"
#include "tests/app/error_of.h"

namespace arris {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::HasSubstr;

constexpr double kRounding = 1e-14;  // m and m/s, of numbers up to 10
constexpr double kEdge = 1e-5;       // m: ten times the way inside from a border

/// Values that linear triangles hold exactly, whatever the mesh.
Vec3 place(const Vec2& X)
{
    return {2.0 * X.x() - X.y(), 0.5 + X.y(), 3.0 * X.x()};
}
Vec3 speed(const Vec2& X)
{
    return {X.y(), -X.x(), 1.0 + X.x()};
}

Frame make_frame(const std::vector<Vec2>& material, const std::vector<Face>& faces)
{
    Frame frame;
    frame.material = material;
    frame.faces = faces;
    for (const Vec2& X : material) {
        frame.ids.push_back(static_cast<std::uint32_t>(100 + frame.ids.size()));
        frame.world.push_back(place(X));
        frame.material_velocity.push_back(speed(X));
        frame.vertex_velocity.emplace_back(9.0, 9.0, 9.0);
        frame.eol.push_back(1);
        frame.contact.push_back(X.x() > 0.5 ? 1 : 0);
    }
    for (const Face& face : faces) {
        const double area = 0.5 * twice_area(material[face[0]], material[face[1]], material[face[2]]);
        frame.strain.push_back(0.25);
        frame.stretch_energy.push_back(3.0 * area);
        frame.bending_energy.push_back(5.0 * area);
    }
    frame.eol_edges = {{0, 1}};
    return frame;
}

/// The unit square, fanned about `centre`, its border cut at random points.
Frame make_fan(const Vec2& centre, unsigned seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    std::vector<Vec2> material;
    for (const auto& [a, b] :
         {std::pair<Vec2, Vec2>({0, 0}, {1, 0}), {{1, 0}, {1, 1}}, {{1, 1}, {0, 1}}, {{0, 1}, {0, 0}}}) {
        material.push_back(a);
        material.push_back(a + share(random) * (b - a));
    }
    material.push_back(centre);
    std::vector<Face> faces;
    for (int k = 0; k < 8; ++k) faces.push_back({k, (k + 1) % 8, 8});
    return make_frame(material, faces);
}

FrameSource source_of(const std::vector<Frame>& frames)
{
    return {frames.size(), [frames](std::size_t i) { return frames[i]; }};
}

TEST(ResampledFrames, LinearFieldsAreExactOnAnyMesh)
{
    const FrameSource frames =
        source_of({make_fan({0.5, 0.5}, 1), make_fan({0.2, 0.7}, 2), make_fan({0.9, 0.1}, 3)});
    for (const std::optional<GridSize>& grid : {std::optional<GridSize>(), std::optional<GridSize>({7, 5})}) {
        const ConstantMesh mesh = make_constant_mesh(frames.read(0), grid);
        const FrameSource resampled = resampled_frames(frames, mesh);
        ASSERT_EQ(resampled.count, 3U);
        for (std::size_t i = 0; i < 3; ++i) {
            const Frame frame = resampled.read(i);
            EXPECT_EQ(frame.faces, mesh.faces);
            EXPECT_EQ(frame.material, mesh.material);
            EXPECT_EQ(frame.ids, mesh.ids);
            EXPECT_TRUE(frame.eol_edges.empty());
            EXPECT_THAT(frame.eol, Each(0));
            EXPECT_THAT(frame.strain, Each(0.25));
            double stretch = 0.0, bending = 0.0;
            for (const double energy : frame.stretch_energy) stretch += energy;
            for (const double energy : frame.bending_energy) bending += energy;
            EXPECT_NEAR(stretch, 3.0, kRounding * 10);
            EXPECT_NEAR(bending, 5.0, kRounding * 10);
            ASSERT_EQ(frame.world.size(), mesh.material.size());
            for (std::size_t v = 0; v < mesh.material.size(); ++v) {
                EXPECT_LT((frame.world[v] - place(mesh.material[v])).norm(), kRounding) << v;
                EXPECT_LT((frame.vertex_velocity[v] - speed(mesh.material[v])).norm(), kRounding) << v;
                EXPECT_EQ(frame.material_velocity[v], frame.vertex_velocity[v]);
            }
        }
    }
}

TEST(ResampledFrames, VertexOfTheFrameIsTakenAsItIs)
{
    Frame frame = make_fan({0.5, 0.5}, 1);
    frame.world[8] = {7.0, 1.0 / 3.0, -0.0};
    const FrameSource frames = source_of({frame});
    const Frame read = resampled_frames(frames, make_constant_mesh(frame, {})).read(0);
    EXPECT_EQ(read.world, frame.world);
    EXPECT_EQ(read.contact, frame.contact);
}

/// Two squares side by side in material space, 5 m apart in the world. The frame's vertices on the shared
/// line are other ones than those of the constant mesh.
TEST(ResampledFrames, PiecesWhoseChartsTouchStayApart)
{
    const auto make = [](double cut, std::uint32_t first_id) {
        Frame frame =
            make_frame({{0, 0}, {1, 0}, {1, cut}, {1, 1}, {0, 1}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {1, cut}},
                       {{0, 1, 2}, {0, 2, 4}, {2, 3, 4}, {5, 6, 9}, {6, 7, 9}, {7, 8, 9}});
        for (std::uint32_t& id : frame.ids) id += first_id;
        for (int v = 5; v < 10; ++v) frame.world[v].x() += 5.0;
        return frame;
    };
    const FrameSource frames = source_of({make(0.5, 0), make(0.25, 1000)});
    const Frame read = resampled_frames(frames, make_constant_mesh(frames.read(0), {})).read(1);
    for (int v = 0; v < 10; ++v) {
        const Vec3 wanted = place(read.material[v]) + Vec3(v < 5 ? 0.0 : 5.0, 0.0, 0.0);
        EXPECT_LT((read.world[v] - wanted).norm(), kEdge) << v;
    }
}

TEST(ResampledFrames, GridCoversTheRectangleOnce)
{
    const ConstantMesh mesh = make_constant_mesh(make_fan({0.5, 0.5}, 1), GridSize{3, 2});
    EXPECT_EQ(mesh.material.size(), 12U);
    EXPECT_EQ(mesh.faces.size(), 12U);
    EXPECT_EQ(mesh.material.back(), Vec2(1.0, 1.0));
    for (const Face& face : mesh.faces)
        EXPECT_NEAR(twice_area(mesh.material[face[0]], mesh.material[face[1]], mesh.material[face[2]]),
                    1.0 / 6.0, kRounding);
}

TEST(ResampledFrames, GridIsRefusedWhereTheClothIsNoRectangle)
{
    const Frame triangle = make_frame({{0, 0}, {1, 0}, {0, 1}}, {{0, 1, 2}});
    Frame slit = make_fan({0.5, 0.5}, 1);
    slit.material.push_back(slit.material[0]);  // the first corner twice: a slit from there to the centre
    slit.faces.front()[0] = 9;
    for (const Frame& frame : {triangle, slit, Frame()})
        EXPECT_THAT(error_of([&] {
                        make_constant_mesh(frame, GridSize{2, 2});
                    }),
                    AllOf(HasSubstr("--grid"), HasSubstr("rectangle")));
}

TEST(ResampledFrames, ClothThatIsMissingIsRefusedAndRoundingIsNot)
{
    const Frame whole = make_fan({0.5, 0.5}, 1);
    const auto error_at = [&](double side) {
        const Frame part = make_frame({{0, 0}, {side, 0}, {side, 1}, {0, 1}}, {{0, 1, 2}, {0, 2, 3}});
        return error_of([&] {
            resampled_frames(source_of({whole, part}), make_constant_mesh(whole, GridSize{3, 3})).read(1);
        });
    };
    EXPECT_EQ(error_at(1.0 - 1e-12), "");
    EXPECT_THAT(error_at(0.9), AllOf(HasSubstr("frame 1"), HasSubstr("(1, 0)")));
}

TEST(ResampledFrames, GridIsReadFromText)
{
    EXPECT_EQ(parse_grid("40x30").u, 40);
    EXPECT_EQ(parse_grid("40x30").v, 30);
    for (const char* text :
         {"", "40", "40x", "x30", "0x3", "3x-1", "3x3x3", "10001x1", "4 x3", "99999999999x1"})
        EXPECT_THAT(error_of([&] { parse_grid(text); }), AllOf(HasSubstr("--grid: \""), HasSubstr("40x30")))
            << text;
}

}  // namespace
}  // namespace arris
