// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/face_faults.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

#include "geometry/cloth_input/cloth_file.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kCells = 6;

/// An OBJ file of sheets, each of `kCells` x `kCells` cells of .1 m, and single faces.
class Cloth {
  public:
    enum class Uvs { None, OfPlaces, OfSheets };

    explicit Cloth(Uvs uvs = Uvs::None) : uvs_(uvs) {}

    /// Adds a sheet at `place`. `diagonal`: which way its cells are cut; 2 leaves them whole. Faces whose
    /// number is in `turned` run the other way. Returns the number of the sheet's first vertex, from 1.
    int add_sheet(
        const Vec3& place, int diagonal = 0, const std::set<int>& turned = {},
        const std::function<Vec3(const Vec3&)>& bend = [](const Vec3& x) { return x; }, int cells = kCells)
    {
        const int first = vertices_ + 1;
        for (int j = 0; j <= cells; ++j)
            for (int i = 0; i <= cells; ++i) {
                const Vec3 x = place + Vec3(0.6 * i / cells, 0.6 * j / cells, 0.0);
                add_vertex(bend(x), x + Vec3(sheets_ * (uvs_ == Uvs::OfSheets ? 5.0 : 0.0), 0.0, 0.0));
            }
        int face = 0;
        const auto add = [&](std::vector<int> corners) {
            if (turned.count(face++) > 0) std::reverse(corners.begin(), corners.end());
            add_face(corners);
        };
        for (int j = 0; j < cells; ++j)
            for (int i = 0; i < cells; ++i) {
                const int a = first + j * (cells + 1) + i, b = a + 1, c = b + cells + 1, d = c - 1;
                if (diagonal == 2) {
                    add({a, b, c, d});
                } else if (diagonal == 0) {
                    add({a, b, c});
                    add({a, c, d});
                } else {
                    add({a, b, d});
                    add({b, c, d});
                }
            }
        ++sheets_;
        return first;
    }

    /// Returns the vertex's number.
    int add_vertex(const Vec3& x, const Vec3& uv)
    {
        text_ += fmt::format("v {} {} {}\n", x.x(), x.y(), x.z());
        if (uvs_ != Uvs::None) text_ += fmt::format("vt {} {}\n", uv.x(), uv.y());
        ++vertices_;
        return vertices_;
    }

    /// Returns the face's line in the file.
    int add_face(const std::vector<int>& corners)
    {
        text_ += "f";
        for (const int v : corners)
            text_ += uvs_ == Uvs::None ? fmt::format(" {}", v) : fmt::format(" {0}/{0}", v);
        text_ += "\n";
        return static_cast<int>(std::count(text_.begin(), text_.end(), '\n'));
    }

    /// The line of the sheet's face `k`, where the cloth is one sheet without more vertices.
    int line_of(int k) const { return vertices_ * (uvs_ == Uvs::None ? 1 : 2) + k + 1; }

    std::string refusal() const
    {
        const std::string name = ::testing::UnitTest::GetInstance()->current_test_info()->name();
        const auto path = std::filesystem::path(::testing::TempDir()) / ("arris_faults_" + name + ".obj");
        std::ofstream(path) << text_;
        std::string message;
        try {
            read_cloth_file(path.string(), 1.0, 'z');
        } catch (const InputError& error) {
            message = error.what();
        }
        std::filesystem::remove(path);
        return message;
    }

  private:
    Uvs uvs_;
    std::string text_;
    int vertices_ = 0, sheets_ = 0;
};

using Uvs = Cloth::Uvs;

Vec3 tilt(const Vec3& x)
{
    return {x.x(), 0.8 * x.y() - 0.6 * x.z(), 0.6 * x.y() + 0.8 * x.z()};
}

Vec3 arch(const Vec3& x)
{
    return {x.x(), std::sin(x.y()), std::cos(x.y())};
}

TEST(FaceFaults, LayersThatCoincideAreToldToStartApart)
{
    struct Case {
        const char* name;
        std::function<void(Cloth&)> make;
        Uvs uvs = Uvs::None;
        const char* says = "layers coincide, in ";
    };
    const Vec3 o = Vec3::Zero();
    const Case kCases[] = {
        {"two", [&](Cloth& c) { c.add_sheet(o), c.add_sheet(o); }},
        {"three", [&](Cloth& c) { c.add_sheet(o), c.add_sheet(o), c.add_sheet(o); }},
        {"partly",
         [&](Cloth& c) {
             c.add_sheet(o), c.add_sheet({0.3, 0.2, 0.0});
         }},
        {"two of three",
         [&](Cloth& c) {
             c.add_sheet(o), c.add_sheet({0, 0, 0.01}), c.add_sheet(o);
         }},
        {"with UVs of their own", [&](Cloth& c) { c.add_sheet(o), c.add_sheet(o); }, Uvs::OfSheets},
        {"with the same UVs", [&](Cloth& c) { c.add_sheet(o), c.add_sheet(o); }, Uvs::OfPlaces},
        {"one turned over",
         [&](Cloth& c) {
             c.add_sheet(o);
             std::set<int> all;
             for (int f = 0; f < 2 * kCells * kCells; ++f) all.insert(f);
             c.add_sheet(o, 0, all);
         }},
        {"of quads", [&](Cloth& c) { c.add_sheet(o, 2), c.add_sheet(o, 2); }},
        {"curved", [&](Cloth& c) { c.add_sheet(o, 0, {}, arch), c.add_sheet(o, 0, {}, arch); },
         Uvs::OfSheets},
        {"other diagonals", [&](Cloth& c) { c.add_sheet(o, 0), c.add_sheet(o, 1); }, Uvs::None,
         "two layers coincide there: start them apart"},
        {"other diagonals, tilted",
         [&](Cloth& c) { c.add_sheet(o, 0, {}, tilt), c.add_sheet(o, 1, {}, tilt); }, Uvs::OfSheets,
         "two layers coincide there: start them apart"},
        {"other cells in one plane",
         [&](Cloth& c) {
             c.add_sheet(o), c.add_sheet(
                                 {0.01, 0.02, 0}, 0, {}, [](const Vec3& x) { return x; }, 5);
         },
         Uvs::None, "layers that coincide must start apart"},
    };
    for (const Case& one : kCases) {
        SCOPED_TRACE(one.name);
        Cloth cloth(one.uvs);
        one.make(cloth);
        EXPECT_THAT(cloth.refusal(), HasSubstr(one.says));
        EXPECT_THAT(cloth.refusal(), Not(HasSubstr("is there twice")));
    }
    // A face of the same vertices is no layer.
    Cloth twice;
    const int a = twice.add_sheet(o);
    const int line = twice.add_face({a + 1, a, a + kCells + 2});
    EXPECT_THAT(twice.refusal(), HasSubstr(fmt::format("the face of line {} (at 0.1, 0, 0 m) is there twice, "
                                                       "first in line {}",
                                                       line, line - 2 * kCells * kCells)));
}

TEST(FaceFaults, AnEdgeOfMoreThanTwoFacesIsNamed)
{
    struct Case {
        const char* name;
        int a, b;  ///< vertices of the sheet, from its first, between which the fin stands
        int fins;
        Uvs uvs;
        Vec3 tip;
        bool has_seam = false;  ///< the fin has other UVs at the edge
    };
    const int row = kCells + 1;
    const Case kCases[] = {
        {"inside, without UVs", 2 * row + 2, 2 * row + 3, 1, Uvs::None, {0.2, 0.2, 0.3}},
        {"inside, with UVs", 2 * row + 2, 2 * row + 3, 1, Uvs::OfPlaces, {0.2, 0.2, 0.3}},
        {"along the other direction", 2 * row + 2, 3 * row + 2, 1, Uvs::None, {0.2, 0.2, 0.3}},
        {"on a diagonal", 2 * row + 2, 3 * row + 3, 1, Uvs::None, {0.2, 0.2, 0.3}},
        {"two fins", 2 * row + 2, 2 * row + 3, 2, Uvs::None, {0.2, 0.2, 0.3}},
        {"two fins at the border", 2, 3, 2, Uvs::None, {0.2, -0.2, 0.3}},
        {"three fins at a corner", 0, 1, 3, Uvs::None, {0.1, -0.2, 0.3}},
        {"low fin", 2 * row + 2, 2 * row + 3, 1, Uvs::None, {0.25, 0.3, 1e-4}},
        {"fin with UVs of its own", 2 * row + 2, 2 * row + 3, 1, Uvs::OfPlaces, {0.2, 0.2, 0.3}, true},
    };
    for (const Case& one : kCases) {
        SCOPED_TRACE(one.name);
        Cloth cloth(one.uvs);
        const int first = cloth.add_sheet(Vec3::Zero());
        int a = first + one.a, b = first + one.b;
        std::vector<int> lines;
        std::vector<int> tips;
        const auto place = [&](int v) {
            return Vec3(0.6 * (v % row) / kCells, 0.6 * (v / row) / kCells, 0.0);
        };
        if (one.has_seam) {
            a = cloth.add_vertex(place(one.a), {7, 0, 0});
            b = cloth.add_vertex(place(one.b), {8, 0, 0});
        }
        for (int k = 0; k < one.fins; ++k)
            tips.push_back(cloth.add_vertex(one.tip + Vec3(0, 0.1 * k, 0), one.tip + Vec3(7, 1.0 + k, 0)));
        for (const int tip : tips) lines.push_back(cloth.add_face({a, b, tip}));
        const std::string message = cloth.refusal();
        EXPECT_THAT(message, HasSubstr(fmt::format("edge ({}, {}) has more than two faces (", first + one.a,
                                                   first + one.b)));
        for (const int line : lines)
            EXPECT_THAT(message, ::testing::ContainsRegex(fmt::format("[ (]{}[,)]", line)));
        EXPECT_THAT(message, HasSubstr("allowed: cloth that does not branch"));
    }
}

TEST(FaceFaults, TurnedFacesAreNamedByTheirLines)
{
    struct Case {
        const char* name;
        std::set<int> turned;
        Uvs uvs = Uvs::None;
        int diagonal = 0;
        std::function<Vec3(const Vec3&)> bend = [](const Vec3& x) { return x; };
    };
    const Case kCases[] = {
        {"inside", {2 * kCells + 5}},
        {"the first", {0}},
        {"the last, at a corner", {2 * kCells * kCells - 1}},
        {"inside, with UVs", {2 * kCells + 5}, Uvs::OfPlaces},
        {"two apart", {3, 40}, Uvs::OfPlaces},
        {"an island", {26, 27, 28, 29, 38, 39, 40, 41}},
        {"an island, with UVs", {26, 27, 28, 29, 38, 39, 40, 41}, Uvs::OfPlaces},
        {"a quad", {7}, Uvs::None, 2},
        {"a quad, with UVs", {7}, Uvs::OfPlaces, 2},
        {"in tilted cloth", {5}, Uvs::None, 0, tilt},
        {"in curved cloth", {5, 9, 50}, Uvs::OfPlaces, 0, arch},
    };
    for (const Case& one : kCases) {
        SCOPED_TRACE(one.name);
        Cloth cloth(one.uvs);
        cloth.add_sheet(Vec3::Zero(), one.diagonal, one.turned, one.bend);
        const std::string message = cloth.refusal();
        EXPECT_THAT(message, HasSubstr("turned over against"));
        EXPECT_THAT(message, Not(HasSubstr("tube")));
        for (const int face : one.turned)
            EXPECT_THAT(message, ::testing::ContainsRegex(fmt::format("[ ]{}[ ,;]", cloth.line_of(face))));
    }
    // More than eight lines are counted, and a mirrored chart turns the majority.
    Cloth many;
    std::set<int> turned;
    for (int f = 0; f < 20; ++f) turned.insert(f);
    many.add_sheet(Vec3::Zero(), 0, turned);
    EXPECT_THAT(many.refusal(),
                HasSubstr("20 of 72 triangles are turned over against their neighbours: the faces of "
                          "lines 50, 51, 52, 53, 54, 55, 56, 57 and 12 more"));
}

TEST(FaceFaults, AFoldedChartIsNoTurnedFace)
{
    Cloth folded(Uvs::OfPlaces);
    folded.add_vertex({0, 0, 0}, {0, 0, 0});
    folded.add_vertex({1, 0, 0}, {1, 0, 0});
    folded.add_vertex({1, 1, 0}, {1, 1, 0});
    folded.add_vertex({0, 1, 0}, {1, 0.2, 0});
    folded.add_face({1, 2, 3});
    folded.add_face({1, 3, 4});
    EXPECT_THAT(folded.refusal(),
                HasSubstr("the chart is folded at edge (1, 3), between the faces of lines 9 and 10"));
}

}  // namespace
}  // namespace arris
