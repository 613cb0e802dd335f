// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/app/error_of.h"

namespace arris {
namespace {

using ::testing::HasSubstr;

TEST(MeshText, NumbersAreReadInEverySpelling)
{
    const std::pair<const char*, double> cases[] = {
        {"1", 1.0},    {"+1", 1.0},     {"-1", -1.0},       {"1.", 1.0},      {".5", 0.5},
        {"-.5", -0.5}, {"+.5", 0.5},    {"1e2", 100.0},     {"1E+02", 100.0}, {"1.5D+01", 15.0},
        {"2d-1", 0.2}, {"1e-400", 0.0}, {"5e-324", 5e-324}, {"0.1", 0.1},     {"00012.50", 12.5}};
    for (const auto& [word, value] : cases) {
        EXPECT_EQ(parse_number(word).error, NumberError::None) << word;
        EXPECT_EQ(parse_number(word).value, value) << word;
    }
    for (const char* word :
         {"", "+", "-", ".", "x", "1x", "0x10", "1,5", "+-1", "--1", "1e", "1 ", "d", "1d", "nand"})
        EXPECT_EQ(parse_number(word).error, NumberError::NoNumber) << word;
    for (const char* word : {"1e999", "-1D+400"})
        EXPECT_EQ(parse_number(word).error, NumberError::TooLarge) << word;
    EXPECT_TRUE(std::isnan(parse_number("nan").value));
    EXPECT_TRUE(std::isinf(parse_number("-inf").value));
}

TEST(MeshText, ObjHasOneSpelling)
{
    const std::pair<std::string, std::string> cases[] = {
        {"", ""},
        {"v 1 2 3\n", "v 1 2 3\n"},
        {"v 1 2 3", "v 1 2 3\n"},
        {"\xef\xbb\xbfv 1 2 3\n", "v 1 2 3\n"},
        {"V 1 2 3\nVT 0 0\nVN 0 0 1\nF 1/1/1 2 3\nL 1 2\nP 1\n",
         "v 1 2 3\nvt 0 0\nvn 0 0 1\nf 1/1/1 2 3\nl 1 2\np 1\n"},
        {"v 1 2 3\r\nf 1 2 3\r\n", "v 1 2 3\nf 1 2 3\n"},
        {"v 1 2 3\rf 1 2 3\r", "v 1 2 3\nf 1 2 3\n"},
        {" \tv\t1  2\v3 \f\n", "v 1 2 3\n"},
        {"v 1 2 3 # a corner\n#v 9 9 9\nf 1 2 3#end", "v 1 2 3\n\nf 1 2 3\n"},
        {"v 1 \\\n2 \\ \n3\nf 1 2 3\n", "v 1 2 3\n\n\nf 1 2 3\n"},
        {"v 1 \\\r\n2 3\r\n", "v 1 2 3\n\n"},
        {"v 1 2 3 \\", "v 1 2 3\n"},
        // A path in a comment may end with a backslash.
        {"# C:\\models\\\nv 1 2 3\n", "\nv 1 2 3\n"},
        {"v .5 -.5 +.25\nvt .5 1.\n", "v 0.5 -0.5 +0.25\nvt 0.5 1.\n"},
        {"v 1.5D+00 2d-1 3E0\n", "v 1.5e+00 2e-1 3E0\n"},
        {"v x 1,5 nan\n", "v x 1,5 nan\n"},
        {"fo 1 2 3\n", "f 1 2 3\n"},
        {"O Part.1\nUSEMTL Red.2\nmtllib a b.mtl\n", "o Part.1\nusemtl Red.2\nmtllib a b.mtl\n"},
        // The import library would take these for a point, a line and a vertex.
        {"parm u 0 1\nlod 2\nvp 0 1\n", "# parm u 0 1\n# lod 2\n# vp 0 1\n"},
        {"cstype bezier\n", "cstype bezier\n"},
    };
    for (const auto& [text, expected] : cases) EXPECT_EQ(canonical_obj(text), expected) << text;
}

std::string utf16(const std::string& text, bool is_big_endian, bool has_mark)
{
    std::string wide = !has_mark ? "" : is_big_endian ? "\xfe\xff" : "\xff\xfe";
    for (const char c : text) wide += is_big_endian ? std::string({'\0', c}) : std::string({c, '\0'});
    return wide;
}

TEST(MeshText, WideTextIsRefused)
{
    for (const bool is_big_endian : {false, true})
        for (const bool has_mark : {false, true}) {
            const std::string obj = utf16("v 0 0 0\nf 1 1 1\n", is_big_endian, has_mark);
            EXPECT_THAT(error_of([&] { canonical_obj(obj); }), HasSubstr("UTF-16"))
                << is_big_endian << has_mark;
            const std::string stl = utf16("solid x\nendsolid x\n", is_big_endian, has_mark);
            EXPECT_THAT(error_of([&] { is_text_stl(stl); }), HasSubstr("UTF-16"))
                << is_big_endian << has_mark;
        }
    EXPECT_THAT(error_of([&] { canonical_obj(std::string("v 0 0 \0 0\n", 10)); }), HasSubstr("zero byte"));
}

TEST(MeshText, StlHasOneSpelling)
{
    const std::string plain =
        "solid\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
        "endsolid\n";
    const std::string cases[] = {
        plain,
        "solid a part\nfacet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1 0\n "
        "endloop\n"
        "endfacet\nendsolid a part",
        "\xef\xbb\xbfSOLID PART\r\nFACET NORMAL 0 0 1\r\nOUTER LOOP\r\nVERTEX 0 0 0\r\nVERTEX 1 0 "
        "0\r\nVERTEX 0 1 0\r\n"
        "ENDLOOP\r\nENDFACET\r\nENDSOLID PART\r\n",
        "solid\rfacet normal nan -nan(ind) 1.#QNAN\router loop\rvertex 0 0 0\rvertex 1 0 0\rvertex 0 1 "
        "0\rendloop\r"
        "endfacet\rendsolid",
        "solid x facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet "
        "endsolid x",
        "\n\n\tsolid facet\n\tfacet\tnormal 0 0 1\nouter  loop\nvertex 0 0\t0\nvertex 1 0 0 # end\nvertex 0 "
        "1 0\n"
        "endloop\nendfacet\nendsolid facet\n\n",
    };
    for (const std::string& text : cases) {
        EXPECT_TRUE(is_text_stl(text)) << text;
        EXPECT_EQ(canonical_stl(text), plain) << text;
    }
    EXPECT_FALSE(is_text_stl("facet normal 0 0 1"));
    EXPECT_FALSE(is_text_stl(std::string("solid \0 binary", 14)));
}

}  // namespace
}  // namespace arris
