// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/formats/plain_mesh.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/input_error.h"
#include "geometry/obstacle_input/formats/ply_file.h"
#include "geometry/obstacle_input/formats/stl_file.h"
#include "tests/app/error_of.h"
#include "tests/geometry/mesh_files.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kMark = "\xef\xbb\xbf";
const std::string kFacet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
const std::string kSolid = "solid a\n" + kFacet + "endsolid a\n";

std::string replaced(std::string text, const std::string& what, const std::string& by)
{
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
}

TEST(StlFile, TextIsReadInEverySpelling)
{
    const struct {
        const char* name;
        std::string text;
        std::size_t faces;
    } cases[] = {
        {"plain", kSolid, 1},
        {"two solids, joined with their marks", kMark + kSolid + kMark + kSolid, 2},
        {"comment with #", "# made by hand\n\n" + kSolid, 1},
        {"comment with //", "// made by hand\n" + kSolid + "// end\n", 1},
        {"comment behind a statement", replaced(kSolid, "outer loop", "outer loop # of 3"), 1},
        {"keywords in two words", replaced(replaced(kSolid, "endloop", "end loop"), "endfacet", "End Facet"),
         1},
        {"name of keywords", replaced(kSolid, "solid a", "solid facet normal"), 1},
        {"name of more keywords", replaced(kSolid, "solid a", "solid facet normal 1 2 3 outer"), 1},
        {"normals that are none", replaced(kSolid, "0 0 1", "-1.#IND 1.#QNAN nan(ind)"), 1},
        {"normal left out", replaced(kSolid, "facet normal 0 0 1", "facet"), 1},
        {"numbers of a normal left out", replaced(kSolid, "0 0 1\n", ""), 1},
        {"long numbers", replaced(kSolid, "vertex 1 0 0", "vertex 100000000000000000000000000000e-29 .0 0."),
         1},
        {"other statements", replaced(kSolid, "facet", "color 1 0 0\nfacet"), 1},
    };
    for (const auto& c : cases) {
        const PlainMesh mesh = read_stl(c.text);
        EXPECT_EQ(mesh.corner_counts, std::vector<int>(c.faces, 3)) << c.name;
        ASSERT_EQ(mesh.points.size(), 3 * c.faces) << c.name;
        for (std::size_t f = 0; f < c.faces; ++f) {
            EXPECT_EQ(mesh.points[3 * f + 1], Vec3(1, 0, 0)) << c.name;
            EXPECT_EQ(mesh.points[3 * f + 2], Vec3(0, 1, 0)) << c.name;
        }
        EXPECT_FALSE(mesh.is_single) << c.name;
    }
}

TEST(StlFile, OneLineMayHoldAFile)
{
    std::string line = "solid a b " + kFacet + kFacet + "endsolid a b solid c " + kFacet + "endsolid c";
    std::replace(line.begin(), line.end(), '\n', ' ');
    EXPECT_EQ(read_stl(line).corner_counts.size(), 3u);
}

TEST(StlFile, FewBytesMayFollowABinaryFile)
{
    const std::string stl = mesh_files::binary_stl(samples::box(Vec3::Zero(), Vec3(1, 2, 3)));
    EXPECT_TRUE(read_stl(stl).is_single);
    EXPECT_THAT(read_stl(stl).warnings, IsEmpty());
    EXPECT_EQ(read_stl(stl + "xy").corner_counts.size(), 12u);
    EXPECT_THAT(read_stl(stl + "xy").warnings, ElementsAre("2 bytes after its 12 faces are not read"));
    EXPECT_THAT(error_of([&] { read_stl(stl + std::string(50, 'x')); }),
                HasSubstr("its header counts 12 faces"));
}

TEST(StlFile, DefectsAreToldWithTheirLine)
{
    const std::pair<std::string, const char*> cases[] = {
        {replaced(kSolid, "vertex 1 0 0", "vertex one 0 0"),
         "line 5: face 1, vertex 2: 'one' is no number; a vertex has 3"},
        {replaced(kSolid, "vertex 1 0 0", "vertex 1 0"), "line 5: face 1, vertex 2: '' is no number"},
        {replaced(kSolid, "vertex 1 0 0", "vertex 1 0 1e999"), "'1e999' is beyond double precision"},
        {replaced(kSolid, "vertex 1 0 0\n", ""), "line 7: face 1 has 2 vertices instead of 3"},
        {replaced(kSolid, "endfacet\n", "endfacet\nvertex 1 1 1\n"), "line 9: a vertex outside of a face"},
        {replaced(kSolid, "endfacet\n", ""), "truncated: face 1 has no end"},
        {replaced(kSolid, "endfacet\n", kFacet), "line 8: face 1 has no end before the next"},
        {replaced(kSolid, "endsolid a\n", ""), "truncated: no 'endsolid' after face 1"},
        {kSolid + "solid b\n" + kFacet, "truncated: no 'endsolid' after face 2"},
        {"solid a\nendsolid a\n", "no faces"},
    };
    for (const auto& [text, says] : cases)
        EXPECT_THAT(error_of([&] { read_stl(text); }), HasSubstr(says)) << text;
}

std::string ply(const std::string& elements, const std::string& body)
{
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n" +
           elements + "end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n" + body;
}

const std::string kFace = "element face 1\nproperty list uchar int vertex_indices\n";

TEST(PlyFile, FacesAreReadInEverySpelling)
{
    const std::string plain = ply(kFace, "4 0 1 3 2\n");
    std::string returns = plain;
    std::replace(returns.begin(), returns.end(), '\n', '\r');
    const std::pair<const char*, std::string> cases[] = {
        {"plain", plain},
        {"marks", kMark + kMark + plain},
        {"carriage returns", returns},
        {"other name of the list", replaced(plain, "vertex_indices", "vertex_index")},
        {"capital axes", replaced(replaced(plain, "float x", "float X"), "float y", "float Y")},
        {"real indices", replaced(plain, "uchar int", "uchar float")},
        {"empty lines", replaced(plain, "1 0 0\n", "\n1 0 0\n  \n")},
        {"numbers in every spelling", replaced(plain, "1 0 0\n", "+1.D0 .0 100e-29999\n")},
        {"list of no use", replaced(replaced(plain, kFace, kFace + "property list uchar float uv\n"), "3 2\n",
                                    "3 2 2 .5 .5\n")},
    };
    for (const auto& [name, text] : cases) {
        const PlainMesh mesh = read_ply(text);
        EXPECT_THAT(mesh.corner_counts, ElementsAre(4)) << name;
        EXPECT_THAT(mesh.corners, ElementsAre(0, 1, 3, 2)) << name;
        EXPECT_EQ(mesh.points[1], Vec3(1, 0, 0)) << name;
        EXPECT_THAT(mesh.warnings, IsEmpty()) << name;
    }
    const std::string faces_first =
        "ply\nformat ascii 1.0\n" + kFace +
        "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
        "3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n";
    EXPECT_THAT(read_ply(faces_first).corners, ElementsAre(0, 1, 2));
}

TEST(PlyFile, StripsAreTriangles)
{
    const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
    const std::pair<const char*, std::vector<int>> cases[] = {
        {"4 0 1 2 3", {0, 1, 2, 1, 3, 2}},        {"3 0 1 2", {0, 1, 2}},
        {"7 0 1 2 -1 1 3 2", {0, 1, 2, 1, 3, 2}}, {"8 0 1 2 -1 1 3 2 -1", {0, 1, 2, 1, 3, 2}},
        {"6 0 1 2 2 1 3", {0, 1, 2, 2, 3, 1}},  // joined by triangles without area
    };
    for (const auto& [body, corners] : cases)
        EXPECT_EQ(read_ply(ply(strips, std::string(body) + "\n")).corners, corners) << body;
    EXPECT_EQ(read_ply(ply(strips, "2 0 1\n")).lone_points.size(), 4u);
}

TEST(PlyFile, DefectsAreOneClearLine)
{
    const std::string plain = ply(kFace, "3 0 1 2\n");
    const std::pair<std::string, const char*> cases[] = {
        {replaced(plain, "vertex_indices", "indices"), "its element 'face' has no list of vertices; allowed"},
        {replaced(plain, "list uchar int vertex_indices", "int vertex_indices"), "has no list of vertices"},
        {replaced(plain, "element face", "element faces"), "an unknown element 'faces' with a list"},
        {replaced(plain, "element face", "element range_grid"),
         "an unknown element 'range_grid' with a list"},
        {replaced(plain, "element face", "element vertex"), "has the element 'vertex' twice"},
        {replaced(plain, "float z", "float w"),
         "its vertices have no property 'z'; allowed: vertices with x, y"},
        {replaced(plain, "\n1 0 0\n", "\n1,5 0 0\n"),
         "line 11: number 2 of element 'vertex': '1,5' is no number"},
        {replaced(plain, "\n1 0 0\n", "\n0x1 0 0\n"), "'0x1' is no number"},
        {replaced(plain, "\n1 0 0\n", "\n1 0 1e400\n"), "'1e400' is beyond double precision"},
        {replaced(plain, "\n1 0 0\n", "\n1 0\n"),
         "line 11: number 2 of element 'vertex': its line has fewer"},
        {replaced(plain, "\n1 0 0\n", "\n1 0 0 0\n"),
         "line 11: number 2 of element 'vertex': its line has more"},
        {replaced(plain, "3 0 1 2", "3 0 1 4"),
         "line 14: face 0 names vertex 4, but there are 4, counted from 0"},
        {replaced(plain, "3 0 1 2", "3 0 1 -1"), "names vertex -1"},
        {replaced(plain, "3 0 1 2", "3 0 1 1.5"), "'1.5' is no whole number"},
        {replaced(plain, "3 0 1 2\n", ""), "truncated: its header counts 1 of element 'face'"},
    };
    for (const auto& [text, says] : cases)
        EXPECT_THAT(error_of([&] { read_ply(text); }), HasSubstr(says)) << text;
}

TEST(PlyFile, ElementsThatAreNotReadAreToldOf)
{
    const std::string other = "element material 1\nproperty list uchar int vertex_indices\n";
    EXPECT_THAT(read_ply(ply(kFace + other, "3 0 1 2\n1 0\n")).warnings,
                ElementsAre("its element 'material' (1 of it) is not read"));
    const std::string edge = "element edge 1\nproperty int vertex1\nproperty int vertex2\n";
    EXPECT_THAT(read_ply(ply(edge, "0 1\n")).warnings,
                ElementsAre("its 1 edge ('element edge') is not read"));
}

}  // namespace
}  // namespace arris
