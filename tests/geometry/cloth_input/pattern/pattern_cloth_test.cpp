// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/pattern/pattern_cloth.h"

#include "geometry/cloth/material_region.h"
#include "geometry/sort_unique.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <random>

#include "geometry/cloth/mesh_quality.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/cloth/sewing.h"
#include "tests/geometry/cloth_input/pattern/pattern_samples.h"

namespace arris {
namespace {

constexpr double kEdge = 0.03;      // m
constexpr double kRounded = 1e-12;  // m

PatternCloth join(const SewingPattern& pattern, SewnSeams sewn = SewnSeams::WhereTouching)
{
    return join_panels(pattern, mesh_pattern(pattern, kEdge), kEdge, sewn);
}

TEST(SewnVertices, AreNumberedByTheirFirstPoints)
{
    EXPECT_EQ(number_vertices(6, {{4, 1}, {5, 4}, {3, 0}}), (std::vector<int>{0, 1, 2, 0, 1, 1}));
    EXPECT_EQ(number_vertices(3, {}), (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(number_vertices(3, {{2, 2}, {0, 2}, {2, 0}}), (std::vector<int>{0, 1, 0}));
}

TEST(PatternCloth, PanelsLieApartInThePlane)
{
    const SewingPattern pattern = top();
    const PatternMesh meshes = mesh_pattern(pattern, kEdge);
    const PatternCloth cloth = join_panels(pattern, meshes, kEdge);
    EXPECT_EQ(validate(cloth.mesh), "");
    std::vector<Eigen::AlignedBox2d> boxes(2);
    for (std::size_t p = 0; p < 2; ++p) {
        const PlacedPanel& panel = cloth.panels[p];
        EXPECT_EQ(panel.place.name, pattern.panels[p].name);
        EXPECT_NEAR(panel.area, material_area(meshes.panels[p].mesh), kRounded);
        for (int f = panel.first_face; f < panel.first_face + panel.face_count; ++f)
            for (const Vec2& X : cloth.mesh.corners(f)) {
                boxes[p].extend(X);
                EXPECT_EQ(piece_at(std::vector<PiecePlace>{cloth.panels[0].place, cloth.panels[1].place}, X),
                          static_cast<int>(p));
            }
    }
    EXPECT_GE(boxes[1].min().x() - boxes[0].max().x(), 4.0 * kEdge);
    EXPECT_EQ(cloth.panels[1].first_face, cloth.panels[0].face_count);
    EXPECT_EQ(cloth.panels[1].first_face + cloth.panels[1].face_count, cloth.mesh.face_count());
    EXPECT_EQ(cloth.panels[0].place.shift, 0.0) << "the first panel stays";
}

TEST(PatternCloth, PlacesOfThePatternDoNotDependOnTheEdgeLength)
{
    const SewingPattern pattern = top();
    const PatternCloth coarse = join_panels(pattern, mesh_pattern(pattern, 0.05), 0.05);
    const PatternCloth fine = join_panels(pattern, mesh_pattern(pattern, 0.01), 0.01);
    EXPECT_EQ(coarse.panels[1].place.to_plane({0.1, 0.2}), fine.panels[1].place.to_plane({0.1, 0.2}));
}

TEST(PatternCloth, CornersOfThePatternAreFoundInThePlane)
{
    const SewingPattern pattern = top();
    const PatternCloth cloth = join(pattern);
    for (std::size_t p = 0; p < 2; ++p)
        for (const PanelEdge& edge : pattern.panels[p].edges) {
            const Vec2 X = cloth.panels[p].place.to_plane(edge.begin);
            EXPECT_TRUE(std::any_of(cloth.mesh.material.begin(), cloth.mesh.material.end(),
                                    [&](const Vec2& Y) { return (X - Y).norm() < kRounded; }));
        }
}

TEST(PatternCloth, SeamsWhosePairsTouchAreClosed)
{
    SewingPattern pattern = two_rectangles();
    EXPECT_FALSE(join(pattern).seams[0].is_closed);
    EXPECT_FALSE(join(pattern).mesh.has_seams());
    for (const double gap : {0.0, 0.9e-3 * kEdge}) {
        pattern.panels[1].placement.translation.x() = 0.4 + gap;
        const PatternCloth cloth = join(pattern);
        EXPECT_TRUE(cloth.seams[0].is_closed);
        EXPECT_EQ(validate(cloth.mesh), "");
        ASSERT_EQ(cloth.seams[0].pairs.size(), 11U);
        EXPECT_EQ(cloth.mesh.seam_vertices.size(), 11U);
        for (const auto& [a, b] : cloth.seams[0].pairs)
            EXPECT_EQ(cloth.mesh.vertex_of(a), cloth.mesh.vertex_of(b));
    }
    pattern.panels[1].placement.translation.x() = 0.4 + 1.1e-3 * kEdge;
    EXPECT_FALSE(join(pattern).seams[0].is_closed);
}

TEST(PatternCloth, SeamThatTouchesAtSomePairsStaysOpen)
{
    SewingPattern pattern = two_rectangles();
    pattern.panels[1].placement = {rotation_about({0.0, 0.0, 1.0}, 1.0), {0.4, 0.0, 0.0}};
    const PatternCloth cloth = join(pattern);
    EXPECT_FALSE(cloth.seams[0].is_closed);
    EXPECT_FALSE(cloth.mesh.has_seams());
}

TEST(PatternCloth, TiesStayOpenWhereTheyTouch)
{
    SewingPattern pattern = two_rectangles();
    pattern.panels[1].placement.translation.x() = 0.4;
    pattern.seams[0].is_tie = true;
    EXPECT_FALSE(join(pattern).seams[0].is_closed);
    EXPECT_FALSE(join(pattern, SewnSeams::All).seams[0].is_closed);
}

TEST(PatternCloth, PairsNamePointsAtEqualShares)
{
    const PatternCloth cloth = join(top(), SewnSeams::All);
    for (const SeamPoints& seam : cloth.seams) {
        std::array<std::vector<double>, 2> shares;
        for (const std::size_t side : {0U, 1U}) {
            double length = 0.0;
            for (std::size_t k = 0; k < seam.pairs.size(); ++k) {
                if (k > 0)
                    length += (cloth.mesh.material[seam.pairs[k][side]] -
                               cloth.mesh.material[seam.pairs[k - 1][side]])
                                  .norm();
                shares[side].push_back(length);
            }
            for (double& share : shares[side]) share /= length;
        }
        // Chords stand for arcs.
        for (std::size_t k = 0; k < shares[0].size(); ++k) EXPECT_NEAR(shares[0][k], shares[1][k], 1e-3);
    }
}

TEST(PatternCloth, CornersOfSeveralSeamsBecomeOneVertex)
{
    // Four squares around a point.
    SewingPattern pattern;
    for (int p = 0; p < 4; ++p) {
        pattern.panels.push_back(rectangle_panel(std::to_string(p), {0.3, 0.3}));
        pattern.panels.back().placement.rotation = rotation_about({0.0, 0.0, 1.0}, 90.0 * p);
        pattern.seams.push_back(simple_seam(p, 3, (p + 1) % 4, 0));
    }
    const PatternCloth cloth = join(pattern);
    EXPECT_EQ(validate(cloth.mesh), "");
    int points = 0;
    for (std::size_t p = 0; p < cloth.mesh.material.size(); ++p) {
        EXPECT_TRUE(
            std::all_of(cloth.seams.begin(), cloth.seams.end(), [](const auto& s) { return s.is_closed; }));
        points += cloth.mesh.world[cloth.mesh.vertex_of(static_cast<int>(p))].norm() < kRounded ? 1 : 0;
    }
    EXPECT_EQ(points, 4);
    int vertices = 0;
    for (const Vec3& x : cloth.mesh.world) vertices += x.norm() < kRounded ? 1 : 0;
    EXPECT_EQ(vertices, 1);
}

TEST(PatternCloth, AnyChoiceOfSeamsMayBeSewn)
{
    std::mt19937 random(11);
    for (const SewingPattern& pattern : {pillow(), top(), dart(), cone(0.4, 60.0)}) {
        const PatternMesh meshes = mesh_pattern(pattern, kEdge);
        SewingPattern open = pattern;
        for (Seam& seam : open.seams) seam.is_tie = true;
        const PatternCloth apart = join_panels(open, meshes, kEdge);
        for (int trial = 0; trial < 20; ++trial) {
            std::vector<std::array<int, 2>> pairs;
            for (const SeamPoints& seam : apart.seams)
                if (random() % 2 == 1) pairs.insert(pairs.end(), seam.pairs.begin(), seam.pairs.end());
            EXPECT_EQ(validate(sew(apart.mesh, number_vertices(apart.mesh.vertex_count(), pairs))), "");
        }
    }
}

TEST(PatternCloth, LabelsNameLinesOfTheMaterial)
{
    SewingPattern pattern = two_rectangles();
    pattern.panels[1].placement.translation.x() = 0.4;
    pattern.panels[0].edges[2].label = pattern.panels[1].edges[2].label = "top";
    pattern.panels[0].edges[0].label = pattern.panels[0].edges[3].label = "corner";
    const PatternCloth cloth = join(pattern);
    ASSERT_EQ(cloth.labels.size(), 2U);
    EXPECT_EQ(cloth.labels[0].label, "corner");
    const auto held = [&](int label) {
        return vertices_inside(cloth.mesh, MaterialRegion::along(cloth.labels[label].lines));
    };
    EXPECT_EQ(held(0).size(), 15U + 11U - 1U) << "the corner of both edges is there once";
    EXPECT_EQ(cloth.labels[1].label, "top");
    std::vector<int> expected;
    for (int p = 0; p < static_cast<int>(cloth.mesh.material.size()); ++p)
        if (cloth.mesh.material[p].y() == 0.3) expected.push_back(cloth.mesh.vertex_of(p));
    sort_unique(expected);
    EXPECT_EQ(held(1), expected);
}

}  // namespace
}  // namespace arris
