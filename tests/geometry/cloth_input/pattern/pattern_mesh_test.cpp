// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/pattern/pattern_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "geometry/cloth/euler_characteristic.h"
#include "geometry/cloth/mesh_quality.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/input_error.h"
#include "tests/geometry/cloth_input/pattern/pattern_samples.h"

namespace arris {
namespace {

using ::testing::HasSubstr;

constexpr double kRounded = 1e-12;  // relative
constexpr double kPi = std::numbers::pi;

ClothMesh sewn_mesh(const SewingPattern& pattern, double edge_length)
{
    return join_panels(pattern, mesh_pattern(pattern, edge_length), edge_length, SewnSeams::All).mesh;
}

double least_angle(const PatternMesh& meshes)
{
    double least = 180.0;
    for (const PanelMesh& panel : meshes.panels) least = std::min(least, least_material_angle(panel.mesh));
    return least;
}

std::string refusal(const SewingPattern& pattern, double edge_length)
{
    try {
        mesh_pattern(pattern, edge_length);
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(PatternMesh, CanBeSewnAtEveryEdgeLength)
{
    for (const double edge_length : {0.1, 0.06, 0.05, 0.031, 0.02, 0.01}) {
        EXPECT_EQ(find_fault(two_rectangles(), edge_length), "") << edge_length;
        EXPECT_EQ(find_fault(pillow(), edge_length), "") << edge_length;
        EXPECT_EQ(find_fault(tube(0.4, 0.3), edge_length), "") << edge_length;
        EXPECT_EQ(find_fault(dart(), edge_length), "") << edge_length;
        EXPECT_EQ(find_fault(top(), edge_length), "") << edge_length;
        EXPECT_EQ(find_fault(moebius_strip(), edge_length), "") << edge_length;
        for (const double degrees : {10.0, 40.0, 60.0, 90.0, 170.0, 250.0, 340.0}) {
            if (0.4 * degrees * kPi / 180.0 <= 2.0 * edge_length)
                continue;  // fewer than three edges go round
            EXPECT_EQ(find_fault(cone(0.4, degrees), edge_length), "") << degrees << ", " << edge_length;
        }
    }
}

TEST(PatternMesh, HasTheTopologyOfTheGarment)
{
    struct Case {
        const char* name;
        SewingPattern pattern;
        int euler, loops;
    };
    for (const Case& c : {Case{"two rectangles", two_rectangles(), 1, 1}, Case{"pillow", pillow(), 2, 0},
                          Case{"tube", tube(0.4, 0.3), 0, 2}, Case{"dart", dart(), 1, 1},
                          Case{"cone", cone(0.3, 100.0), 1, 1}, Case{"top", top(), -2, 4}}) {
        const ClothMesh sewn = sewn_mesh(c.pattern, 0.03);
        EXPECT_EQ(euler_characteristic(sewn), c.euler) << c.name;
        EXPECT_EQ(count_border_loops(sewn), c.loops) << c.name;
    }
}

TEST(PatternMesh, AnglesAreAtLeastTwentyFiveDegrees)
{
    for (const double edge_length : {0.05, 0.03, 0.02, 0.01})
        for (const SewingPattern& pattern :
             {two_rectangles(), pillow(), tube(0.4, 0.3), dart(), cone(0.3, 100.0)})
            EXPECT_GT(least_angle(mesh_pattern(pattern, edge_length)), 25.0)
                << pattern.panels[0].name << ", " << edge_length;
}

TEST(PatternMesh, StraightPanelsKeepTheirArea)
{
    EXPECT_NEAR(material_area(sewn_mesh(two_rectangles(), 0.02)), 0.24, kRounded);
    EXPECT_NEAR(material_area(sewn_mesh(dart(), 0.02)), 0.25 - 0.5 * 0.06 * 0.2, kRounded);
}

TEST(PatternMesh, CurvedPanelsKeepTheirAreaToOneInAThousand)
{
    constexpr double kChords = 1e-3;  // relative, at edges of 2 cm
    const double sector = 0.5 * 0.3 * 0.3 * 100.0 * kPi / 180.0;
    EXPECT_NEAR(material_area(sewn_mesh(cone(0.3, 100.0), 0.02)), sector, kChords * sector);
    SewingPattern pattern;
    pattern.panels = {rectangle_panel("front", {0.2, 0.4})};
    const double radius = 0.34 / 3.0, half = std::asin(0.1 / radius);
    pattern.panels[0].edges[1].shape = BezierCurve{{Vec2(0.26, 0.2)}};
    pattern.panels[0].edges[2].shape = CircularArc{radius, false, false};
    pattern.panels[0].edges[3].shape = BezierCurve{{Vec2(0.03, 0.3), Vec2(0.03, 0.1)}};
    // Under a parabola lie 2/3 of its triangle. Under this cubic lies 9 a L (1/40 + 1/30), with a aside at
    // 1/4 and 3/4 of the chord L.
    const double bulge = 2.0 / 3.0 * 0.5 * 0.4 * 0.06, dent = 9.0 * 0.03 * 0.4 * (1.0 / 40.0 + 1.0 / 30.0);
    const double neckline = radius * radius * (half - 0.5 * std::sin(2.0 * half));
    const double area = 0.08 + bulge - dent - neckline;
    EXPECT_NEAR(material_area(sewn_mesh(pattern, 0.02)), area, kChords * area);
}

TEST(PatternMesh, LiesInTheWorldWhereItsPanelsAre)
{
    SewingPattern pattern = top();
    pattern.panels[1].placement = {rotation_about({1.0, 2.0, 3.0}, 40.0), {1.0, -2.0, 0.5}};
    const PatternMesh meshes = mesh_pattern(pattern, 0.05);
    for (std::size_t p = 0; p < 2; ++p) {
        const PanelMesh& panel = meshes.panels[p];
        for (int v = 0; v < panel.mesh.vertex_count(); ++v) {
            const Vec2& X = panel.mesh.material[v];
            const Vec3 uv(panel.is_mirrored ? -X.x() : X.x(), X.y(), 0.0);
            EXPECT_NEAR((panel.mesh.world[v] - pattern.panels[p].placement(uv)).norm(), 0.0, kRounded);
        }
    }
}

TEST(PatternMesh, RightSideIsWhereTheLoopRunsCounterClockwise)
{
    SewingPattern pattern = pillow();
    const auto normal_z = [&](std::size_t p) {
        const ClothMesh mesh = mesh_pattern(pattern, 0.05).panels[p].mesh;
        const auto& [a, b, c] = mesh.faces[0];
        return (mesh.world[b] - mesh.world[a]).cross(mesh.world[c] - mesh.world[a]).normalized().z();
    };
    EXPECT_NEAR(normal_z(0), 1.0, kRounded) << "outward, at the upper panel";
    EXPECT_NEAR(normal_z(1), -1.0, kRounded) << "outward, at the lower panel";
    EXPECT_TRUE(mesh_pattern(pattern, 0.05).panels[1].is_mirrored);
    pattern.seams.clear();
    pattern.panels[1].is_turned_over = true;
    EXPECT_NEAR(normal_z(1), 1.0, kRounded);
}

TEST(PatternMesh, EdgesKnowTheirVertices)
{
    const PatternMesh meshes = mesh_pattern(tube(0.4, 0.3), 0.1);
    EXPECT_THAT(meshes.panels[0].vertices_of(0), ::testing::ElementsAre(0, 1, 2, 3, 4));
    EXPECT_THAT(meshes.panels[0].vertices_of(3), ::testing::ElementsAre(11, 12, 13, 0));
}

TEST(PatternMesh, IsTheSameEachTime)
{
    const PatternMesh one = mesh_pattern(top(), 0.017), other = mesh_pattern(top(), 0.017);
    for (std::size_t p = 0; p < one.panels.size(); ++p) {
        EXPECT_EQ(one.panels[p].mesh.material, other.panels[p].mesh.material);
        EXPECT_EQ(one.panels[p].mesh.world, other.panels[p].mesh.world);
        EXPECT_EQ(one.panels[p].mesh.faces, other.panels[p].mesh.faces);
    }
    EXPECT_EQ(one.seams, other.seams);
}

TEST(PatternMesh, EstimateIsWithinThirtyPerCent)
{
    for (const double edge_length : {0.05, 0.02, 0.01}) {
        double vertices = 0.0;
        for (const PanelMesh& panel : mesh_pattern(top(), edge_length).panels)
            vertices += panel.mesh.vertex_count();
        EXPECT_NEAR(estimate_pattern(top(), edge_length).vertices, vertices, 0.3 * vertices) << edge_length;
    }
}

TEST(PatternMesh, RefusesEdgeLengthsThatDoNotFit)
{
    EXPECT_EQ(refusal(two_rectangles(), 0.0),
              "edges of 0 m; allowed: above 0, up to the largest panel's diagonal of 0.5 m");
    EXPECT_EQ(refusal(two_rectangles(), std::nan("")),
              "edges of nan m; allowed: above 0, up to the largest panel's diagonal of 0.5 m");
    EXPECT_EQ(refusal(two_rectangles(), 0.51),
              "edges of 0.51 m; allowed: above 0, up to the largest panel's diagonal of 0.5 m");
    EXPECT_THAT(refusal(two_rectangles(), 1e-5),
                HasSubstr("would give about 2.88e+09 vertices; at most 5e+06"));
    EXPECT_THAT(refusal(tube(1e4, 1e-3), 2e-2),
                HasSubstr("panel \"tube\": with edges of 0.02 m its border would have"));
}

TEST(PatternMesh, RefusesEdgesFarBelowTheEdgeLength)
{
    const auto with_edge = [](double length) {
        SewingPattern pattern;
        pattern.panels = {
            polygon_panel("right", {{0.0, 0.0}, {0.4, 0.0}, {0.4, 0.3}, {length, 0.3}, {0.0, 0.3}})};
        return pattern;
    };
    EXPECT_EQ(
        refusal(with_edge(1.9e-5), 0.02),
        "panel \"right\", edge 3: is 1.9e-05 m long; allowed: at least 0.001 of the edge length of 0.02 m");
    EXPECT_EQ(refusal(with_edge(2.1e-5), 0.02), "accepted");
}

TEST(PatternMesh, RefusesTubesWithFewerThanThreeEdgesAround)
{
    EXPECT_EQ(
        refusal(tube(0.4, 0.3), 0.25),
        "panel \"tube\", edge 0: sewn, fewer than three edges of the mesh would go round here; allowed: "
        "openings and tubes longer than twice the edge length of 0.25 m");
    EXPECT_EQ(find_fault(tube(0.4, 0.3), 0.19), "");
}

TEST(PatternMesh, RefusesShapesThatAreLostOnceDivided)
{
    // A full circle of two arcs and a short line becomes a sliver with edges as long as its diameter.
    SewingPattern pattern;
    pattern.panels = {polygon_panel("disc", {{0.0, 0.0}, {0.2, 0.0}, {0.2, 0.01}})};
    pattern.panels[0].edges[0].shape = CircularArc{0.1, false, true};
    pattern.panels[0].edges[2].shape = CircularArc{0.101, false, true};
    EXPECT_THAT(refusal(pattern, 0.19),
                HasSubstr("panel \"disc\": with edges of 0.19 m its area changes by"));
    EXPECT_EQ(refusal(pattern, 0.02), "accepted");
    // A curve below a line of corners that follows it at 5 mm: half as many chords cut through that line.
    SewingPattern crescent;
    crescent.panels = {polygon_panel(
        "moon",
        {{0.0, 0.0}, {0.2, 0.0}, {0.2, 0.005}, {0.15, -0.025}, {0.1, -0.035}, {0.05, -0.025}, {0.0, 0.005}})};
    crescent.panels[0].edges[0].shape = BezierCurve{{Vec2(0.1, -0.08)}};
    EXPECT_THAT(refusal(crescent, 0.2),
                HasSubstr("panel \"moon\": with edges of 0.2 m its loop its side from"));
    EXPECT_EQ(refusal(crescent, 0.02), "accepted");
}

TEST(PatternMesh, TieBetweenSeamsDoesNotMakeItsEdgesOne)
{
    // Both ends of a tie shorter than an edge are sewn by the seams beside it.
    SewingPattern pattern;
    for (const char* name : {"upper", "lower"})
        pattern.panels.push_back(
            polygon_panel(name, {{0.0, 0.0}, {0.2, 0.0}, {0.22, 0.0}, {0.4, 0.0}, {0.4, 0.3}, {0.0, 0.3}}));
    pattern.panels[1].edges[1].begin.x() = 0.18;
    pattern.panels[1].edges[2].begin.x() = 0.2;
    for (int e = 0; e < 3; ++e) pattern.seams.push_back(simple_seam(0, e, 1, 2 - e));
    pattern.seams[1].is_tie = true;
    EXPECT_EQ(find_fault(pattern, 0.05), "");
}

TEST(PatternMesh, PlacesOfATieAreVerticesOfGoodFaces)
{
    SewingPattern pattern = two_rectangles();
    pattern.panels.push_back(rectangle_panel("pocket", {0.12, 0.1}));
    Seam tie = simple_seam(2, 0, 0, 0);
    tie.sides[1] = {0, 0, 0, false, {Vec2(0.13, 0.11), Vec2(0.25, 0.13)}};
    tie.is_tie = true;
    pattern.seams.push_back(tie);
    for (const bool is_mirrored : {false, true}) {
        pattern.panels[0].is_turned_over = pattern.panels[1].is_turned_over = is_mirrored;
        EXPECT_EQ(find_fault(pattern, 0.025), "");
        const PatternMesh meshes = mesh_pattern(pattern, 0.025);
        ASSERT_EQ(meshes.seams[1].size(), 6U);
        for (std::size_t k = 0; k < 6; ++k) {
            const Vec3 place = meshes.panels[0].mesh.world[meshes.seams[1][k][1].vertex];
            EXPECT_LT((place - Vec3(0.13 + 0.024 * double(k), 0.11 + 0.004 * double(k), 0.0)).norm(), 1e-12);
        }
        EXPECT_GT(least_material_angle(meshes.panels[0].mesh), 25.0);
    }
}

TEST(PatternMesh, SinglesAndStripsAreSewnToo)
{
    // Triangles of one face each: a tetrahedron's net of four panels.
    const double height = 0.05 * std::sqrt(3.0);
    SewingPattern net;
    for (int p = 0; p < 4; ++p)
        net.panels.push_back(polygon_panel(std::to_string(p), {{0.0, 0.0}, {0.1, 0.0}, {0.05, height}}));
    for (int e = 0; e < 3; ++e) {
        net.seams.push_back(simple_seam(0, e, 1 + e, 0));
        net.seams.push_back(simple_seam(1 + e, 1, 1 + (e + 2) % 3, 2));
    }
    EXPECT_EQ(find_fault(net, 0.1), "");
    const ClothMesh closed = sewn_mesh(net, 0.1);
    EXPECT_EQ(euler_characteristic(closed), 2);
    EXPECT_EQ(count_border_loops(closed), 0);
    // A strip as wide as an edge, sewn along both sides between two panels.
    SewingPattern strip;
    strip.panels = {rectangle_panel("above", {0.5, 0.2}), rectangle_panel("strip", {0.5, 0.02}),
                    rectangle_panel("below", {0.5, 0.2})};
    strip.seams = {simple_seam(0, 0, 1, 2), simple_seam(1, 0, 2, 2)};
    EXPECT_EQ(find_fault(strip, 0.02), "");
    EXPECT_GT(least_angle(mesh_pattern(strip, 0.02)), 20.0);
}

}  // namespace
}  // namespace arris
