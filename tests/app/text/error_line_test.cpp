// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/text/error_line.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <new>
#include <stdexcept>

namespace arris {
namespace {

TEST(ErrorLine, NamesTheFileAndNotTheCallThatMetIt)
{
    try {
        std::filesystem::resize_file("/none/steps.csv", 0);
        FAIL() << "that file is not there";
    } catch (const std::exception& error) {
        EXPECT_EQ(error_line(error), "/none/steps.csv: cannot be used: No such file or directory");
    }
    EXPECT_EQ(error_line(std::bad_alloc()), "not enough memory; a coarser cloth needs less");
    EXPECT_EQ(error_line(std::runtime_error("what it says")), "what it says");
}

}  // namespace
}  // namespace arris
