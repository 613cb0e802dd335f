// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obj_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/input_error.h"
#include "tests/app/error_of.h"

namespace arris {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kMark = "\xef\xbb\xbf";

TEST(ObjFile, VerticesHaveThreeNumbersInEverySpelling)
{
    const std::pair<std::string, Vec3> cases[] = {
        {"v 1 2 3", {1, 2, 3}},
        {"V\t1 \v2  3 ", {1, 2, 3}},
        {kMark + kMark + " v 1 2 3", {1, 2, 3}},
        {"v 1 \\\n2 \\\n3", {1, 2, 3}},
        {"v 1 \\\n# why\n#why\\\n2 3", {1, 2, 3}},
        {"v 1 \\ # why\n2 3#", {1, 2, 3}},
        {"v .5 -.5 +1.D+00", {0.5, -0.5, 1}},
        // Lengths at which the import library misreads numbers.
        {"v 100000000000000000000000000000e-29 0.00000000000000000000000000001e29 314159265358979323846e-20",
         {1, 1, 3.14159265358979323846}},
        {"v 0.99999999999999999999999999999999999999 00000000000000000000000000000001 1.0e+00000000000",
         {1, 1, 1}},
        {"v 0.1 0.30000000000000004 1e-46", {0.1, 0.30000000000000004, 1e-46}},
        // A weight, colours, and colours with alpha.
        {"v 2 4 6 2", {1, 2, 3}},
        {"v 1 2 3 0.5 0.5", {1, 2, 3}},
        {"v 1 2 3 0 0 0", {1, 2, 3}},
        {"v 1 2 3 1 0 0 1", {1, 2, 3}},
        {"v 1 2 3 1 0 0 1 1", {1, 2, 3}},
    };
    for (const auto& [text, place] : cases) {
        const ObjFile file = read_obj(text + "\nv 9 9 9\nf 1 2 1\n");
        ASSERT_EQ(file.vertices.size(), 2u) << text;
        EXPECT_EQ(file.vertices[0].place, place) << text;
        EXPECT_EQ(file.vertices[0].line, 1) << text;
        EXPECT_EQ(file.vertices[1].line, 2 + std::count(text.begin(), text.end(), '\n')) << text;
    }
}

TEST(ObjFile, CornersNameVerticesAndUvs)
{
    const std::string before = "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1\nvt 1 1 0 9\nvn 0 0 1\n";
    const struct {
        const char* face;
        std::vector<int> vertices, uvs;
    } cases[] = {
        {"f 1 2 3", {0, 1, 2}, {-1, -1, -1}},
        {"F 1/1 2/2 3/3", {0, 1, 2}, {0, 1, 2}},
        {"fo 1//1 2//1 3//1", {0, 1, 2}, {-1, -1, -1}},
        {"f 3/1/1 2/2/1 1/3/1", {2, 1, 0}, {0, 1, 2}},
        {"f -3/-3 -2/-2 -1/-1", {0, 1, 2}, {0, 1, 2}},
        {"f 1/ 2// +3", {0, 1, 2}, {-1, -1, -1}},
        {"f 0001 2 \\\n# c\n 3", {0, 1, 2}, {-1, -1, -1}},
        {"f 1/91/92 2/91 3/91", {0, 1, 2}, {90, 90, 90}},
    };
    for (const auto& c : cases) {
        const ObjFile file = read_obj(before + c.face);
        EXPECT_THAT(file.corner_counts, ElementsAre(3)) << c.face;
        std::vector<int> vertices, uvs;
        for (const ObjCorner& corner : file.corners) {
            vertices.push_back(corner.vertex);
            uvs.push_back(corner.uv);
            EXPECT_EQ(corner.line, 8) << c.face;
        }
        EXPECT_EQ(vertices, c.vertices) << c.face;
        EXPECT_EQ(uvs, c.uvs) << c.face;
        EXPECT_EQ(file.uvs[1].place, Vec2(1, 0)) << "v is 0 where it is left out";
        EXPECT_THAT(file.warnings, IsEmpty()) << c.face;
    }
}

TEST(ObjFile, LinesAndPointsAreElements)
{
    const ObjFile file = read_obj("l 1/1 2 3\np 2\nv 0 0 0\nv 1 0 0\nv 1 1 0\np -1\n");
    EXPECT_THAT(file.segments, ElementsAre(std::array<int, 2>{0, 1}, std::array<int, 2>{1, 2}));
    EXPECT_EQ(file.line_and_point_count, 3);
}

TEST(ObjFile, DefectsAreToldWithLineValueAndWhatIsAllowed)
{
    const std::string v = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
    const struct {
        const char* name;
        std::string text;
        const char* says;
    } cases[] = {
        {"word", "v 0 0 0\nv 1 0 x\n", "line 2: 'v 1 0 x': 'x' is no number; allowed: 'v x y z'"},
        {"word for a colour", "v 0 0 0 red\n", "line 1: 'v 0 0 0 red': 'red' is no number"},
        {"too large", "v 1e400 0 0\n", "'1e400' is beyond double precision"},
        {"weight 0", "v 1 2 3 0\n", "its weight is 0; allowed: a finite weight other than 0"},
        {"weight that is not finite", "v 1 2 3 nan\n", "its weight is nan"},
        {"two numbers", "v 1 2\n", "2 numbers, but a vertex has 3"},
        {"uv of words", "vt x y\n", "line 1: 'vt x y': 'x' is no number; allowed: 'vt u v'"},
        {"uv of nothing", "vt\n", "a UV without a number"},
        {"other word", "vertex 0 0 0\n",
         "'vertex' is no statement of OBJ; allowed: v, vt, vn, vp, f, l or p"},
        {"no blank", "v0 0 0\n", "'v0' is no statement of OBJ"},
        {"blank that is none",
         "v\xc2\xa0"
         "0 0 0\n",
         "is no statement of OBJ"},
        {"face without a blank", v + "f1 2 3\n", "line 4: 'f1 2 3': 'f1' is no statement of OBJ"},
        {"third slash", v + "f 1 2 3/1/1/1\n", "'3/1/1/1' has more than two slashes"},
        {"slash alone", v + "f 1 /1 2 3\n", "'' is no index"},
        {"fraction", v + "f 1.0 2 3\n", "'1.0' is no index"},
        {"normal that is none", v + "f 1//x 2 3\n", "'x' is no index"},
        {"two corners", v + "f 1 2\n", "a face of 2 corners; at least 3 are needed"},
        {"one end", v + "l 1\n", "1 vertex is too few; allowed: 'l' and at least 2 vertices"},
        {"zero", v + "f 0 1 2\n", "it names vertex 0, but there are 3 so far"},
        {"back too far", v + "p -4\n", "it names vertex -4, but there are 3 so far"},
        {"back before any", "f -1 -2 -3\n" + v, "line 1: 'f -1 -2 -3': it names vertex -1, but there are 0"},
        {"beyond", "l 1 4\n" + v, "line 1: it names vertex 4, but there are 3, counted from 1"},
        {"continued", "v 1 \\\n2 \\\n# c\nz\n", "line 1: 'v 1  2  z ': 'z' is no number"},
        {"after a continued one", "v 1 \\\n2 3\nv 1 2\n", "line 3: 'v 1 2': 2 numbers"},
        {"zero byte", std::string("v 0 \0 0", 7), "zero byte"},
        {"UTF-16", std::string("\xff\xfev\0 \0", 6), "UTF-16"},
    };
    for (const auto& c : cases) EXPECT_THAT(error_of([&] { read_obj(c.text); }), HasSubstr(c.says)) << c.name;
}

TEST(ObjFile, WhatIsNotReadIsToldIfItMayBeAShape)
{
    const std::string v = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";
    const struct {
        const char* text;
        std::vector<std::string> says;
    } cases[] = {
        {"o a\ng b c\ns off\nusemtl x\nmtllib y.mtl\nvn 0 0 1\nvp 0 0\nlod 2\nshadow_obj z\n\x1a", {}},
        {"# surf\ncurv 0 1 1 2\n", {"its 1 free-form curve or surface ('curv', 'surf') is not read"}},
        {"surf 0 1\nbzp 1 2\n", {"its 2 free-form curves and surfaces ('curv', 'surf') are not read"}},
        {"call other.obj\n", {"its 1 statement ('call', 'csh') that includes another file is not followed"}},
        {"foo 1\nLine 1 2\n", {"2 statements are none of OBJ and not read, the first in line 5: 'foo 1'"}},
    };
    for (const auto& c : cases) EXPECT_EQ(read_obj(v + c.text).warnings, c.says) << c.text;
}

}  // namespace
}  // namespace arris
