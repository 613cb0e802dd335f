// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/text/shell_word.h"

#include <gtest/gtest.h>

namespace arris {
namespace {

TEST(ShellWord, IsQuotedWhereAShellWouldReadIt)
{
    EXPECT_EQ(shell_word("out/slipping_2.5"), "out/slipping_2.5");
    EXPECT_EQ(shell_word("Stühle"), "Stühle");
    EXPECT_EQ(shell_word(""), "''");
    EXPECT_EQ(shell_word("my run"), "'my run'");
    EXPECT_EQ(shell_word("a;b"), "'a;b'");
    EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
    EXPECT_EQ(resume_command("build/arris", "out/my run"), "build/arris resume 'out/my run'");
}

}  // namespace
}  // namespace arris
