// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/step_docs.h"

#include <gtest/gtest.h>

#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

TEST(StepDocs, InTheRepositoryAreThoseOfTheProgram)
{
    const std::string page = read_bytes(std::string(ARRIS_SOURCE_DIR) + "/docs/method.md");
    EXPECT_NE(page.find("<!-- step -->\n" + step_markdown() + "<!-- end -->"), std::string::npos)
        << "run scripts/docs";
}

}  // namespace
}  // namespace arris
