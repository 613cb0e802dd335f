// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/mesh_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

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

TEST(MeshText, LinesEndInEveryWayAndHaveNoMarks)
{
    const std::string mark = "\xef\xbb\xbf";
    const std::pair<std::string, std::vector<std::string>> cases[] = {
        {"", {}},
        {"a\nb", {"a", "b"}},
        {"a\r\nb\r\n", {"a", "b"}},
        {"a\rb\r", {"a", "b"}},
        {"a\n\rb", {"a", "", "b"}},
        {" \ta b\v\f\x1a\n", {"a b"}},
        {mark + "a\n" + mark + " b\n" + mark + mark + "c\n " + mark + "d" + mark,
         {"a", "b", "c", "d" + mark}},
    };
    for (const auto& [text, lines] : cases) {
        std::string_view rest = text;
        std::vector<std::string> found;
        while (!rest.empty()) found.emplace_back(take_line(rest));
        EXPECT_EQ(found, lines) << text;
    }
}

TEST(MeshText, NounsAgreeWithTheirNumber)
{
    EXPECT_EQ(counted(0, "face", "faces"), "0 faces");
    EXPECT_EQ(counted(1, "face", "faces"), "1 face");
    EXPECT_EQ(counted(2, "face", "faces"), "2 faces");
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
            const std::string wide = utf16("v 0 0 0\nf 1 1 1\n", is_big_endian, has_mark);
            EXPECT_THAT(error_of([&] { skip_byte_order_mark(wide); }), HasSubstr("UTF-16"))
                << is_big_endian << has_mark;
        }
    EXPECT_EQ(skip_byte_order_mark("\xef\xbb\xbf\xef\xbb\xbf"
                                   "v"),
              "v");
}

}  // namespace
}  // namespace arris
