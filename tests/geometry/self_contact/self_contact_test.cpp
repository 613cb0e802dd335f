// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/self_contact/self_contact_search.h"
#include "geometry/self_contact/self_intersection.h"
#include "geometry/self_contact/self_sweep.h"

namespace arris {
namespace {

constexpr double kThickness = 1e-3;

/// Sheets of one mesh, at rest or moving.
struct Sheets {
    std::vector<Face> faces;
    std::vector<Vec3> begin, end;

    void add(int cells, GridPattern pattern, const Vec3& corner, const Vec3& way = Vec3::Zero())
    {
        ClothGrid grid;
        grid.resolution = {cells, cells};
        grid.pattern = pattern;
        const ClothMesh mesh = make_cloth_grid(grid);
        const int first = static_cast<int>(begin.size());
        for (const Face& f : mesh.faces) faces.push_back({f[0] + first, f[1] + first, f[2] + first});
        for (const Vec2& p : mesh.material) {
            begin.push_back(corner + Vec3(p.x(), p.y(), 0.0));
            end.push_back(begin.back() + way);
        }
    }
    SelfSurface surface() const
    {
        const int n = static_cast<int>(begin.size());
        return {n, faces, make_topology(n, faces)};
    }
    std::vector<SelfContact> contacts() const
    {
        return find_self_contacts(surface(), {begin, end}, kThickness);
    }
    SelfSweepReport check() const { return check_self_sweep(surface(), {begin, end}, kThickness); }
};

TEST(SelfContact, FlatClothHasNone)
{
    for (const GridPattern pattern : {GridPattern::Diagonal, GridPattern::Cross, GridPattern::Unstructured}) {
        Sheets sheets;
        sheets.add(12, pattern, Vec3::Zero(), {3.0, -2.0, 1.0});
        EXPECT_TRUE(sheets.contacts().empty());
        EXPECT_TRUE(sheets.check().is_clean());
        EXPECT_TRUE(find_self_intersections(sheets.begin, sheets.faces).empty());
    }
}

TEST(SelfContact, EveryVertexOfALayerHasAPlaneAcrossIt)
{
    for (const GridPattern pattern : {GridPattern::Diagonal, GridPattern::Cross, GridPattern::Unstructured}) {
        Sheets sheets;
        sheets.add(6, pattern, Vec3::Zero());
        const int below = static_cast<int>(sheets.begin.size());
        sheets.add(6, pattern, {0.0, 0.0, kThickness});
        const std::vector<SelfContact> contacts = sheets.contacts();
        std::vector<char> is_kept(sheets.begin.size(), 0);
        for (const SelfContact& contact : contacts) {
            EXPECT_NEAR(std::abs(contact.normal.z()), 1.0, 1e-9);
            EXPECT_NEAR(contact.least_gap, kThickness, 1e-15);
            EXPECT_NEAR(contact.normal.dot(contact.difference(sheets.begin)), kThickness, 1e-15);
            if (contact.kind == SelfContactKind::VertexFace) is_kept[contact.vertices[0]] = 1;
        }
        EXPECT_EQ(std::count(is_kept.begin(), is_kept.end(), 1), static_cast<long>(is_kept.size()));
        EXPECT_LE(contacts.size(), 8u * below);
    }
}

TEST(SelfContact, ClothBesideAnEdgeIsNotHeldSideways)
{
    Sheets sheets;
    sheets.add(4, GridPattern::Diagonal, Vec3::Zero());
    // Above a face, near its edge: the plane of the neighbouring face is no local minimum.
    sheets.add(1, GridPattern::Diagonal, {0.24, 0.1, kThickness});
    for (const SelfContact& contact : sheets.contacts()) EXPECT_NEAR(std::abs(contact.normal.z()), 1.0, 1e-9);
}

TEST(SelfContact, NoPlaneStopsABorderThatSlidesOverVertices)
{
    // A sheet slides on a larger one: its border begins beside vertices and ends beyond them, or before. The
    // upper sheet moves, or the lower one the other way.
    for (const bool is_upper : {true, false})
        for (const double way : {0.0, 0.3, 0.7, 1.5, 5.0, 50.0})     // thicknesses
            for (const double ahead : {-0.5, 0.2, 0.6, 0.9, 1.6}) {  // of the border, thicknesses
                Sheets sheets;
                sheets.add(10, GridPattern::Diagonal, Vec3::Zero());
                const std::size_t first = sheets.begin.size();
                sheets.add(3, GridPattern::Cross, Vec3::Zero());
                const double border = 0.7 - ahead * kThickness;
                for (std::size_t v = 0; v < sheets.begin.size(); ++v) {
                    Vec3& x = sheets.begin[v];
                    const bool is_above = v >= first;
                    if (is_above) x = Vec3(border + 0.35 * (x.x() - 1.0), 0.35 * x.y() + 0.33, kThickness);
                    sheets.end[v] = x;
                    if (is_above == is_upper) sheets.end[v].x() += (is_upper ? 1.0 : -1.0) * way * kThickness;
                }
                const std::vector<SelfContact> contacts = sheets.contacts();
                ASSERT_FALSE(contacts.empty());
                for (const SelfContact& contact : contacts)
                    EXPECT_GT(contact.normal.dot(contact.difference(sheets.end)),
                              (1.0 - 1e-9) * contact.least_gap)
                        << is_upper << " " << way << " " << ahead;
            }
}

TEST(SelfContact, ABorderHoldsWhatMeetsItFromTheSide)
{
    Sheets sheets;
    sheets.add(1, GridPattern::Diagonal, Vec3::Zero());
    // A vertex at about the sheet's height, which would pass over the border in this step.
    const double t = kThickness;
    for (const Vec3& corner : {Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.1, 0.2), Vec3(0.0, -0.1, 0.2)}) {
        sheets.begin.push_back(corner + Vec3(1.0 + 1.5 * t, 0.5, 0.2 * t));
        sheets.end.push_back(corner + Vec3(1.0 - 3.0 * t, 0.5, 0.2 * t));
    }
    sheets.faces.push_back({4, 5, 6});
    std::vector<SelfContact> planes;
    for (const SelfContact& contact : sheets.contacts())
        if (contact.kind == SelfContactKind::VertexFace && contact.vertices[0] == 4)
            planes.push_back(contact);
    ASSERT_EQ(planes.size(), 1u);
    EXPECT_GT(planes[0].normal.x(), 0.9);
    EXPECT_NEAR(planes[0].least_gap, t, 1e-15);
}

TEST(SelfContact, FastLayersMeetInTheSearchAndInTheCheck)
{
    Sheets sheets;
    sheets.add(5, GridPattern::Cross, Vec3::Zero());
    sheets.add(7, GridPattern::Diagonal, {0.05, 0.03, 0.2}, {0.0, 0.0, -0.5});
    const std::vector<SelfContact> contacts = sheets.contacts();
    ASSERT_FALSE(contacts.empty());
    for (const SelfContact& contact : contacts) {
        EXPECT_GT(contact.least_gap, 0.0);
        EXPECT_LT(contact.normal.dot(contact.difference(sheets.end)), 0.0);
    }
    const SelfSweepReport report = sheets.check();
    EXPECT_GT(report.crossings, 60);
    EXPECT_FALSE(report.violations.empty());
    // A layer that stops short of the other one has met nothing.
    for (Vec3& x : sheets.end) x.z() = std::max(x.z(), x.z() < -0.1 ? 1e-5 : x.z());
    EXPECT_TRUE(sheets.check().is_clean());
}

TEST(SelfContact, FoldsMeetOnlyWhereTheyPassThroughThemselves)
{
    // A strip folded about x = .5 by `angle`; from 180 degrees on its parts lie in each other.
    const auto folded = [](double angle) {
        Sheets sheets;
        sheets.add(6, GridPattern::Diagonal, Vec3::Zero());
        for (Vec3& x : sheets.begin)
            if (x.x() > 0.5)
                x = Vec3(0.5 + (x.x() - 0.5) * std::cos(angle), x.y(), (x.x() - 0.5) * std::sin(angle));
        sheets.end = sheets.begin;
        return sheets;
    };
    const double degree = M_PI / 180.0;
    for (const double angle : {1e-6, 0.5, 2.0, 179.0 * degree, 179.999 * degree})
        EXPECT_TRUE(find_self_intersections(folded(angle).begin, folded(angle).faces).empty()) << angle;
    Sheets flat = folded(M_PI);
    for (Vec3& x : flat.begin) x.z() = 0.0;
    EXPECT_FALSE(find_self_intersections(flat.begin, flat.faces).empty());
    Sheets through = folded(170.0 * degree);
    through.end = folded(190.0 * degree).begin;
    EXPECT_FALSE(through.check().is_clean());
    Sheets closing = folded(100.0 * degree);
    closing.end = folded(179.0 * degree).begin;
    EXPECT_TRUE(closing.check().is_clean());
    EXPECT_TRUE(find_self_intersections(through.end, through.faces).empty());  // passed, and free again
}

TEST(SelfContact, CrossingsOfRandomSheetsAreExact)
{
    // Two tilted sheets: faces cross where a vertical line through both planes' common line says so.
    Sheets sheets;
    sheets.add(3, GridPattern::Diagonal, {0.0, 0.0, 0.0});
    const int n = static_cast<int>(sheets.begin.size());
    sheets.add(3, GridPattern::Diagonal, {0.0, 0.0, -0.51});
    for (std::size_t v = n; v < sheets.begin.size(); ++v) sheets.begin[v].z() += sheets.begin[v].x();
    const auto pairs = find_self_intersections(sheets.begin, sheets.faces);
    ASSERT_FALSE(pairs.empty());
    for (const auto& [a, b] : pairs)
        for (const int f : {a, b}) {  // both contain points on both sides of x = .51
            double low = 1.0, high = 0.0;
            for (const int v : sheets.faces[f]) {
                low = std::min(low, sheets.begin[v].x());
                high = std::max(high, sheets.begin[v].x());
            }
            EXPECT_LE(low, 0.51 + 1e-12);
            EXPECT_GE(high, 0.51 - 1e-12);
        }
}

TEST(SelfSweep, LeavesOutPairsThatMayMeet)
{
    Sheets sheets;
    sheets.add(3, GridPattern::Cross, Vec3::Zero());
    const int below = static_cast<int>(sheets.begin.size());
    sheets.add(3, GridPattern::Cross, {0.01, 0.02, 0.1}, {0.0, 0.0, -0.2});
    const SelfSurface surface = sheets.surface();
    const SelfMotion motion{sheets.begin, sheets.end};
    const auto vertices_may = [](SelfContactKind kind, int, int) {
        return kind == SelfContactKind::VertexFace;
    };
    const SelfSweepReport all = check_self_sweep(surface, motion, kThickness);
    const SelfSweepReport edges = check_self_sweep(surface, motion, kThickness, vertices_may);
    EXPECT_GT(edges.crossings, 0);
    EXPECT_LT(edges.crossings, all.crossings);
    for (const SelfContact& violation : edges.violations)
        EXPECT_EQ(violation.kind, SelfContactKind::EdgeEdge);

    const auto upper_may = [&](SelfContactKind kind, int first, int second) {
        const int second_vertex =
            kind == SelfContactKind::VertexFace ? surface.faces[second][0] : surface.edges[second].a;
        const int first_vertex = kind == SelfContactKind::VertexFace ? first : surface.edges[first].a;
        return (first_vertex < below) != (second_vertex < below);
    };
    EXPECT_TRUE(check_self_sweep(surface, motion, kThickness, upper_may).is_clean());
}

}  // namespace
}  // namespace arris
