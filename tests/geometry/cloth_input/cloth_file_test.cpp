// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/cloth_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/LU>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "geometry/cloth/material_region.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kRounding = 1e-15;  // for coordinates of about 1

// Each test has its own folder.
class ClothFileTest : public ::testing::Test {
  protected:
    ClothFileTest()
        : folder_(std::filesystem::path(::testing::TempDir()) /
                  (std::string("arris_cloth_file_") +
                   ::testing::UnitTest::GetInstance()->current_test_info()->name()))
    {
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    ~ClothFileTest() override { std::filesystem::remove_all(folder_); }

    std::string write(const std::string& text, const std::string& name = "cloth.obj") const
    {
        const std::string path = (folder_ / name).string();
        std::ofstream(path, std::ios::binary) << text;
        return path;
    }

    ClothFile read(const std::string& text, double unit = 1.0, char up = 'z') const
    {
        return read_cloth_file(write(text), unit, up);
    }

    // The one line of the error, which must begin with the file's name.
    static std::string refusal_of(const std::string& path, double unit = 1.0, char up = 'z')
    {
        try {
            read_cloth_file(path, unit, up);
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), ::testing::StartsWith(path));
            EXPECT_THAT(error.what(), ::testing::Not(HasSubstr("\n")));
            return error.what();
        }
        ADD_FAILURE() << path << " was accepted";
        return {};
    }

    std::string refusal(const std::string& text) const { return refusal_of(write(text)); }

    std::filesystem::path folder_;
};

// Two triangles of a curved square with UVs 0.1 apart in the material.
constexpr const char* kSquare =
    "v 0 0 0\nv 1 0 0.5\nv 1 1 0\nv 0 1 0.5\n"
    "vt 0 0\nvt 1.1 0\nvt 1.1 1.1\nvt 0 1.1\n"
    "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";

TEST_F(ClothFileTest, ReadsPositionsAndUvs)
{
    const ClothFile file = read(kSquare);
    EXPECT_THAT(file.warnings, IsEmpty());
    EXPECT_EQ(validate(file.mesh), "");
    ASSERT_EQ(file.mesh.vertex_count(), 4);
    ASSERT_EQ(file.mesh.face_count(), 2);
    for (int v = 0; v < 4; ++v) {
        const Vec2& X = file.mesh.material[v];
        const Vec3& x = file.mesh.world[v];
        EXPECT_LT((X - 1.1 * x.head<2>()).norm(), kRounding);
        EXPECT_NEAR(x.z(), std::abs(x.x() - x.y()) * 0.5, kRounding);
    }
}

TEST_F(ClothFileTest, SaysWhichVertexEachOfTheFileIs)
{
    // v 3 is unused, v 6 has the place of v 1, and faces use the vertices in another order.
    const ClothFile plain = read("v 1 0 0\nv 0 0 0\nv 9 9 9\nv 0 1 0\nv 1 1 0\nv 1 0 0\nf 2 1 5\nf 2 5 4\n");
    EXPECT_THAT(plain.vertices, ::testing::ElementsAre(1, 0, -1, 3, 2, 1));
    // Two panels that share the places of v 1 and v 3.
    const ClothFile sewn = read(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 3 0\nvt 4 1\nvt 3 1\n"
        "f 1/1 2/2 3/3\nf 1/4 3/5 4/6\n");
    ASSERT_TRUE(sewn.mesh.has_seams());
    ASSERT_EQ(sewn.vertices.size(), 4U);
    for (std::size_t k = 0; k < 4; ++k)
        EXPECT_EQ(sewn.mesh.world[static_cast<std::size_t>(sewn.vertices[k])],
                  (std::vector{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)})[k]);
}

TEST_F(ClothFileTest, UnitScalesPositionsAndNotUvs)
{
    const ClothFile file = read(kSquare, 0.01);
    for (int v = 0; v < 4; ++v)
        EXPECT_LT((file.mesh.material[v] - 110.0 * file.mesh.world[v].head<2>()).norm(), kRounding);
}

TEST_F(ClothFileTest, UpAxisIsTurnedToZ)
{
    const std::string text =
        "v 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 0 3\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
        "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";
    const auto world = [&](char up) { return read(text, 1.0, up).mesh.world; };
    EXPECT_EQ(world('z')[2], Vec3(1, 2, 0));
    EXPECT_EQ(world('y')[2], Vec3(1, 0, 2));
    EXPECT_EQ(world('y')[3], Vec3(0, -3, 0));
    EXPECT_EQ(world('x')[2], Vec3(0, 2, 1));
    EXPECT_EQ(world('x')[3], Vec3(-3, 0, 0));
    // The axis conversion is no reflection: the volume of a frame keeps its sign.
    for (const char up : {'x', 'y', 'z'}) {
        Mat3 frame;
        frame << world(up)[1], world(up)[2], world(up)[3];
        EXPECT_DOUBLE_EQ(frame.determinant(), 6.0) << up;
    }
}

TEST_F(ClothFileTest, FlatMeshWithoutUvsIsItsOwnChart)
{
    const ClothFile flat = read("v 0.25 0.5 2\nv 1 0.5 2\nv 1 1 2\nv 0.25 1 2\nf 1 2 3 4\n");
    EXPECT_EQ(validate(flat.mesh), "");
    for (int v = 0; v < 4; ++v) EXPECT_EQ(flat.mesh.material[v], Vec2(flat.mesh.world[v].head<2>()));
    // A chart seen from below is turned over; on a slant it keeps its lengths.
    for (const char* text : {"v 0 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\nf 1 2 3 4\n",
                             "v 0 0 0\nv 0.6 0 0.8\nv 0.6 1 0.8\nv 0 1 0\nf 1 2 3 4\n",
                             "v 0 0 0\nv 0 1 0\nv 0 1 1\nv 0 0 1\nf 1 2 3 4\n"}) {
        const ClothFile file = read(text);
        EXPECT_EQ(validate(file.mesh), "");
        for (const auto& [a, b, c] : file.mesh.faces)
            EXPECT_NEAR(twice_area(file.mesh.material[a], file.mesh.material[b], file.mesh.material[c]), 1.0,
                        10 * kRounding);
    }
}

/// Square pieces without UVs, of side 1, the k-th at height[k].
std::string layers(const std::vector<double>& heights)
{
    std::string text;
    for (const double z : heights) {
        for (const char* corner : {"0 0", "1 0", "1 1", "0 1"}) text += fmt::format("v {} {}\n", corner, z);
        text += "f -4 -3 -2 -1\n";
    }
    return text;
}

TEST_F(ClothFileTest, LayersWithoutUvsAreLaidSideBySide)
{
    const ClothFile file = read(layers({0.0, 0.01, 0.02}));
    EXPECT_EQ(validate(file.mesh), "");
    EXPECT_FALSE(file.has_uv);
    ASSERT_EQ(file.mesh.vertex_count(), 12);
    for (int v = 0; v < 12; ++v) {
        const Vec3& x = file.mesh.world[v];
        EXPECT_EQ(x.z(), 0.01 * (v / 4));
        EXPECT_LT((file.mesh.material[v] - Vec2(x.x() + 1.1 * (v / 4), x.y())).norm(), 4 * kRounding) << v;
    }
    ASSERT_EQ(file.warnings.size(), 1u);
    EXPECT_THAT(
        file.warnings[0],
        HasSubstr("its 3 pieces are flat and have no UVs; they are laid side by side in the material, "
                  "at u = 0 to 1 (line 5), u = 1.1 to 2.1 (line 10), u = 2.2 to 3.2 (line 15)"));
}

TEST_F(ClothFileTest, EachPieceWithoutUvsHasAPlaneOfItsOwn)
{
    // A level triangle, one seen from below, and an upright one that is narrower.
    const ClothFile file = read(
        "v 3 0 0\nv 5 0 0\nv 3 2 0\nf 1 2 3\n"
        "v 0 0 1\nv 0 2 1\nv 2 0 1\nf 4 5 6\n"
        "v 0 0 2\nv 0.5 0 2\nv 0 0 3\nf 7 8 9\n");
    EXPECT_EQ(validate(file.mesh), "");
    const std::vector<Vec2>& X = file.mesh.material;
    EXPECT_EQ(X[0], Vec2(3, 0)) << "the first piece stays";
    const double left[] = {3.0, 5.2, 7.4};
    for (int f = 0; f < 3; ++f) {
        const auto& [a, b, c] = file.mesh.faces[f];
        EXPECT_NEAR(twice_area(X[a], X[b], X[c]), f < 2 ? 4.0 : 0.5, 1e-14);
        EXPECT_NEAR(std::min({X[a].x(), X[b].x(), X[c].x()}), left[f], 1e-14);
    }
    EXPECT_THAT(
        refusal(layers({0.0, 0.01}) + "v 5 0 0\nv 6 0 0\nv 6 1 0\nv 5 1 0.3\nf 9 10 11\nf 9 11 12\n"),
        HasSubstr("curved (by 0.276 m at (6, 0, 0) m) and without UVs; allowed: UVs in metres, or flat "
                  "pieces"));
}

TEST_F(ClothFileTest, PiecesInOnePlaneKeepTheirPlaces)
{
    const ClothFile file = read("v 0 0 1\nv 1 0 1\nv 0 1 1\nv 5 0 1\nv 6 0 1\nv 5 1 1\nf 1 2 3\nf 4 5 6\n");
    for (int v = 0; v < 6; ++v) EXPECT_EQ(file.mesh.material[v], Vec2(file.mesh.world[v].head<2>()));
    EXPECT_THAT(file.warnings, IsEmpty());
}

TEST_F(ClothFileTest, AcceptsWhatTheFormatAllows)
{
    // Carriage returns, comments, groups, negative indices, continued lines, normals, materials.
    const std::string text =
        "# cloth\r\nmtllib none.mtl\r\no sheet\r\nv 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nvt 0 0\r\nvt 1 0\r\nvt 1 "
        "1\r\n"
        "vn 0 0 1\r\ng one\r\nf -3/-3/1 -2/-2/1 \\\r\n-1/-1/1\r\nv 0 1 0\r\nvt 0 1\r\ng two\r\ns 1\r\n"
        "f 1/1/1 3/3/1 4/4/1\r\n";
    const ClothFile file = read(text);
    EXPECT_EQ(validate(file.mesh), "");
    EXPECT_EQ(file.mesh.vertex_count(), 4);
    EXPECT_EQ(file.mesh.face_count(), 2);
    EXPECT_EQ(make_topology(4, file.mesh.faces).hinges.size(), 1u);
}

TEST_F(ClothFileTest, TriangulatesPolygons)
{
    std::string text;
    const int n = 30;
    for (int k = 0; k < n; ++k)
        text += "v " + std::to_string(std::cos(0.2 * k)) + " " + std::to_string(std::sin(0.2 * k)) + " 0\n";
    text += "v 0 0 0\nf";
    for (int k = 1; k <= n + 1; ++k) text += " " + std::to_string(k);  // concave at the middle
    const ClothFile file = read(text + "\n");
    EXPECT_EQ(validate(file.mesh), "");
    EXPECT_EQ(file.mesh.face_count(), n - 1);
}

TEST_F(ClothFileTest, KeepsSmallClothApart)
{
    // Vertices 1e-6 apart, which an importer's own welding would join.
    const ClothFile file = read("v 0 0 0\nv 1e-6 0 0\nv 1e-6 1e-6 0\nv 0 1e-6 0\nf 1 2 3\nf 1 3 4\n");
    EXPECT_EQ(file.mesh.vertex_count(), 4);
    EXPECT_EQ(validate(file.mesh), "");
}

TEST_F(ClothFileTest, AcceptsSeveralPiecesWhoseChartsAreApart)
{
    const ClothFile file = read(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\n"
        "vt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\n"
        "f 1/1 2/2 3/3\nf 4/4 5/3 6/2\n");  // the charts share a border
    EXPECT_EQ(validate(file.mesh), "");
    EXPECT_EQ(file.mesh.vertex_count(), 6);
}

TEST_F(ClothFileTest, MirroredChartIsTurnedRoundWithAWarning)
{
    const ClothFile file = read(
        "v 0 0 0\nv 1 0 0.5\nv 1 1 0\nv 0 1 0.5\nvt 3 0\nvt 2 0\nvt 2 1\nvt 3 1\n"
        "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n");
    EXPECT_EQ(validate(file.mesh), "");
    ASSERT_EQ(file.warnings.size(), 1u);
    EXPECT_THAT(file.warnings[0], HasSubstr("mirrored"));
    EXPECT_EQ(file.mesh.material[0], Vec2(2, 0));
    EXPECT_EQ(file.mesh.material[1], Vec2(3, 0));
}

TEST_F(ClothFileTest, CountsWhatItDrops)
{
    const ClothFile file = read(std::string(kSquare) + "v 9 9 9\nv 8 8 8\nl 1 2\np 3\n");
    EXPECT_EQ(file.mesh.vertex_count(), 4);
    EXPECT_THAT(file.warnings, ::testing::Contains(HasSubstr("2 of 6 vertices belong to no face")));
    EXPECT_THAT(file.warnings, ::testing::Contains(HasSubstr("2 lines and points")));
}

// Seventeen digits distinguish every double.
std::string digits(double value)
{
    return fmt::format("{:.17g}", value);
}

TEST_F(ClothFileTest, CoordinatesAreTheDoublesOfTheFile)
{
    const std::vector<Vec3> world = {{1.0 / 3.0, 0.7, 1e-7},
                                     {1.0 + 1.0 / 3.0, 0.7, -1e-7},
                                     {1.1, 1.7000000000000002, 5e-324},
                                     {0.1, 1.9, 2e-7}};
    const std::vector<Vec2> material = {
        {0.7, 1e-7}, {1.7, 1.0 / 3.0}, {1.7000000000000002, 4.0 / 3.0}, {0.7, 1.1}};
    std::string text;
    for (const Vec3& x : world)
        text += "v " + digits(x.x()) + " " + digits(x.y()) + " " + digits(x.z()) + "\n";
    for (const Vec2& X : material) text += "vt " + digits(X.x()) + " +" + digits(X.y()) + " 0\n";
    for (const char* faces : {"f 1/1 2/2 3/3 4/4\n", "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n"}) {
        const ClothFile file = read(text + faces);
        EXPECT_EQ(file.mesh.world, world);
        EXPECT_EQ(file.mesh.material, material);
    }
}

TEST_F(ClothFileTest, PinBoxHoldsTheVerticesOfItsNumbers)
{
    const ClothFile file = read(
        "v 0 0 0\nv 0.7 0 0\nv 0.7 0.7 0\nv 0 0.7 0\nvt 0 0\nvt 0.7 0\nvt 0.7 0.7\nvt 0 0.7\n"
        "f 1/1 2/2 3/3 4/4\n");
    EXPECT_THAT(vertices_inside(file.mesh, {{0.7, 0.0}, {0.7, 1.0}}), ::testing::ElementsAre(1, 2));
}

TEST_F(ClothFileTest, PlacesOfOneSingleAndTwoDoublesStayApart)
{
    // All corners coincide in single precision.
    const std::vector<Vec3> corners = {
        {1, 1, 0}, {1 + 1e-12, 1, 0}, {1 + 1e-12, 1 + 1e-12, 0}, {1, 1 + 1e-12, 0}};
    std::string text;
    for (const Vec3& x : corners) text += "v " + digits(x.x()) + " " + digits(x.y()) + " 0\n";
    for (const char* faces : {"f 1 2 3\nf 1 3 4\n", "f 1 2 3 4\n"}) {
        const ClothFile file = read(text + faces);
        EXPECT_EQ(file.mesh.world, corners);
        EXPECT_EQ(validate(file.mesh), "");
    }
}

TEST_F(ClothFileTest, ManyCornersKeepTheirPlaces)
{
    const int n = 60;
    std::string text;
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) text += "v " + digits(i / 7.0) + " " + digits(j / 11.0) + " 0\n";
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const int a = j * (n + 1) + i + 1;
            text += fmt::format("f {} {} {} {}\n", a, a + 1, a + n + 2, a + n + 1);
        }
    const ClothFile file = read(text);
    ASSERT_EQ(file.mesh.vertex_count(), (n + 1) * (n + 1));
    ASSERT_EQ(file.mesh.face_count(), 2 * n * n);
    EXPECT_EQ(validate(file.mesh), "");
    EXPECT_EQ(file.mesh.world.back(), Vec3(n / 7.0, n / 11.0, 0.0));
}

TEST_F(ClothFileTest, FarFromItsOriginClothKeepsItsShape)
{
    const ClothFile file =
        read("v 60000.1 0 0\nv 60001.1 0 0\nv 60001.1 0.1 0\nv 60000.1 0.1 0\nf 1 2 3 4\n");
    EXPECT_THAT(file.warnings, IsEmpty());
    EXPECT_EQ(file.mesh.world[0].x(), 60000.1);
    EXPECT_EQ(file.mesh.world[1].x(), 60001.1);
}

TEST_F(ClothFileTest, WeightDividesAndColourDoesNot)
{
    const ClothFile file = read("v 2 0 0 2\nv 2 0 0 0.5 0.5 0.5\nv 2 2 0\nf 1 2 3\n");
    EXPECT_EQ(file.mesh.world[0], Vec3(1, 0, 0));
    EXPECT_EQ(file.mesh.world[1], Vec3(2, 0, 0));
}

// Files that cannot be cloth: the text of the file, and a part of the error message.
struct Defect {
    const char* name;
    std::string text;
    const char* says;
};

const std::string kCorners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const std::string kUvs = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";

std::vector<Defect> defects()
{
    return {
        {"empty", "", "no faces"},
        {"garbage",
         std::string("\x7f"
                     "ELF\0\1\2\xff\xfe garbage \0 f",
                     21),
         ""},
        {"text", "this is not a mesh\nat all\n", "no faces among 0 vertices, 0 lines and points and 2 other"},
        {"text says what is allowed", "this is not a mesh\nat all\n",
         "allowed: vertices as 'v x y z' and faces"},
        {"no faces", kCorners, "no faces among 4 vertices"},
        {"word for a number", "v 0 0 0\nv 1 0 zero\nv 1 1 0\nf 1 2 3\n",
         "line 2: 'v 1 0 zero': 'zero' is no number; allowed: 'v x y z'"},
        {"number with a tail", "v 0 0 0\nv 1 0 0x\nv 1 1 0\nf 1 2 3\n",
         "line 2: 'v 1 0 0x': '0x' is no number"},
        {"word for a uv", kCorners + "vt 0 zero\nf 1/1 2/1 3/1\n",
         "line 5: 'vt 0 zero': 'zero' is no number"},
        {"uv of one number has v = 0", kCorners + "vt 0\nvt 1\nvt 2\nf 1/1 2/2 3/3\n",
         "no area in material space"},
        {"uv without a number", kCorners + "vt\nf 1/1 2/1 3/1\n", "line 5: 'vt': a UV without a number"},
        {"third slash", kCorners + "f 1/1/1/1 2 3\n",
         "line 5: 'f 1/1/1/1 2 3': '1/1/1/1' has more than two slashes"},
        {"mistyped vertex", "v 0 0 0\nvv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\n",
         "line 2: 'vv 1 0 0': 'vv' is no statement of OBJ"},
        {"after a continued line", "v 0 \\\n0 0\nv 1 0 zero\nv 1 1 0\nf 1 2 3\n", "line 3: 'v 1 0 zero'"},
        {"beyond double", "v 0 0 0\nv 1e999 0 0\nv 1 1 0\nf 1 2 3\n", "'1e999' is beyond double precision"},
        {"weight of nothing", "v 0 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n",
         "line 1: 'v 0 0 0 0': its weight is 0; allowed: a finite weight"},
        {"lines only", kCorners + "l 1 2 3\n", "no faces"},
        {"points only", kCorners + "p 1\n", "no faces"},
        {"truncated face", kCorners + "f 1 2 3\nf 1 3", "line 6: 'f 1 3': a face of 2 corners"},
        {"truncated vertex", "v 0 0 0\nv 1 0 0\nv 1 1\nf 1 2 3\n",
         "line 3: 'v 1 1': 2 numbers, but a vertex has 3"},
        {"truncated count", "v 0 0 0\nv 1 0 0\nf 1 2 3\nv 1", "line 4"},
        {"face before its vertices are there", "f 1 2 3\nv 0 0 0\nv 1 0 0\n",
         "names vertex 3, but there are 2"},
        {"nan", "v 0 0 0\nv nan 0 0\nv 1 1 0\nf 1 2 3\n", "finite"},
        {"inf", "v 0 0 0\nv inf 0 0\nv 1 1 0\nf 1 2 3\n", "finite"},
        {"minus inf", "v 0 0 0\nv 1 -inf 0\nv 1 1 0\nf 1 2 3\n", "finite"},
        {"overflow", "v 0 0 0\nv 1e300 0 0\nv 1 1 0\nf 1 2 3\n", "finite"},
        {"huge", "v 0 0 0\nv 1e20 0 0\nv 1 1e20 0\nf 1 2 3\n", "within 1e+06 m"},
        {"nan uv", kCorners + "vt 0 0\nvt nan 0\nvt 1 1\nf 1/1 2/2 3/3\n", "UV"},
        {"huge uv", kCorners + "vt 0 0\nvt 1e30 0\nvt 1 1\nf 1/1 2/2 3/3\n", "UV"},
        {"index 0", kCorners + "f 0 1 2\n", "line 5: 'f 0 1 2': it names vertex 0"},
        {"index out of range", kCorners + "f 1 2 5\n", "names vertex 5, but there are 4"},
        {"negative index out of range", kCorners + "f -1 -2 -5\n", "line 5"},
        {"index of a billion", kCorners + "f 1 2 1000000000000\n", "names vertex 1000000000000"},
        {"index that is none", kCorners + "f 1 2 x\n",
         "line 5: 'f 1 2 x': 'x' is no index; allowed: 'f' and at least 3"},
        {"uv index out of range", kCorners + kUvs + "f 1/1 2/2 3/9\n",
         "line 9: a face names UV 9, but there are 4"},
        {"mixed uvs", kCorners + kUvs + "f 1/1 2/2 3/3\nf 1 3 4\n", "some faces have UVs"},
        {"overlapping pieces",
         kCorners + "v 5 0 0\nv 6 0 0\nv 6 1 0\n" + kUvs + "f 1/1 2/2 3/3\nf 5/1 6/2 7/3\n",
         "overlap in material space; allowed: UVs at which no two faces overlap"},
        {"overlapping pieces of one plane",
         kCorners + "v 0.5 0.2 0\nv 2 0.2 0\nv 2 0.8 0\nf 1 2 3\nf 5 6 7\n",
         "overlap in material space; allowed: faces beside each other; layers that coincide must start "
         "apart"},
        {"overlapping corners",
         kCorners + "v 5 0 0\nv 6 0 0\nv 6 1 0\n" + kUvs +
             "vt 0.9 0.1\nvt 2 0\nvt 2 1\nf 1/1 2/2 3/3\nf 5/5 6/6 7/7\n",
         "overlap in material space"},
        {"folded chart", kCorners + "vt 0 0\nvt 1 0\nvt 1 1\nvt 1 0.2\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n",
         "the chart is folded at edge (1, 3), between the faces of lines 9 and 10"},
        {"faces of both directions", kCorners + "f 1 2 3\nf 1 4 3\n",
         "1 of 2 triangles is turned over against its neighbours: the face of line 6"},
        {"three faces on an edge", kCorners + "v 2 0.5 0\nf 1 2 3\nf 1 3 4\nf 1 3 5\n",
         "edge (1, 3) has more than two faces (6, 7, 8), at 0.5, 0.5, 0 m; two layers coincide there"},
        {"three faces on a curved edge",
         "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nvt 0 -1\nvt 0 2\n"
         "f 1/1 2/2 3/3\nf 2/2 1/1 4/4\nf 1/1 2/2 5/5\n",
         "edge (1, 2) has more than two faces (11, 12, 13), at 0.5, 0, 0 m; allowed: cloth that does not "
         "branch (vertices as the file numbers them"},
        {"bow-tie", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3\nf 1 4 5\n",
         "vertex 1 joins parts of the cloth in a single point, where faces 6 and 7 meet; allowed"},
        {"duplicate face", kCorners + "f 1 2 3\nf 1 3 4\nf 3 1 2\n",
         "line 7 (at 1, 1, 0 m) is there twice, first in line 5"},
        {"duplicate face turned over", kCorners + "f 1 2 3\nf 1 3 4\nf 1 3 2\n", "is there twice"},
        {"no area in the world", kCorners + "v 2 0 0\n" + kUvs + "vt 2 5\nf 1/1 2/2 3/3\nf 1/1 2/2 5/5\n",
         "has no area"},
        {"vertex twice in a face", kCorners + "f 1 2 3\nf 1 3 3\n", "has no area"},
        {"no area in the material", kCorners + "vt 0 0\nvt 1 0\nvt 2 0\nf 1/1 2/2 3/3\n",
         "no area in material space"},
        {"one uv for all", kCorners + "vt 0 0\nf 1/1 2/1 3/1\n", "no area in material space"},
        {"curved without uvs", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.01\nf 1 2 3\nf 1 3 4\n", "without UVs"},
    };
}

TEST_F(ClothFileTest, RefusesWhatCannotBeCloth)
{
    for (const Defect& defect : defects()) {
        SCOPED_TRACE(defect.name);
        EXPECT_THAT(refusal(defect.text), HasSubstr(defect.says));
    }
}

/// A tube of `n` sides about z, or a cone where `tip` < 1, from z = 0 to 1. Its last side ends at the UVs 0
/// again, or at the circumference where it `has_seam`.
std::string tube(int n, bool has_seam, double tip = 1.0)
{
    const double side = 2.0 * std::sin(std::acos(-1.0) / n);
    std::string text;
    for (const double z : {0.0, 1.0})
        for (int k = 0; k < n; ++k) {
            const double angle = 2.0 * std::acos(-1.0) * k / n, radius = z > 0.0 ? tip : 1.0;
            text += fmt::format("v {} {} {}\n", radius * std::cos(angle), radius * std::sin(angle), z);
        }
    for (const double v : {0.0, 1.0})
        for (int k = 0; k <= n; ++k) text += fmt::format("vt {} {}\n", side * k, v);
    for (int k = 0; k < n; ++k) {
        const int next = (k + 1) % n, uv = has_seam ? k + 1 : next;
        text += fmt::format("f {}/{} {}/{} {}/{} {}/{}\n", k + 1, k + 1, next + 1, uv + 1, n + next + 1,
                            n + uv + 2, n + k + 1, n + k + 2);
    }
    return text;
}

/// Vertices, points beyond those, and faces.
std::array<int, 3> counts_of(const ClothMesh& mesh)
{
    return {mesh.vertex_count(), static_cast<int>(mesh.seam_vertices.size()), mesh.face_count()};
}

TEST_F(ClothFileTest, SewsWhereOnePlaceHasSeveralUvs)
{
    const ClothMesh three = read(tube(3, true)).mesh, many = read(tube(24, true)).mesh,
                    cone = read(tube(12, true, 0.5)).mesh;
    EXPECT_EQ(counts_of(three), (std::array{6, 2, 6}));
    EXPECT_EQ(counts_of(many), (std::array{48, 2, 48}));
    EXPECT_EQ(counts_of(cone), (std::array{24, 2, 24}));
    for (const ClothMesh* mesh : {&three, &many, &cone}) EXPECT_EQ(validate(*mesh), "");
    // Every side of the tube has the same area, that at the seam, too.
    for (int f = 0; f < many.face_count(); ++f)
        EXPECT_NEAR(twice_area(many.corners(f)), 2.0 * std::sin(std::acos(-1.0) / 24), 1e-12);
    EXPECT_EQ(make_topology(many.vertex_count(), many.faces).hinges.size(), 48u) << "none at the rims";
}

const std::string kPanels =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
    "vt 0 1\nvt 5 0\nvt 6 0\nvt 6 1\nvt 5 1\n";

TEST_F(ClothFileTest, SewsPanelsOfWhichOneIsMirrored)
{
    const ClothFile plain = read(kPanels + "f 1/1 2/2 3/3 4/4\nf 2/5 5/6 6/7 3/8\n");
    EXPECT_EQ(counts_of(plain.mesh), (std::array{6, 2, 4}));
    EXPECT_EQ(validate(plain.mesh), "");
    EXPECT_TRUE(plain.warnings.empty());
    const ClothFile mirrored = read(kPanels + "f 1/1 2/2 3/3 4/4\nf 2/6 5/5 6/8 3/7\n");
    EXPECT_EQ(mirrored.mesh.material, plain.mesh.material);
    EXPECT_EQ(validate(mirrored.mesh), "");
    ASSERT_EQ(mirrored.warnings.size(), 1u);
    EXPECT_THAT(mirrored.warnings[0], HasSubstr("the UVs of 1 of its 2 charts are mirrored"));
}

TEST_F(ClothFileTest, SewsAPillow)
{
    // Two squares, sewn along all their sides, of five places each: a corner has two UVs, too.
    const std::string places = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 0.1\nv 0.5 0.5 -0.1\n";
    std::string text = places;
    for (const double u : {0.0, 3.0})
        text += fmt::format("vt {0} 0\nvt {1} 0\nvt {1} 1\nvt {0} 1\nvt {2} 0.5\n", u, u + 1.0, u + 0.5);
    for (int k = 0; k < 4; ++k) text += fmt::format("f {0}/{0} {1}/{1} 5/5\n", k + 1, (k + 1) % 4 + 1);
    for (int k = 0; k < 4; ++k)
        text += fmt::format("f {1}/{3} {0}/{2} 6/10\n", k + 1, (k + 1) % 4 + 1, k + 6, (k + 1) % 4 + 6);
    const ClothFile pillow = read(text);
    EXPECT_EQ(counts_of(pillow.mesh), (std::array{6, 4, 8}));
    EXPECT_EQ(validate(pillow.mesh), "");
    const MeshTopology topology = make_topology(6, pillow.mesh.faces);
    EXPECT_EQ(topology.hinges.size(), 12u);
    EXPECT_EQ(std::count(topology.is_border.begin(), topology.is_border.end(), 1), 0);
}

TEST_F(ClothFileTest, SewsAPillowcaseOfQuadsWhateverTheirDiagonals)
{
    // Two panels of n x n quads, sewn along three sides; of a quad in a corner three places are on seams.
    for (const int first : {0, 1, 2, 3}) {
        const int n = 4;
        std::string text;
        for (const double z : {0.02, -0.02})
            for (int j = 0; j <= n; ++j)
                for (int i = 0; i <= n; ++i) {
                    const bool is_sewn = i == 0 || i == n || j == 0;
                    text += fmt::format("v {} {} {}\n", i, j, is_sewn ? 0.0 : z);
                }
        for (const double u : {0.0, 9.0})
            for (int j = 0; j <= n; ++j)
                for (int i = 0; i <= n; ++i) text += fmt::format("vt {} {}\n", u > 0.0 ? u + n - i : i, j);
        for (const int panel : {0, 1})
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) {
                    const auto at = [&](int di, int dj) {
                        return panel * (n + 1) * (n + 1) + (j + dj) * (n + 1) + i + di + 1;
                    };
                    std::array<int, 4> quad = {at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
                    if (panel == 1) std::reverse(quad.begin(), quad.end());
                    text += "f";
                    for (int k = 0; k < 4; ++k) text += fmt::format(" {0}/{0}", quad[(k + first) % 4]);
                    text += "\n";
                }
        const ClothMesh mesh = read(text).mesh;
        EXPECT_EQ(validate(mesh), "");
        EXPECT_EQ(counts_of(mesh), (std::array{2 * 25 - 13, 13, 64}));
    }
}

TEST_F(ClothFileTest, SaysWhatCannotBeSewn)
{
    const Defect kSeams[] = {
        {"tube with one UV at each place", tube(24, false),
         "a tube cannot be laid out with one UV at each place"},
        {"panels sewn at a corner", kPanels + "v 2 2 0\nv 1 2 0\nf 1/1 2/2 3/3 4/4\nf 3/5 6/6 7/7 8/8\n",
         "vertex 3 joins parts of the cloth in a single point, where faces 17 and 18 meet"},
        {"three panels at a seam",
         kPanels + "v 1 0 1\nv 1 1 1\nvt 8 0\nvt 9 0\nvt 9 1\nvt 8 1\n"
                   "f 1/1 2/2 3/3 4/4\nf 2/5 5/6 6/7 3/8\nf 2/9 7/10 8/11 3/12\n",
         "has more than two faces"},
        {"panels that overlap", kPanels + "f 1/1 2/2 3/3 4/4\nf 2/1 5/2 6/3 3/4\n",
         "overlap in material space"},
    };
    for (const Defect& seam : kSeams) {
        SCOPED_TRACE(seam.name);
        EXPECT_THAT(refusal(seam.text), HasSubstr(seam.says));
    }
}

TEST_F(ClothFileTest, RefusesWhatIsNoObjFile)
{
    EXPECT_THAT(refusal_of((folder_ / "missing.obj").string()), HasSubstr("no such file"));
    std::filesystem::create_directory(folder_ / "folder.obj");
    EXPECT_THAT(refusal_of((folder_ / "folder.obj").string()), HasSubstr("not a regular file"));
    EXPECT_THAT(refusal_of("/dev/null"), HasSubstr("not a regular file"));
    EXPECT_THAT(refusal_of(write(kSquare, "cloth.ply")), HasSubstr(".obj"));
    EXPECT_THAT(refusal_of(write(kSquare), 0.0), HasSubstr("unit"));
    EXPECT_THAT(refusal_of(write(kSquare), std::nan("")), HasSubstr("unit"));
    EXPECT_THAT(refusal_of(write(kSquare), 1.0, 'w'), HasSubstr("up"));
}

TEST_F(ClothFileTest, EveryTruncationIsReadOrRefused)
{
    const std::string text = kSquare;
    for (std::size_t length = 0; length < text.size(); ++length) {
        try {
            const ClothFile file = read(text.substr(0, length));
            EXPECT_EQ(validate(file.mesh), "") << length;
        } catch (const InputError&) {
        }
    }
}

}  // namespace
}  // namespace arris
