// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/repair/soup_repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <ctime>
#include <limits>
#include <random>
#include <tuple>

#include "geometry/input_error.h"
#include "geometry/obstacle/obstacle_topology.h"
#include "geometry/obstacle_input/repair/soup_weld.h"
#include "tests/app/error_of.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kRounding = 1e-12;  // for volumes of about 1

ObstacleMesh unit_box(const Vec3& low = Vec3::Zero())
{
    return samples::box(low, low + Vec3::Ones());
}

double volume(const ObstacleMesh& mesh)
{
    double six = 0.0;
    for (const auto& [a, b, c] : mesh.faces) six += mesh.points[a].dot(mesh.points[b].cross(mesh.points[c]));
    return six / 6.0;
}

// Gives each face points of its own, as in STL, moved by up to `noise`.
ObstacleMesh unwelded(const ObstacleMesh& mesh, double noise = 0.0)
{
    std::mt19937 random(1);
    const auto shift = [&] { return noise * (2.0 * static_cast<double>(random()) / 4294967295.0 - 1.0); };
    ObstacleMesh soup;
    for (const Face& face : mesh.faces) {
        const int base = static_cast<int>(soup.points.size());
        for (const int p : face) soup.points.push_back(mesh.points[p] + Vec3(shift(), shift(), shift()));
        soup.faces.push_back({base, base + 1, base + 2});
    }
    return soup;
}

void turn(Face& face)
{
    std::swap(face[1], face[2]);
}

int solid_count(const ObstacleMesh& mesh)
{
    const std::vector<char> solid = make_topology(mesh).is_solid;
    return static_cast<int>(std::count(solid.begin(), solid.end(), 1));
}

void expect_box(const RepairedSoup& repaired, double tolerance = kRounding)
{
    ASSERT_EQ(validate(repaired.mesh), "");
    EXPECT_EQ(repaired.mesh.points.size(), 8u);
    EXPECT_EQ(repaired.mesh.faces.size(), 12u);
    EXPECT_EQ(solid_count(repaired.mesh), 1);
    EXPECT_NEAR(volume(repaired.mesh), 1.0, tolerance);
    EXPECT_THAT(repaired.notes, Each(HasSubstr("welded")));
}

// ----------------------------------------------------------------- nothing to repair

TEST(SoupRepair, LeavesWhatIsSoundAsItIs)
{
    for (const ObstacleMesh& mesh :
         {unit_box(), samples::sphere(12, 16), samples::l_prism(), samples::teeth(5), samples::cone(7, 1.0),
          samples::wire({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, true), samples::nails({{0, 0, 0}, {1, 2, 3}})}) {
        const RepairedSoup repaired = repair_soup(mesh);
        EXPECT_THAT(repaired.warnings, IsEmpty());
        EXPECT_THAT(repaired.notes, IsEmpty());
        EXPECT_EQ(repaired.mesh.points, mesh.points);
        EXPECT_EQ(repaired.mesh.segments, mesh.segments);
        EXPECT_EQ(repaired.mesh.lone_points, mesh.lone_points);
        ASSERT_EQ(repaired.mesh.faces.size(), mesh.faces.size());
        EXPECT_NEAR(volume(repaired.mesh), volume(mesh), 0.0);
        EXPECT_EQ(validate(repaired.mesh), "");
    }
}

TEST(SoupRepair, OpenSheetIsTwoSidedAndNoDefect)
{
    const ObstacleMesh sheet = samples::sheet(3, 3, [](int i, int j) { return 0.1 * i * j; });
    const RepairedSoup repaired = repair_soup(sheet);
    EXPECT_THAT(repaired.warnings, IsEmpty());
    EXPECT_THAT(repaired.notes, ElementsAre("open: 12 border edges, two-sided"));
    EXPECT_EQ(repaired.mesh.faces.size(), 18u);
}

TEST(SoupRepair, HoleMakesASolidASheet)
{
    ObstacleMesh box = unit_box();
    box.faces.erase(box.faces.begin() + 3);
    const RepairedSoup repaired = repair_soup(box);
    EXPECT_EQ(validate(repaired.mesh), "");
    EXPECT_THAT(repaired.notes, ElementsAre("open: 3 border edges, two-sided"));
    EXPECT_EQ(solid_count(repaired.mesh), 0);
}

// ----------------------------------------------------------------- welding

TEST(SoupRepair, WeldsAnUnweldedSoup)
{
    const RepairedSoup repaired = repair_soup(unwelded(unit_box()));
    expect_box(repaired);
    EXPECT_THAT(repaired.warnings, IsEmpty());
    EXPECT_THAT(repaired.notes, ElementsAre("welded 28 vertices that equal others"));
}

TEST(SoupRepair, WeldsWhatRoundingMovedApart)
{
    // For a box with the diagonal 1.7, where points up to 1.7e-6 apart are welded.
    constexpr double kNoise = 1e-7;
    const RepairedSoup repaired = repair_soup(unwelded(unit_box(), kNoise));
    expect_box(repaired, 10 * kNoise);
    EXPECT_THAT(repaired.warnings,
                ElementsAre(HasSubstr("welded 28 vertices (0 equal to others, 28 within")));
}

TEST(SoupRepair, WeldingIsRelativeToTheSize)
{
    for (const double scale : {1e-7, 1e-3, 1e3, 4e5}) {
        const auto scaled = [&](const Vec3& p) { return Vec3(scale * p); };
        const RepairedSoup repaired = repair_soup(samples::moved(unwelded(unit_box(), 1e-7), scaled));
        EXPECT_EQ(repaired.mesh.points.size(), 8u) << scale;
        EXPECT_EQ(solid_count(repaired.mesh), 1) << scale;
        const RepairedSoup apart = repair_soup(samples::moved(unwelded(unit_box(), 1e-4), scaled));
        EXPECT_EQ(apart.mesh.points.size(), 36u) << scale;
    }
}

TEST(SoupRepair, WeldsFarFromTheOrigin)
{
    const Vec3 offset(9e5, -9e5, 5e5);
    const RepairedSoup repaired = repair_soup(unwelded(unit_box(offset)));
    ASSERT_EQ(validate(repaired.mesh), "");
    EXPECT_EQ(repaired.mesh.points.size(), 8u);
    EXPECT_EQ(solid_count(repaired.mesh), 1);
    EXPECT_EQ(repaired.mesh.points[0], offset);
}

TEST(SoupRepair, ThinPlateKeepsItsSides)
{
    // The tolerance, 1.4e-6, exceeds the plate's thickness.
    const RepairedSoup repaired = repair_soup(samples::box(Vec3::Zero(), Vec3(1, 1, 1e-6)));
    EXPECT_THAT(repaired.warnings, IsEmpty());
    EXPECT_EQ(repaired.mesh.points.size(), 8u);
    EXPECT_NEAR(volume(repaired.mesh), 1e-6, 1e-6 * kRounding);
}

// Brute force over all pairs.
int near_pairs(const std::vector<Vec3>& points, double tolerance)
{
    int pairs = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = i + 1; j < points.size(); ++j)
            if ((points[i] - points[j]).norm() <= tolerance) ++pairs;
    return pairs;
}

// Each point joins the first kept point within the tolerance, or is kept itself.
std::vector<Vec3> welded_slowly(const std::vector<Vec3>& points, double tolerance)
{
    std::vector<Vec3> kept;
    for (const Vec3& p : points)
        if (std::none_of(kept.begin(), kept.end(),
                         [&](const Vec3& q) { return (p - q).squaredNorm() <= tolerance * tolerance; }))
            kept.push_back(p);
    return kept;
}

TEST(SoupWeld, GridFindsWhatAllPairsFind)
{
    std::mt19937 random(7);
    for (const double spread : {1e-6, 3e-6, 1e-5, 1e-4}) {
        // Tight clusters, including chains across cells of the grid, in a box of diagonal sqrt(3).
        std::vector<Vec3> points = {{0, 0, 0}, {1, 1, 1}};
        const auto draw = [&] { return static_cast<double>(random()) / 4294967295.0; };
        for (int cluster = 0; cluster < 20; ++cluster) {
            const Vec3 middle(draw(), draw(), draw());
            for (int k = 0; k < 25; ++k)
                points.push_back((middle + spread * Vec3(draw(), draw(), draw())).cwiseMin(1.0));
        }
        const double tolerance = 1e-6 * std::sqrt(3.0);
        ObstacleMesh soup = samples::nails(points);
        const WeldCounts counts = weld(soup);
        const std::vector<Vec3> slow = welded_slowly(points, tolerance);
        EXPECT_EQ(soup.points, slow) << spread;
        EXPECT_EQ(counts.near_points, static_cast<int>(points.size() - slow.size()));
        EXPECT_EQ(near_pairs(soup.points, tolerance), 0);
        EXPECT_EQ(counts.duplicate_lone_points, counts.near_points);
    }
}

TEST(SoupWeld, ZeroHasOneSign)
{
    ObstacleMesh soup = samples::nails({{0.0, 1, 0}, {-0.0, 1, 0}, {1, 1, 1}});
    EXPECT_EQ(weld(soup).equal_points, 1);
    EXPECT_EQ(soup.points.size(), 2u);
}

// ----------------------------------------------------------------- faces

TEST(SoupRepair, DropsDuplicateFacesInEitherDirection)
{
    ObstacleMesh box = unit_box();
    box.faces.push_back(box.faces[0]);
    box.faces.push_back({box.faces[1][2], box.faces[1][0], box.faces[1][1]});
    box.faces.push_back({box.faces[2][0], box.faces[2][2], box.faces[2][1]});
    const RepairedSoup repaired = repair_soup(box);
    expect_box(repaired);
    EXPECT_THAT(repaired.warnings, ElementsAre("dropped 3 duplicate faces"));
}

TEST(SoupRepair, DropsFacesThatNameAVertexTwice)
{
    ObstacleMesh box = unit_box();
    box.faces.push_back({0, 0, 1});
    box.faces.push_back({5, 5, 5});
    const RepairedSoup repaired = repair_soup(box);
    expect_box(repaired);
    EXPECT_THAT(repaired.warnings, ElementsAre("dropped 2 faces that name a vertex twice"));
}

TEST(SoupRepair, DropsStrayFacesWithoutArea)
{
    ObstacleMesh box = unit_box();
    const Face& face = box.faces[0];
    const Vec3 middle = 0.5 * (box.points[face[0]] + box.points[face[1]]);
    box.points.push_back(middle);
    box.faces.push_back({face[0], 8, face[1]});
    box.points.insert(box.points.end(), {{5, 5, 5}, {6, 6, 6}, {7, 7, 7}});
    box.faces.push_back({9, 10, 11});
    const RepairedSoup repaired = repair_soup(box);
    expect_box(repaired);
    EXPECT_THAT(repaired.warnings, ElementsAre("removed 2 faces without area"));
}

// One edge of a box has a vertex on its middle that only one side uses. A face without area closes the gap,
// as exporters of boolean operations write it.
ObstacleMesh box_with_cap(double t)
{
    ObstacleMesh box = unit_box();
    const auto [a, b, c] = box.faces[0];
    box.points.push_back((1.0 - t) * box.points[a] + t * box.points[b]);
    box.faces[0] = {a, 8, c};
    box.faces.push_back({8, b, c});
    box.faces.push_back({a, b, 8});
    return box;
}

TEST(SoupRepair, FacesWithoutAreaThatCloseASolidLeaveItClosed)
{
    for (const double t : {0.5, 0.25, 1e-3}) {
        const ObstacleMesh box = box_with_cap(t);
        ASSERT_THAT(validate(box), HasSubstr("face")) << "the face is to be degenerate";
        const RepairedSoup repaired = repair_soup(box);
        ASSERT_EQ(validate(repaired.mesh), "");
        EXPECT_EQ(solid_count(repaired.mesh), 1);
        EXPECT_NEAR(volume(repaired.mesh), 1.0, kRounding);
        EXPECT_THAT(repaired.warnings, Contains(HasSubstr("without area")));
    }
}

TEST(SoupRepair, OnlyFacesWithoutAreaAreNothing)
{
    ObstacleMesh flat;
    flat.points = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}};
    flat.faces = {{0, 1, 2}, {0, 1, 3}};
    EXPECT_THAT(error_of([&] { repair_soup(flat); }), HasSubstr("removed 2 faces without area"));
    flat.points.assign(4, Vec3(1, 2, 3));
    EXPECT_THAT(error_of([&] { repair_soup(flat); }), HasSubstr("nothing is left"));
}

// ----------------------------------------------------------------- orientation

TEST(SoupRepair, TurnsFlippedFacesRound)
{
    for (const std::vector<int>& flipped :
         {std::vector<int>{0}, {1, 5, 7}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}}) {
        ObstacleMesh box = unit_box();
        for (const int f : flipped) turn(box.faces[f]);
        const RepairedSoup repaired = repair_soup(box);
        expect_box(repaired);
        EXPECT_THAT(repaired.warnings, ElementsAre(HasSubstr("turned " + std::to_string(flipped.size()) +
                                                             " of 12 faces round")));
    }
}

TEST(SoupRepair, SheetsFacesAgreeWithEachOther)
{
    ObstacleMesh sheet = samples::sheet(2, 2, [](int, int) { return 0.0; });
    turn(sheet.faces[3]);
    const RepairedSoup repaired = repair_soup(sheet);
    EXPECT_EQ(validate(repaired.mesh), "");
    EXPECT_THAT(repaired.warnings, ElementsAre(HasSubstr("turned 1 of 8 faces round")));
    // A sheet has two sides, and the file's face orientation is kept.
    for (Face& face : sheet.faces) turn(face);
    turn(sheet.faces[3]);
    turn(sheet.faces[3]);
    EXPECT_THAT(repair_soup(samples::inside_out(samples::sheet(2, 2, [](int, int) { return 0.0; }))).warnings,
                IsEmpty());
}

TEST(SoupRepair, HollowBoxStaysHollow)
{
    const ObstacleMesh outer = samples::box(Vec3::Constant(-1), Vec3::Constant(1));
    const ObstacleMesh inner = samples::box(Vec3::Constant(-0.5), Vec3::Constant(0.5));
    constexpr double kHollow = 8.0 - 1.0;
    struct Case {
        ObstacleMesh mesh;
        int turned;
    };
    for (const Case& c : {Case{samples::together(outer, samples::inside_out(inner)), 0},
                          Case{samples::together(outer, inner), 12},
                          Case{samples::together(samples::inside_out(outer), inner), 24},
                          Case{samples::together(samples::inside_out(inner), outer), 0}}) {
        const RepairedSoup repaired = repair_soup(c.mesh);
        EXPECT_EQ(validate(repaired.mesh), "");
        EXPECT_NEAR(volume(repaired.mesh), kHollow, 10 * kRounding);
        EXPECT_EQ(solid_count(repaired.mesh), 2);
        EXPECT_THAT(repaired.notes, ElementsAre(HasSubstr("1 closed shell lies inside another")));
        if (c.turned == 0) {
            EXPECT_THAT(repaired.warnings, IsEmpty());
        } else {
            EXPECT_THAT(repaired.warnings,
                        ElementsAre(HasSubstr("turned " + std::to_string(c.turned) + " of 24 faces")));
        }
    }
}

TEST(SoupRepair, WhatFloatsInACavityIsSolidAgain)
{
    ObstacleMesh nested = unit_box(Vec3::Constant(-0.5));
    for (const double half : {1.0, 2.0, 3.0})
        nested = samples::together(nested, samples::box(Vec3::Constant(-half), Vec3::Constant(half)));
    EXPECT_NEAR(volume(repair_soup(nested).mesh), 216.0 - 64.0 + 8.0 - 1.0, 1000 * kRounding);
}

TEST(SoupRepair, ShellsThatCrossAreSolidsSideBySide)
{
    // A corner of the second shell is inside the first, but the second shell is no cavity.
    const ObstacleMesh crossing = samples::together(unit_box(), unit_box(Vec3::Constant(0.5)));
    const RepairedSoup repaired = repair_soup(crossing);
    EXPECT_EQ(validate(repaired.mesh), "");
    EXPECT_NEAR(volume(repaired.mesh), 2.0, kRounding);
    EXPECT_THAT(repaired.warnings, ElementsAre(HasSubstr("pairs of faces cross")));
    EXPECT_THAT(repaired.notes, IsEmpty());
}

// ----------------------------------------------------------------- non-manifold

TEST(SoupRepair, BoxesThatShareAnEdgeComeApart)
{
    ObstacleMesh two = samples::together(unit_box(), unit_box(Vec3(1, 1, 0)));
    const RepairedSoup repaired = repair_soup(two);
    ASSERT_EQ(validate(repaired.mesh), "");
    EXPECT_EQ(solid_count(repaired.mesh), 2);
    EXPECT_EQ(repaired.mesh.points.size(), 16u);
    EXPECT_NEAR(volume(repaired.mesh), 2.0, kRounding);
    EXPECT_THAT(repaired.warnings, Contains(HasSubstr("split 2 vertices")));
}

TEST(SoupRepair, BoxesThatShareACornerComeApart)
{
    const RepairedSoup repaired = repair_soup(samples::together(unit_box(), unit_box(Vec3::Ones())));
    ASSERT_EQ(validate(repaired.mesh), "");
    EXPECT_EQ(solid_count(repaired.mesh), 2);
    EXPECT_EQ(repaired.mesh.points.size(), 16u);
    EXPECT_THAT(repaired.warnings, Contains(HasSubstr("split 1 vertex where")));
}

TEST(SoupRepair, FinOnASolidIsCutOff)
{
    ObstacleMesh box = unit_box();
    const auto [a, b, c] = box.faces[0];
    box.points.push_back({-1, -1, -1});
    box.faces.push_back({a, b, 8});
    const RepairedSoup repaired = repair_soup(box);
    ASSERT_EQ(validate(repaired.mesh), "");
    EXPECT_EQ(repaired.mesh.faces.size(), 13u);
    EXPECT_EQ(solid_count(repaired.mesh), 1) << "the box must not come open at the fin";
    EXPECT_THAT(repaired.warnings, Contains(HasSubstr("split")));
}

TEST(SoupRepair, MoebiusStripIsCutOpen)
{
    // A Moebius band of quads: no orientation is consistent all around.
    ObstacleMesh band;
    constexpr int kCount = 12;
    for (int k = 0; k < kCount; ++k) {
        const double angle = 2.0 * M_PI * k / kCount;
        const Vec3 middle(std::cos(angle), std::sin(angle), 0.0);
        const Vec3 across = 0.3 * (std::cos(0.5 * angle) * middle + std::sin(0.5 * angle) * Vec3::UnitZ());
        band.points.push_back(middle - across);
        band.points.push_back(middle + across);
    }
    for (int k = 0; k < kCount; ++k) {
        const int a = 2 * k;
        const bool is_last = k + 1 == kCount;
        const int c = is_last ? 1 : a + 2;
        const int d = is_last ? 0 : a + 3;
        band.faces.push_back({a, c, a + 1});
        band.faces.push_back({a + 1, c, d});
    }
    const RepairedSoup repaired = repair_soup(band);
    ASSERT_EQ(validate(repaired.mesh), "");
    EXPECT_EQ(repaired.mesh.faces.size(), 24u);
    EXPECT_THAT(repaired.warnings, Contains(HasSubstr("split")));
}

// ----------------------------------------------------------------- crossing

TEST(SoupRepair, CountsFacesThatCross)
{
    // Two triangles that cross each other.
    ObstacleMesh crossing;
    crossing.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.2, -1}, {0.2, 0.2, 1}, {0.3, 0.3, 1}};
    crossing.faces = {{0, 1, 2}, {3, 4, 5}};
    EXPECT_THAT(repair_soup(crossing).warnings, ElementsAre(HasSubstr("1 pair of faces cross")));
}

// ----------------------------------------------------------------- wires and points

TEST(SoupRepair, WiresAndPointsAreWeldedAndShared)
{
    ObstacleMesh soup = unit_box();
    const Vec3 corner = soup.points[0];
    soup.points.insert(soup.points.end(),
                       {corner, {5, 5, 5}, {5, 5, 5}, {6, 5, 5}, {6, 5, 5}, {9, 9, 9}, {9, 9, 9}});
    soup.segments = {{8, 9}, {10, 11}, {11, 12}, {11, 10}};
    soup.lone_points = {13, 14, 8};
    const RepairedSoup repaired = repair_soup(soup);
    ASSERT_EQ(validate(repaired.mesh), "");
    EXPECT_EQ(repaired.mesh.points.size(), 8u + 3u);
    EXPECT_EQ(repaired.mesh.segments, (std::vector<std::array<int, 2>>{{0, 8}, {8, 9}}));
    EXPECT_EQ(repaired.mesh.lone_points, (std::vector<int>{10, 0}));
    EXPECT_THAT(repaired.warnings, ElementsAre("dropped 1 segment of no length",
                                               "dropped 1 duplicate segment", "dropped 1 duplicate point"));
    EXPECT_THAT(repaired.notes, Contains(HasSubstr("welded 4 vertices")));
}

TEST(SoupRepair, UnusedVerticesAreNoMatter)
{
    ObstacleMesh box = unit_box();
    box.points.insert(box.points.begin() + 4, {1e5, 0, 0});
    for (Face& face : box.faces)
        for (int& p : face)
            if (p >= 4) ++p;
    expect_box(repair_soup(box));
}

// ----------------------------------------------------------------- refused

TEST(SoupRepair, RefusesBeforeAnyPredicateSeesIt)
{
    const auto with_point = [](const Vec3& p) {
        ObstacleMesh box = unit_box();
        box.points[2] = p;
        return error_of([&] { repair_soup(box); });
    };
    EXPECT_THAT(with_point({0, kNan, 0}), HasSubstr("vertex 3 (0, nan, 0)"));
    EXPECT_THAT(with_point({0, 0, std::numeric_limits<double>::infinity()}), HasSubstr("vertex 3"));
    EXPECT_THAT(with_point({1e300, 0, 0}), HasSubstr("within 1e+06 m"));
    EXPECT_THAT(with_point({1.1e6, 0, 0}), HasSubstr("within 1e+06 m"));

    const auto with = [](auto change) {
        ObstacleMesh box = unit_box();
        change(box);
        return error_of([&] { repair_soup(box); });
    };
    EXPECT_THAT(with([](ObstacleMesh& m) { m.faces[4][1] = 8; }),
                HasSubstr("face 5 names vertex 9, but there are 8"));
    EXPECT_THAT(with([](ObstacleMesh& m) { m.faces[0][0] = -1; }), HasSubstr("face 1 names vertex 0"));
    EXPECT_THAT(with([](ObstacleMesh& m) {
                    m.segments = {{0, 99}};
                }),
                HasSubstr("segment 1 names vertex 100"));
    EXPECT_THAT(with([](ObstacleMesh& m) { m.lone_points = {8}; }), HasSubstr("lone point 1"));
    EXPECT_THAT(error_of([] { repair_soup({}); }), HasSubstr("no faces, lines or points"));
}

// ----------------------------------------------------------------- as a whole

TEST(SoupRepair, RandomSoupsBecomeValidMeshesAlwaysTheSame)
{
    std::mt19937 random(3);
    for (int round = 0; round < 300; ++round) {
        // Few points on a coarse lattice, so that every kind of degeneracy occurs.
        ObstacleMesh soup;
        const int points = 4 + static_cast<int>(random() % 12);
        for (int p = 0; p < points; ++p)
            soup.points.emplace_back(random() % 3, random() % 3, random() % (round % 2 == 0 ? 3 : 1));
        const auto draw = [&] { return static_cast<int>(random() % points); };
        for (int f = 0; f < 3 + round % 20; ++f) soup.faces.push_back({draw(), draw(), draw()});
        for (int s = 0; s < round % 5; ++s) soup.segments.push_back({draw(), draw()});
        for (int s = 0; s < round % 3; ++s) soup.lone_points.push_back(draw());
        const auto repair = [&](RepairedSoup& repaired) {
            return error_of([&] { repaired = repair_soup(soup); });
        };
        RepairedSoup first, second;
        const std::string error = repair(first);
        EXPECT_EQ(repair(second), error);
        if (!error.empty()) {
            EXPECT_THAT(error, HasSubstr("nothing is left"));
            continue;
        }
        EXPECT_EQ(validate(first.mesh), "") << "round " << round;
        EXPECT_EQ(first.mesh.points, second.mesh.points);
        EXPECT_EQ(first.mesh.faces, second.mesh.faces);
        EXPECT_EQ(first.warnings, second.warnings);
    }
}

TEST(SoupRepair, CostsAsMuchAsThereIs)
{
    // CPU times are compared with each other, because the machine may be busy.
    const auto cost_of = [](int rings, std::size_t faces) {
        const ObstacleMesh soup = unwelded(samples::sphere(rings, rings));
        EXPECT_GT(soup.faces.size(), faces);
        const std::clock_t start = std::clock();
        const RepairedSoup repaired = repair_soup(soup);
        EXPECT_EQ(solid_count(repaired.mesh), 1);
        return static_cast<double>(std::clock() - start);
    };
    const double few = cost_of(71, 9900), many = cost_of(224, 99000);
    RecordProperty("ratio", std::to_string(many / few));
    // Ten times the points take 10 to 11 times as long; all pairs would take 100 times.
    EXPECT_LT(many, 40.0 * few);
}

TEST(SoupRepair, FacesThatAreNotJoinedAreToldToBeMerged)
{
    for (const double size : {1.0, 1e3}) {
        const auto scaled = [&](const Vec3& p) { return Vec3(size * p); };
        const RepairedSoup repaired = repair_soup(samples::moved(unwelded(unit_box(), 1e-4), scaled));
        EXPECT_THAT(repaired.warnings, Contains(AllOf(HasSubstr("36 border edges run along another"),
                                                      HasSubstr("merge vertices by distance"))));
        EXPECT_THAT(repaired.warnings, Each(Not(HasSubstr("boolean union"))));
    }
    // Sheets beside each other, as far apart as a thousandth of their size or joined, are meant as they are.
    const double kApart = 2e-3;
    ObstacleMesh sheets;
    sheets.points = {{0, 0, 0},      {1, 0, 0},      {1, 1, 0},      {0, 1, 0},
                     {0, 0, kApart}, {1, 0, kApart}, {1, 1, kApart}, {0, 1, kApart}};
    sheets.faces = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
    EXPECT_THAT(repair_soup(sheets).warnings, IsEmpty());
}

}  // namespace
}  // namespace arris
