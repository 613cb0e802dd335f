// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/cloth_outline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>

#include "geometry/cloth/mesh_quality.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

using ::testing::HasSubstr;
using Polygon = std::vector<Vec2>;

constexpr double kAreaTolerance = 1e-12;  // relative
constexpr double kOnBorder = 1e-15;       // of the border's size: rounding of one addition
constexpr double kLeastAngle = 25.0;      // degrees, where the border forces no smaller one
constexpr double kShortest = 0.45,
                 kLongest = 1.75;  // sides, relative to the edge length: measured 0.489 to 1.71
constexpr double kEstimate = 0.3;  // of the count

Polygon regular(int corners, double radius, const Vec2& centre = Vec2::Zero())
{
    Polygon polygon;
    for (int k = 0; k < corners; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / corners;
        polygon.push_back(centre + radius * Vec2(std::cos(angle), std::sin(angle)));
    }
    return polygon;
}

Polygon star(int tips, double outer, double inner)
{
    Polygon polygon = regular(2 * tips, outer);
    for (int k = 1; k < 2 * tips; k += 2) polygon[k] *= inner / outer;
    return polygon;
}

Polygon box(const Vec2& least, const Vec2& greatest)
{
    return {least, {greatest.x(), least.y()}, greatest, {least.x(), greatest.y()}};
}

// A back with teeth of the given width, as far apart.
Polygon comb(int teeth, double width)
{
    Polygon polygon = {{0.0, 1.0}, {0.0, 0.0}};
    for (int k = 0; k < teeth; ++k) {
        const double u = 2.0 * k * width;
        polygon.insert(polygon.end(), {{u + width, 0.0}, {u + width, 0.8}});
        if (k + 1 < teeth) polygon.insert(polygon.end(), {{u + 2.0 * width, 0.8}, {u + 2.0 * width, 0.0}});
    }
    polygon.back().y() = 1.0;
    return polygon;
}

double area_of(const Polygon& polygon)
{
    double doubled = 0.0;
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
        doubled += twice_area(polygon[0], polygon[k], polygon[k + 1]);
    return 0.5 * std::abs(doubled);
}

double area_of(const ClothMesh& mesh)
{
    double area = 0.0;
    for (const auto& [a, b, c] : mesh.faces)
        area += 0.5 * twice_area(mesh.material[a], mesh.material[b], mesh.material[c]);
    return area;
}

double distance_to(const Vec2& X, const Vec2& a, const Vec2& b)
{
    const double s = std::clamp((X - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (a + s * (b - a) - X).norm();
}

double distance_to(const Vec2& X, const BorderLoops& border)
{
    double least = std::numeric_limits<double>::infinity();
    for (const Polygon& loop : border)
        for (std::size_t k = 0; k < loop.size(); ++k)
            least = std::min(least, distance_to(X, loop[k], loop[(k + 1) % loop.size()]));
    return least;
}

double size_of(const BorderLoops& border)
{
    double greatest = 0.0;
    for (const Vec2& corner : border[0]) greatest = std::max(greatest, corner.cwiseAbs().maxCoeff());
    return greatest;
}

// Sound, of the border's area, with the border's corners as vertices and all border vertices on it.
void expect_sound(const ClothMesh& mesh, const BorderLoops& border)
{
    EXPECT_EQ(validate(mesh), "");
    const double size = size_of(border);
    double area = area_of(border[0]);
    for (std::size_t hole = 1; hole < border.size(); ++hole) area -= area_of(border[hole]);
    EXPECT_NEAR(area_of(mesh), area, kAreaTolerance * size * size);
    const MeshTopology topology = make_topology(mesh.vertex_count(), mesh.faces);
    double length = 0.0, perimeter = 0.0;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        EXPECT_EQ(mesh.world[v], Vec3(mesh.material[v].x(), mesh.material[v].y(), 0.0));
        if (topology.is_border[v] == 0) continue;
        EXPECT_LE(distance_to(mesh.material[v], border), kOnBorder * size);
    }
    for (const MeshEdge& edge : topology.edges)
        if (edge.face_right < 0) length += (mesh.material[edge.a] - mesh.material[edge.b]).norm();
    for (const Polygon& loop : border)
        for (std::size_t k = 0; k < loop.size(); ++k) {
            perimeter += (loop[(k + 1) % loop.size()] - loop[k]).norm();
            EXPECT_NE(std::find(mesh.material.begin(), mesh.material.end(), loop[k]), mesh.material.end());
        }
    EXPECT_NEAR(length, perimeter, kAreaTolerance * perimeter);
}

void expect_even(const ClothMesh& mesh, double edge_length)
{
    const MeshTopology topology = make_topology(mesh.vertex_count(), mesh.faces);
    for (int f = 0; f < mesh.face_count(); ++f) EXPECT_GE(least_material_angle(mesh, f), kLeastAngle);
    for (const MeshEdge& edge : topology.edges) {
        const double length = (mesh.material[edge.a] - mesh.material[edge.b]).norm() / edge_length;
        EXPECT_GE(length, kShortest);
        EXPECT_LE(length, kLongest);
    }
}

struct Shape {
    const char* name;
    Polygon outline;
    std::vector<Polygon> holes;
    double edge_length;
    bool is_even;  // whether no part of the border forces small faces or angles
};

std::vector<Shape> shapes()
{
    const Polygon ell = {{0, 0}, {1, 0}, {1, 0.4}, {0.4, 0.4}, {0.4, 1}, {0, 1}};
    const double sharp = std::tan(5.0 * std::numbers::pi / 180.0);
    return {
        {"square", box({0, 0}, {1, 1}), {}, 0.1, true},
        {"triangle", {{0, 0}, {1, 0}, {0.5, 0.9}}, {}, 0.1, true},
        {"triangle of one face", {{0, 0}, {1, 0}, {0.5, 0.9}}, {}, 1.0, true},
        {"L", ell, {}, 0.07, true},
        {"disc, fine", regular(64, 0.5), {}, 0.03, true},
        {"disc", regular(64, 0.5), {}, 0.1, true},
        {"disc, coarse", regular(64, 0.5), {}, 0.2, true},
        {"disc of 1000 corners", regular(1000, 0.5), {}, 0.07, true},
        {"ring", regular(64, 0.5), {regular(64, 0.2)}, 0.05, true},
        {"two holes",
         box({-1, -1}, {1, 1}),
         {box({-0.7, -0.7}, {-0.2, 0.3}), regular(40, 0.3, {0.5, 0.5})},
         0.1,
         true},
        {"star", star(5, 0.5, 0.2), {}, 0.05, true},
        {"star-shaped hole", regular(64, 0.6), {star(8, 0.25, 0.15)}, 0.05, true},
        {"comb", comb(8, 0.1), {}, 0.05, true},
        {"corner of 5 degrees", {{0, 0}, {1, 0}, {1, sharp}}, {}, 0.05, false},
        {"hole near the border", box({0, 0}, {1, 1}), {box({0.3, 0.002}, {0.6, 0.3})}, 0.05, false},
        {"slit", box({0, 0}, {1, 1}), {box({0.3, 0.5}, {0.7, 0.501})}, 0.05, false},
        {"slanted slit",
         box({0, 0}, {1, 1}),
         {{{0.31, 0.5}, {0.63, 0.612}, {0.7, 0.634}, {0.5, 0.562}}},
         0.05,
         false},
        {"tiny hole", regular(64, 0.5), {regular(64, 0.002)}, 0.06, false},
        {"ribbon", box({0, 0}, {1, 0.003}), {}, 0.02, false},
    };
}

ClothOutline outline_of(const Shape& shape)
{
    const BorderLoops border = to_border_loops(shape.outline, shape.holes);
    EXPECT_FALSE(find_border_defect(border)) << shape.name;
    return {coarsen_border(border, shape.edge_length), shape.edge_length, {}};
}

TEST(ClothOutline, IsSoundAndEvenWhereTheBorderLetsIt)
{
    for (const Shape& shape : shapes()) {
        SCOPED_TRACE(shape.name);
        const ClothOutline outline = outline_of(shape);
        const ClothMesh mesh = make_cloth_outline(outline);
        expect_sound(mesh, outline.border);
        if (!shape.is_even) continue;
        expect_even(mesh, shape.edge_length);
        const GridCount count = estimate_cloth_outline(outline);
        EXPECT_NEAR(count.vertices, mesh.vertex_count(), std::max(1.0, kEstimate * mesh.vertex_count()));
        EXPECT_NEAR(count.faces, mesh.face_count(), std::max(1.0, kEstimate * mesh.face_count()));
    }
}

TEST(ClothOutline, IsSoundAtEveryScaleAndFarFromTheOrigin)
{
    for (const double scale : {1e-3, 1.0, 1e3})
        for (const Vec2& offset : {Vec2(0, 0), Vec2(-7, 3), Vec2(300, -400)})
            for (Shape shape : shapes()) {
                SCOPED_TRACE(::testing::Message()
                             << shape.name << " * " << scale << " + " << offset.transpose());
                const auto place = [&](Vec2& corner) { corner = scale * (corner + offset); };
                std::for_each(shape.outline.begin(), shape.outline.end(), place);
                for (Polygon& hole : shape.holes) std::for_each(hole.begin(), hole.end(), place);
                shape.edge_length *= scale;
                const ClothOutline outline = outline_of(shape);
                const ClothMesh mesh = make_cloth_outline(outline);
                expect_sound(mesh, outline.border);
                if (shape.is_even) expect_even(mesh, shape.edge_length);
            }
}

TEST(ClothOutline, RunsEitherWayAndMayRepeatCorners)
{
    const Polygon outline = star(5, 0.5, 0.2), hole = regular(6, 0.1);
    const BorderLoops border = to_border_loops(outline, {hole});
    Polygon clockwise(outline.rbegin(), outline.rend()), closed = outline;
    closed.insert(closed.begin() + 3, outline[3]);
    closed.push_back(outline[0]);
    EXPECT_EQ(to_border_loops(closed, {hole}), border);
    Polygon turned = to_border_loops(clockwise, {hole})[0];
    EXPECT_GT(
        twice_area(turned[9], turned[0], turned[1]) * twice_area(border[0][9], border[0][0], border[0][1]),
        0.0);
    const ClothMesh mesh = make_cloth_outline({to_border_loops(clockwise, {hole}), 0.05, {}});
    expect_sound(mesh, border);
}

TEST(ClothOutline, IsAFunctionOfItsArguments)
{
    for (const Shape& shape : shapes()) {
        const ClothOutline outline = outline_of(shape);
        EXPECT_EQ(outline_of(shape).border, outline.border);
        const ClothMesh mesh = make_cloth_outline(outline), again = make_cloth_outline(outline);
        EXPECT_EQ(mesh.material, again.material) << shape.name;
        EXPECT_EQ(mesh.faces, again.faces) << shape.name;
    }
}

TEST(ClothOutline, RefusesPartsOfTheBorderThatNearlyTouch)
{
    const auto refusal = [](const BorderLoops& border, const std::vector<FoldLine>& folds) -> std::string {
        try {
            make_cloth_outline({border, 0.05, folds});
        } catch (const InputError& error) {
            return error.what();
        }
        return "accepted";
    };
    const BorderLoops ribbon = {box({0, 0}, {1, 1e-8})};
    EXPECT_THAT(refusal(ribbon, {}), HasSubstr("the mesh would need sides of 1e-08 m"));
    const BorderLoops near_hole = to_border_loops(box({0, 0}, {1, 1}), {box({0.3, 1e-9}, {0.6, 0.3})});
    EXPECT_THAT(refusal(near_hole, {}), HasSubstr("the mesh would need sides of 1e-09 m"));
    const BorderLoops square = {box({0, 0}, {1, 1})};
    EXPECT_THAT(refusal(square, {{{Vec2(0.5, 0), Vec2(0.5, 1)}, 10.0},
                                 {{Vec2(0.5 + 1e-9, 0), Vec2(0.5 + 1e-9, 1)}, 10.0}}),
                HasSubstr("the mesh would need sides of 1e-09 m"));
    EXPECT_THAT(refusal({box({0, 0}, {200, 200})}, {}), HasSubstr("at most 5e+06 are allowed"));
}

// --- coarsening

// Corners left out are near the sides in their place, which are short; those kept are in order.
void expect_coarse(const BorderLoops& border, const BorderLoops& coarse, double edge_length)
{
    ASSERT_EQ(coarse.size(), border.size());
    EXPECT_FALSE(find_border_defect(coarse));
    for (std::size_t l = 0; l < border.size(); ++l) {
        Polygon loop = border[l];
        std::rotate(loop.begin(), std::find(loop.begin(), loop.end(), coarse[l][0]), loop.end());
        std::size_t at = 0;
        for (std::size_t k = 0; k < coarse[l].size(); ++k) {
            const Vec2 &a = coarse[l][k], &b = coarse[l][(k + 1) % coarse[l].size()];
            const std::size_t first = at;
            for (++at; at < loop.size() && loop[at] != b; ++at)
                EXPECT_LE(distance_to(loop[at], a, b), 0.07 * edge_length);
            if (at == first + 1) continue;
            EXPECT_LE((b - a).norm(), 4.0 / 3.0 * edge_length);
        }
        EXPECT_EQ(at, loop.size());
    }
}

TEST(CoarsenBorder, LeavesOutOnlyWhatIsFinerThanTheEdgeLength)
{
    for (const Shape& shape : shapes())
        for (const double factor : {0.3, 1.0, 5.0, 100.0}) {
            SCOPED_TRACE(shape.name);
            const BorderLoops border = to_border_loops(shape.outline, shape.holes);
            expect_coarse(border, coarsen_border(border, factor * shape.edge_length),
                          factor * shape.edge_length);
        }
    const BorderLoops disc = {regular(64, 0.5)};  // sides of 0.049
    EXPECT_EQ(coarsen_border(disc, 1.4 * 0.049), disc);
    EXPECT_EQ(coarsen_border(disc, 0.1)[0].size(), 32u);
    EXPECT_EQ(coarsen_border({regular(10000, 0.5)}, 0.05)[0].size(), 63u);
    EXPECT_EQ(coarsen_border({star(5, 0.5, 0.2)}, 0.5)[0].size(), 10u);
}

TEST(CoarsenBorder, KeepsARaggedBorderFreeOfCrossings)
{
    std::mt19937 random(5);
    const auto uniform = [&] { return std::uniform_real_distribution<>(-1, 1)(random); };
    for (int k = 0; k < 40; ++k) {
        // Two ragged loops a hair apart: what one may leave out depends on the other.
        const double edge_length = 0.01 * std::pow(10.0, 1.0 + uniform()), gap = 1e-3 * (1.1 + uniform());
        Polygon outline = regular(400, 0.5), hole = regular(300, 0.5 - gap);
        for (Vec2& corner : outline) corner *= 1.0 + 0.4 * gap * uniform();
        for (Vec2& corner : hole) corner *= 1.0 + 0.4 * gap * uniform();
        const BorderLoops border = to_border_loops(outline, {hole});
        if (find_border_defect(border)) continue;
        expect_coarse(border, coarsen_border(border, edge_length), edge_length);
    }
}

TEST(BorderDefect, IsFoundAmongAsManyCornersAsAreAllowed)
{
    Polygon outline = regular(kMostOutlineCorners, 0.5);
    EXPECT_FALSE(find_border_defect({outline}));
    outline.push_back({0.5, -1e-9});
    ASSERT_TRUE(find_border_defect({outline}));
    EXPECT_EQ(find_border_defect({outline})->wrong, "has, with its holes, 100001 corners");
}

// --- defects

struct Defective {
    const char* name;
    Polygon outline;
    std::vector<Polygon> holes;
    int loop;
    const char* wrong;
};

const Polygon kSquare = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
const Polygon kInner = {{0.2, 0.2}, {0.6, 0.2}, {0.6, 0.6}, {0.2, 0.6}};

TEST(BorderDefect, IsNamedWithItsPlace)
{
    const std::vector<Defective> all = {
        {"point", {{0, 0}, {0, 0}, {0, 0}}, {}, 0, "has fewer than three different corners"},
        {"two points", {{0, 0}, {1, 0}, {1, 0}, {0, 0}}, {}, 0, "has fewer than three different corners"},
        {"line",
         {{0, 0}, {1, 0}, {2, 0}},
         {},
         0,
         "its side from [2, 0] to [0, 0] runs through the corner [1, 0]"},
        {"bow tie",
         {{0, 0}, {1, 1}, {1, 0}, {0, 1}},
         {},
         0,
         "its side from [1, 0] to [0, 1] crosses the side from [0, 0] to [1, 1]"},
        {"bow tie with a hole's corner in its middle",
         {{0, 0}, {1, 1}, {1, 0}, {0, 1}},
         {{{0.5, 0.5}, {0.4, 0.45}, {0.4, 0.55}}},
         0,
         "its side from [1, 0] to [0, 1] crosses the side from [0, 0] to [1, 1]"},
        {"bow tie with a hole at its corner",
         {{0, 0}, {1, 1}, {1, 0}, {0, 1}},
         {{{0, 0}, {0.1, 0.5}, {0.2, 0.5}}},
         0,
         "its side from [1, 0] to [0, 1] crosses the side from [0, 0] to [1, 1]"},
        {"pinched",
         {{0, 0}, {1, 0}, {0.5, 0.5}, {1, 1}, {0, 1}, {0.5, 0.5}},
         {},
         0,
         "comes to a corner twice: [0.5, 0.5]"},
        {"spur", {{0, 0}, {1, 0}, {1, 1}, {1, 2}, {1, 1}, {0, 1}}, {}, 0, "comes to a corner twice: [1, 1]"},
        {"touching side",
         {{0, 0}, {1, 0}, {1, 1}, {0.5, 0}, {0, 1}},
         {},
         0,
         "its side from [0, 0] to [1, 0] runs through the corner [0.5, 0]"},
        {"hole of a point",
         kSquare,
         {{{0.5, 0.5}, {0.5, 0.5}, {0.5, 0.5}}},
         1,
         "has fewer than three different corners"},
        {"hole across",
         kSquare,
         {kInner, {{0.7, 0.5}, {1.5, 0.5}, {0.8, 0.8}}},
         2,
         "its side from [0.8, 0.8] to [1.5, 0.5] crosses the side from [1, 0] to [1, 1] of the outline"},
        {"hole at a corner",
         kSquare,
         {{{0, 0}, {0.5, 0.3}, {0.3, 0.5}}},
         1,
         "comes to a corner twice: [0, 0] of the outline"},
        {"hole at a side",
         kSquare,
         {{{0.5, 0}, {0.7, 0.3}, {0.3, 0.5}}},
         0,
         "its side from [0, 0] to [1, 0] runs through the corner [0.5, 0] of holes.0"},
        {"hole outside", kSquare, {kInner, {{2, 0}, {3, 0}, {2, 1}}}, 2, "lies outside the outline"},
        {"hole around", kInner, {kSquare}, 1, "lies outside the outline"},
        {"hole in a hole",
         kSquare,
         {kInner, {{0.3, 0.3}, {0.4, 0.3}, {0.3, 0.4}}},
         2,
         "lies in another hole"},
        {"crossing holes",
         kSquare,
         {kInner, {{0.5, 0.3}, {0.9, 0.3}, {0.9, 0.4}}},
         2,
         "its side from [0.9, 0.3] to [0.5, 0.3] crosses the side from [0.6, 0.6] to [0.6, 0.2] of holes.0"},
        {"far away",
         {{1e5, 0}, {1e5 + 1, 0}, {1e5, 1}},
         {},
         0,
         "is 1 m large and lies 1e+05 m from the origin of the material, where rounding distorts it"},
    };
    for (const Defective& c : all) {
        const std::optional<BorderDefect> defect = find_border_defect(to_border_loops(c.outline, c.holes));
        ASSERT_TRUE(defect) << c.name;
        EXPECT_EQ(defect->loop, c.loop) << c.name;
        EXPECT_EQ(defect->wrong, c.wrong) << c.name;
    }
}

bool sides_meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d)
{
    const auto turn = [](const Vec2& p, const Vec2& q, const Vec2& r) {
        const double doubled = twice_area(p, q, r);  // exact: whole coordinates
        return doubled > 0.0 ? 1 : doubled < 0.0 ? -1 : 0;
    };
    const auto covers = [&](const Vec2& p, const Vec2& q, const Vec2& r) {
        return turn(p, q, r) == 0 && (r - p).dot(r - q) <= 0.0;
    };
    if (covers(a, b, c) || covers(a, b, d) || covers(c, d, a) || covers(c, d, b)) return true;
    return turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0;
}

// Two neighbouring sides may share their corner alone.
bool touches_itself(const Polygon& loop)
{
    const std::size_t n = loop.size();
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j) {
            const Vec2 &a = loop[i], &b = loop[(i + 1) % n], &c = loop[j], &d = loop[(j + 1) % n];
            const bool is_next = j == i + 1, is_last = i == 0 && j + 1 == n;
            if (!is_next && !is_last && sides_meet(a, b, c, d)) return true;
            if (is_next && std::abs(twice_area(a, b, d)) < 0.5 && (a - b).dot(d - b) > 0.0) return true;
            if (is_last && std::abs(twice_area(c, d, b)) < 0.5 && (c - a).dot(b - a) > 0.0) return true;
        }
    return false;
}

TEST(BorderDefect, AgreesWithBruteForceOnASmallGrid)
{
    std::mt19937 random(11);
    int sound = 0;
    for (int k = 0; k < 20000; ++k) {
        Polygon polygon;
        const int corners = 3 + k % 5;
        for (int c = 0; c < corners; ++c)
            polygon.emplace_back(std::uniform_int_distribution<>(0, 5)(random),
                                 std::uniform_int_distribution<>(0, 5)(random));
        const Polygon loop = to_border_loops(polygon, {})[0];
        if (loop.size() < 3) continue;
        const bool is_defective = touches_itself(loop);
        sound += is_defective ? 0 : 1;
        EXPECT_EQ(find_border_defect({loop}).has_value(), is_defective) << k;
    }
    EXPECT_GT(sound, 1000);
}

// --- folds

// Length of the mesh edges that lie on the fold's line.
double length_on(const FoldLine& fold, const ClothMesh& mesh)
{
    const Vec2 along = (fold.line[1] - fold.line[0]).normalized();
    const auto off = [&](int v) {
        const Vec2 from = mesh.material[v] - fold.line[0];
        return std::abs(along.x() * from.y() - along.y() * from.x());
    };
    double length = 0.0;
    const MeshTopology topology = make_topology(mesh.vertex_count(), mesh.faces);
    for (const MeshEdge& edge : topology.edges)
        if (off(edge.a) < 1e-13 && off(edge.b) < 1e-13)
            length += (mesh.material[edge.a] - mesh.material[edge.b]).norm();
    return length;
}

struct FoldedShape {
    const char* name;
    BorderLoops border;
    FoldLine fold;
    double length;  // of the line inside the cloth or on its border
};

TEST(ClothOutline, IsFoldedAlongEveryPartOfALineInIt)
{
    const BorderLoops ring = to_border_loops(box({0, 0}, {1, 1}), {box({0.4, 0.4}, {0.6, 0.6})});
    const BorderLoops teeth = to_border_loops(comb(4, 0.1), {});
    const std::vector<FoldedShape> all = {
        {"through a hole", ring, {{Vec2(0, 0.5), Vec2(1, 0.5)}, 40.0}, 0.8},
        {"beside a hole", ring, {{Vec2(0, 0.3), Vec2(1, 0.3)}, 40.0}, 1.0},
        {"along a hole's side", ring, {{Vec2(0, 0.4), Vec2(1, 0.4)}, 40.0}, 1.0},
        {"along the border", ring, {{Vec2(0, 0), Vec2(1, 0)}, 40.0}, 1.0},
        {"through corners", ring, {{Vec2(0, 0), Vec2(1, 1)}, 40.0}, 0.8 * std::numbers::sqrt2},
        {"through a hole's corner", ring, {{Vec2(0, 0.8), Vec2(0.8, 0)}, 40.0}, 0.8 * std::numbers::sqrt2},
        {"across teeth", teeth, {{Vec2(-1, 0.4), Vec2(1, 0.4)}, 40.0}, 0.4},
        {"across teeth, slanted", teeth, {{Vec2(0, 0.1), Vec2(0.7, 0.45)}, 40.0}, 0.4 * std::hypot(1.0, 0.5)},
        {"along the gaps' ends", teeth, {{Vec2(0, 0.8), Vec2(0.7, 0.8)}, 40.0}, 0.7},
        {"across a star", {star(5, 0.5, 0.2)}, {{Vec2(-1, 0.0), Vec2(1, 0.0)}, 40.0}, 0.7},
    };
    for (const FoldedShape& c : all) {
        SCOPED_TRACE(c.name);
        ClothMesh mesh = make_cloth_outline({c.border, 0.06, {c.fold}});
        expect_sound(mesh, c.border);
        EXPECT_NEAR(length_on(c.fold, mesh), c.length, 1e-12);
        fold_cloth({c.fold}, mesh);
        for (const Face& face : mesh.faces)
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR((mesh.world[face[k]] - mesh.world[face[(k + 1) % 3]]).norm(),
                            (mesh.material[face[k]] - mesh.material[face[(k + 1) % 3]]).norm(), 1e-14);
    }
}

TEST(ClothOutline, IsFoldedAlongCrossingLines)
{
    const BorderLoops border = {regular(48, 0.5)};
    const std::vector<FoldLine> folds = {{{Vec2(-1, 0.02), Vec2(1, 0.1)}, 30.0},
                                         {{Vec2(0.1, -1), Vec2(0.1, 1)}, 0.0},
                                         {{Vec2(-1, -1), Vec2(1, 1)}, 0.0}};
    const ClothMesh mesh = make_cloth_outline({border, 0.05, folds});
    expect_sound(mesh, border);
    for (const FoldLine& fold : folds) EXPECT_GT(length_on(fold, mesh), 0.9);
}

TEST(ClothOutline, RefusesFoldsThatMissIt)
{
    const BorderLoops ell = {{{0, 0}, {1, 0}, {1, 0.4}, {0.4, 0.4}, {0.4, 1}, {0, 1}}};
    for (const FoldLine& fold :
         {FoldLine{{Vec2(2, 0), Vec2(2, 1)}, 10.0}, FoldLine{{Vec2(1.4, 0), Vec2(0, 1.4)}, 10.0},
          FoldLine{{Vec2(2, 0), Vec2(0, -2)}, 10.0}, FoldLine{{Vec2(0, 1), Vec2(-1, 0)}, 10.0}})
        EXPECT_THROW(make_cloth_outline({ell, 0.1, {fold}}), InputError);
}

}  // namespace
}  // namespace arris
