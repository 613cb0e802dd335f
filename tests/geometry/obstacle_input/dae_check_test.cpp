// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/formats/dae_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/geometry/imported_file.h"
#include "tests/geometry/mesh_files.h"
#include "tests/geometry/sample_obstacles.h"

namespace arris {
namespace {

using ::testing::HasSubstr;

std::string replaced(std::string text, const std::string& what, const std::string& by)
{
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
}

std::string placed(const std::string& placement)
{
    return replaced(mesh_files::dae(samples::box(Vec3::Zero(), Vec3(1, 2, 3)), ""), "<instance_geometry",
                    placement + "<instance_geometry");
}

TEST(DaeCheck, DefectsAreOneClearLine)
{
    const std::string plain = placed("");
    const std::string first_number = plain.substr(plain.find(">", plain.find("<float_array")) + 1, 1);
    const auto numbers = [&](const std::string& by) {
        std::string text = plain;
        return text.replace(text.find(">", text.find("<float_array")) + 1, 1, by);
    };
    const std::pair<std::string, const char*> cases[] = {
        {numbers("3,5"), "<float_array>: '3,5' is no number in double precision"},
        {numbers("1e999"), "<float_array>: '1e999' is no number"},
        {numbers("1 2"), "<float_array> has 25 numbers; allowed: 24"},
        {numbers(""), "<float_array> has 23 numbers; allowed: 24"},
        {replaced(plain, "stride=\"3\"", "stride=\"4\""),
         "an <accessor> of 8 elements, 4 numbers each, reaches"},
        {replaced(plain, "semantic=\"POSITION\"", "semantic=\"NORMAL\""),
         "no input with the semantic POSITION"},
        {placed("<matrix>1 0 0 0 0 1 0 0 0 0 1 0</matrix>"), "<matrix> has 12 numbers; allowed: 16"},
        {placed("<translate>1,5 0 0</translate>"), "<translate>: '1,5' is no number"},
        {placed("<rotate>0 0 1</rotate>"), "<rotate> has 3 numbers; allowed: 4"},
        {placed("<scale>2</scale>"), "<scale> has 1 number; allowed: 3"},
        {replaced(plain, "<p>", "<p>0.5 "), "<p>: '0.5' is no whole number"},
        {replaced(plain, "<p>", "<p>-1 "), "<p>: '-1' is no whole number"},
        {replaced(plain, "<p>", "<ph><p>"), "a polygon with holes (<ph>), which is not read; allowed"},
        {replaced(plain, "</float_array>", ""), "no well-formed XML"},
    };
    for (const auto& [text, says] : cases) EXPECT_THAT(import_error("a.dae", text), HasSubstr(says)) << says;
    const ObstacleMesh mesh = samples::box(Vec3::Zero(), Vec3(1, 2, 3));
    for (const char* unit : {"-1", "0", "nan", "inf", "1 m", ""})
        EXPECT_THAT(
            import_error("a.dae", mesh_files::dae(mesh, std::string("<unit meter=\"") + unit + "\"/>")),
            HasSubstr(std::string("its unit is '") + unit + "' m; allowed: a positive number"));
}

TEST(DaeCheck, PlacementsInEverySpellingPass)
{
    for (const char* placement :
         {"<translate sid=\"t\">\n1\t2 3 </translate>", "<rotate>0 0 1 90</rotate><scale>1 1 1</scale>",
          "<matrix>1 0 0 0  0 1 0 0\n0 0 1 0  0 0 0 1</matrix>",
          "<extra><technique><scale>2</scale><matrix>x</matrix></technique></extra>"})
        EXPECT_EQ(imported("a.dae", placed(placement)).mesh.faces.size(), 12u) << placement;
}

}  // namespace
}  // namespace arris
