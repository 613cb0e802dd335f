// SPDX-License-Identifier: GPL-3.0-or-later
// Variants of the text formats that mean the same mesh.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/cloth_input/cloth_file.h"
#include "tests/geometry/imported_file.h"
#include "tests/geometry/mesh_files.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string replace_all(std::string text, const std::string& what, const std::string& by)
{
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
    return text;
}

std::string upper(std::string text)
{
    for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return text;
}

struct Variant {
    const char* name;
    std::string text;
};

// A flat sheet, which may be a cloth or an obstacle, with a vertex that no face names.
const std::string kSheet =
    "v 0.5 0 1\nv 1.5 0 1\nv 1.5 1 1\nv 0.5 1 1\nv 0.5 2 1\nv 9 9 1\nf 1 2 3 4\nf 4 3 5\n";

std::vector<Variant> sheets()
{
    return {
        {"byte-order mark", "\xef\xbb\xbf" + kSheet},
        {"byte-order mark, carriage returns", "\xef\xbb\xbf" + replace_all(kSheet, "\n", "\r\n")},
        {"upper case", upper(kSheet)},
        {"carriage returns and line feeds", replace_all(kSheet, "\n", "\r\n")},
        {"carriage returns", replace_all(kSheet, "\n", "\r")},
        {"no end of the last line", kSheet.substr(0, kSheet.size() - 1)},
        {"tabs", replace_all(kSheet, " ", "\t")},
        {"leading blanks", replace_all("\n" + kSheet, "\n", "\n \t ").substr(1)},
        {"comments", replace_all(kSheet, "\n", " # v 7 7 7\n")},
        {"comment that ends with a backslash", "# C:\\meshes\\\n" + kSheet},
        {"continued lines", replace_all(kSheet, " 1\n", " \\\n1\n")},
        {"continued faces", replace_all(kSheet, "f 1 2 3 4", "f 1 2 \\\r\n 3 \\\n4")},
        {"negative indices",
         replace_all(replace_all(kSheet, "f 1 2 3 4", "f -6 -5 -4 -3"), "f 4 3 5", "f -3 -4 -2")},
        {"normals", replace_all(replace_all(kSheet, "f 1 2 3 4", "f 1//1 2//1 3//1 4//1"), "f 4 3 5",
                                "vn 0 0 1\nf 4//1 3//1 5//1")},
        {"points at the beginning", replace_all(kSheet, "0.5", ".5")},
        {"points at the end", replace_all(kSheet, " 1\n", " 1.\n")},
        {"exponents", replace_all(replace_all(kSheet, "0.5", "5.0E-01"), "1.5", "+15e-1")},
        {"Fortran's exponents", replace_all(replace_all(kSheet, "0.5", "5.0D-01"), "1.5", "0.15d+1")},
        {"groups and materials", "o A\n" + replace_all(kSheet, "f 4", "g b\nusemtl red\ns off\nf 4")},
        {"old name of a face", replace_all(kSheet, "f ", "fo ")},
        {"byte-order marks in front of every line",
         "\xef\xbb\xbf\xef\xbb\xbf" + replace_all(kSheet, "\nv", "\n\xef\xbb\xbfv")},
        {"colours", replace_all(kSheet, " 1\n", " 1 0.5 0.5 0.5\n")},
        {"colours with alpha", replace_all(kSheet, " 1\n", " 1 1 0 0 1\n")},
        {"one colour with alpha", replace_all(kSheet, "v 0.5 0 1\n", "v 0.5 0 1 1 0 0 1\n")},
        {"five numbers", replace_all(kSheet, " 1\n", " 1 0.5 0.5\n")},
        {"weights", replace_all(kSheet, "v 1.5 1 1\n", "v 3 2 2 2\n")},
        {"comment between continued lines", replace_all(kSheet, "f 1 2 3 4", "f 1 2 3 \\\n# c\n 4")},
        {"comment behind a backslash", replace_all(kSheet, "f 1 2 3 4", "f 1 2 \\ # c\n 3 4")},
        {"long numbers", replace_all(kSheet, "v 1.5 1 1\n", "v 1.5 100000000000000000000000000000e-29 1\n")},
        {"long fractions", replace_all(kSheet, "0.5", "0.00000000000000000000000000000000000000005e40")},
        {"UVs of one number", "vt 0\n" + kSheet},
        {"UVs of four numbers", "vt 0 0 0 0\n" + kSheet},
        {"plus signs on indices", replace_all(kSheet, "f 1 2", "f +1 +2")},
    };
}

TEST(ObstacleText, ObjVariantsAreTheSameObstacle)
{
    const ObstacleFile plain = imported("plain.obj", kSheet);
    ASSERT_EQ(plain.mesh.faces.size(), 3u);
    for (const Variant& v : sheets()) {
        const ObstacleFile file = imported("variant.obj", v.text);
        EXPECT_EQ(file.mesh.points, plain.mesh.points) << v.name;
        EXPECT_EQ(file.mesh.faces, plain.mesh.faces) << v.name;
        EXPECT_THAT(file.warnings, IsEmpty()) << v.name;
    }
}

TEST(ObstacleText, ObjVariantsAreTheSameCloth)
{
    const auto read = [](const std::string& text) {
        const std::string path = ::testing::TempDir() + "arris_obstacle_text_cloth.obj";
        std::ofstream(path, std::ios::binary) << text;
        return read_cloth_file(path, 1.0, 'z');
    };
    const ClothFile plain = read(kSheet);
    ASSERT_EQ(plain.mesh.faces.size(), 3u);
    for (const Variant& v : sheets()) {
        const ClothFile file = read(v.text);
        EXPECT_EQ(file.mesh.world, plain.mesh.world) << v.name;
        EXPECT_EQ(file.mesh.material, plain.mesh.material) << v.name;
        EXPECT_EQ(file.mesh.faces, plain.mesh.faces) << v.name;
    }
    const std::string wide("\xff\xfev\0 \0", 6);
    EXPECT_THAT(error_of([&] { read(wide); }), HasSubstr("cloth.obj: its text is in UTF-16"));
}

TEST(ObstacleText, StlVariantsAreTheSameObstacle)
{
    const ObstacleMesh box = samples::box(Vec3::Zero(), Vec3(1, 2, 3));
    const std::string text = mesh_files::ascii_stl(box);
    const ObstacleFile plain = imported("plain.stl", text);
    ASSERT_EQ(plain.mesh.faces.size(), 12u);
    std::string named_solid = mesh_files::binary_stl(box);
    named_solid.replace(0, 10, "solid box ");
    const Variant variants[] = {
        {"byte-order mark", "\xef\xbb\xbf" + text},
        {"upper case", upper(text)},
        {"mixed case", replace_all(text, "vertex", "Vertex")},
        {"carriage returns and line feeds", replace_all(text, "\n", "\r\n")},
        {"carriage returns", replace_all(text, "\n", "\r")},
        {"no end of the last line", text.substr(0, text.size() - 1)},
        {"tabs", replace_all(replace_all(text, " ", "\t"), "solid\tbox", "solid box")},
        {"leading blanks and lines", "\n\n" + replace_all(text, "\n", "\n\t ")},
        {"no name", replace_all(text, "solid box", "solid")},
        {"name with keywords", replace_all(text, "solid box", "solid facet vertex loop")},
        {"one line", replace_all(text, "\n", " ")},
        {"normals that are no numbers", replace_all(text, "normal 0 0 0", "normal nan -nan(ind) 1.#IND")},
        {"Fortran's exponents", replace_all(text, "vertex 1 ", "vertex 1.0D+00 ")},
        {"points at the beginning", replace_all(text, " 0 ", " .0 ")},
        {"two solids", replace_all(text, "endfacet\nfacet", "endfacet\nendsolid box\nsolid c\nfacet")},
        {"binary that begins with solid", named_solid},
    };
    for (const Variant& v : variants) {
        const ObstacleFile file = imported("variant.stl", v.text);
        EXPECT_EQ(file.mesh.points, plain.mesh.points) << v.name;
        EXPECT_EQ(file.mesh.faces, plain.mesh.faces) << v.name;
        EXPECT_THAT(file.warnings, IsEmpty()) << v.name;
    }
}

TEST(ObstacleText, OtherTextFormatsMayHaveAByteOrderMark)
{
    const ObstacleMesh box = samples::box(Vec3::Zero(), Vec3(1, 2, 3));
    const std::pair<const char*, std::string> files[] = {{"a.ply", mesh_files::ascii_ply(box)},
                                                         {"a.dae", mesh_files::dae(box, "")},
                                                         {"a.fbx", mesh_files::fbx(box, 2, 100)}};
    for (const auto& [name, text] : files)
        EXPECT_EQ(imported(name, "\xef\xbb\xbf" + text).mesh.faces.size(), 12u) << name;
}

TEST(ObstacleText, WhatIsNoVariantIsOneClearLine)
{
    const std::string stl = mesh_files::ascii_stl(samples::box(Vec3::Zero(), Vec3(1, 2, 3)));
    const struct {
        const char* name;
        std::string text;
        const char* says;
    } cases[] = {
        {"wide.obj", std::string("\xff\xfev\0 \0", 6), "UTF-16 or UTF-32; allowed: ASCII or UTF-8"},
        {"wide.stl", std::string("\xfe\xff\0s\0o\0l\0i\0d", 12), "UTF-16"},
        {"wide.ply", std::string("\xff\xfep\0l\0y\0", 8), "UTF-16"},
        {"comma.obj", "v 0,5 0 0\nf 1 1 1\n", "line 1: 'v 0,5 0 0': '0,5' is no number; allowed: 'v x y z'"},
        {"line.obj", "v 0 0 0\r\rv 1 0 x\r", "line 3: 'v 1 0 x'"},
        {"word.stl", replace_all(stl, "vertex 1 ", "vertex one "),
         "face 1, vertex 2: 'one' is no number; a vertex has 3"},
        {"two.stl", replace_all(stl, "vertex 1 2 3", "vertex 1 2"), "'' is no number; a vertex has 3"},
    };
    for (const auto& c : cases) EXPECT_THAT(import_error(c.name, c.text), HasSubstr(c.says)) << c.name;
}

TEST(ObstacleText, FreeFormSurfacesAreMissedAloud)
{
    const ObstacleFile file =
        imported("free.obj", kSheet + "cstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 3 4\nparm u 0 1\nend\n");
    EXPECT_EQ(file.mesh.faces.size(), 3u);
    EXPECT_THAT(file.warnings, ::testing::ElementsAre(HasSubstr("its 1 free-form curve or surface")));
}

}  // namespace
}  // namespace arris
