// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/text/printable.h"

#include <gtest/gtest.h>

namespace arris {
namespace {

TEST(Printable, LeavesTextAlone)
{
    EXPECT_EQ(printable("plain ü € 😀 \\ \""), "plain ü € 😀 \\ \"");
    EXPECT_EQ(printable(""), "");
}

TEST(Printable, EscapesWhatMovesACursor)
{
    EXPECT_EQ(printable("a\nb\r\tc\x1b[2J\x7f"), "a\\nb\\r\\tc\\u001b[2J\\u007f");
    EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\u0000b");
    EXPECT_EQ(printable("\xc2\x9b"
                        "31m"),
              "\\u009b31m");  // a terminal's other escape
    EXPECT_EQ(printable("\xe2\x80\xae"
                        "x"),
              "\\u202ex");  // writes to the left
    EXPECT_EQ(printable("\xe2\x80\xa8"
                        "x"),
              "\\u2028x");  // a line separator
}

TEST(Printable, EscapesWhatIsNotUtf8)
{
    EXPECT_EQ(printable("a\xff"
                        "b"),
              "a\\xffb");
    EXPECT_EQ(printable("\xc3"), "\\xc3");
    EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");                    // overlong
    EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");           // a surrogate
    EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond Unicode
}

TEST(Printable, ShortensByCharacters)
{
    EXPECT_EQ(printable("üüü", 3), "üüü");
    EXPECT_EQ(printable("üüüü", 3), "üüü…");
}

TEST(InvalidUtf8, IsFoundAtItsFirstByte)
{
    EXPECT_EQ(find_invalid_utf8("ü€😀"), std::string_view::npos);
    EXPECT_EQ(find_invalid_utf8("ab\xff"), 2u);
    EXPECT_EQ(find_invalid_utf8("ab\xe2\x82"), 2u);
    EXPECT_EQ(find_invalid_utf8("\xe0\x80\xaf"), 0u);
}

}  // namespace
}  // namespace arris
