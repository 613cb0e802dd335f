// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/text/html_escape.h"

#include <gtest/gtest.h>

namespace arris {
namespace {

TEST(HtmlEscape, LeavesNoMarkup)
{
    EXPECT_EQ(escape_html("<a href=\"x\" id='y'>&amp;</a>"),
              "&lt;a href=&quot;x&quot; id=&#39;y&#39;&gt;&amp;amp;&lt;/a&gt;");
    EXPECT_EQ(escape_html("Tuch über 布\nnext"), "Tuch über 布\nnext");
    EXPECT_EQ(escape_html(""), "");
}

TEST(HtmlEscape, ShowsControlCharactersAsReplacements)
{
    EXPECT_EQ(escape_html(std::string_view("a\0b\x1b[31m\x7f", 9)), "a\uFFFDb\uFFFD[31m\uFFFD");
}

}  // namespace
}  // namespace arris
