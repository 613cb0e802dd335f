// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/cloth_input/pattern/sewing_pattern.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/geometry/cloth_input/pattern/pattern_samples.h"

namespace arris {
namespace {

TEST(SewingPattern, PanelsAreFoundByName)
{
    const SewingPattern pattern = two_rectangles();
    EXPECT_EQ(find_panel(pattern, "right"), 1);
    EXPECT_EQ(find_panel(pattern, "middle"), -1);
}

TEST(SewingPattern, PanelsTurnOverUntilRightSidesJoinRightSides)
{
    SewingPattern pattern = two_rectangles();
    pattern.seams[0].sides[1].is_backward = false;
    EXPECT_TRUE(joins_right_to_wrong(pattern, pattern.seams[0]));
    agree_on_sides(pattern);
    EXPECT_FALSE(pattern.panels[0].is_turned_over) << "the first panel stays";
    EXPECT_TRUE(pattern.panels[1].is_turned_over);
    EXPECT_FALSE(joins_right_to_wrong(pattern, pattern.seams[0]));
    EXPECT_FALSE(pattern.seams[0].is_tie);
}

TEST(SewingPattern, StripThatCannotAgreeHasATie)
{
    const SewingPattern pattern = moebius_strip();
    EXPECT_TRUE(pattern.seams[0].is_tie);
    EXPECT_FALSE(pattern.panels[0].is_turned_over);
}

TEST(SewingPattern, TieOfTheUserTurnsNothingAndStays)
{
    SewingPattern pattern = two_rectangles();
    pattern.seams[0].sides[1].is_backward = false;
    pattern.seams[0].is_tie = true;
    agree_on_sides(pattern);
    EXPECT_TRUE(pattern.seams[0].is_tie);
    EXPECT_FALSE(pattern.panels[1].is_turned_over);
}

// Sides are drawn for panels at random, seams follow from them: all agree, in whatever order they come.
TEST(SewingPattern, SeamsThatCanAgreeDo)
{
    std::mt19937 random(7);
    for (int trial = 0; trial < 50; ++trial) {
        constexpr int kPanels = 12;
        SewingPattern pattern;
        std::vector<bool> is_over;
        for (int p = 0; p < kPanels; ++p) {
            pattern.panels.push_back(rectangle_panel(std::to_string(p), {1.0, 1.0}));
            is_over.push_back(random() % 2 == 1);
        }
        for (int s = 0; s < 20; ++s) {
            const int a = static_cast<int>(random() % kPanels), b = static_cast<int>(random() % kPanels);
            Seam seam = simple_seam(a, 0, b, 1);
            seam.sides[0].is_backward = random() % 2 == 1;
            seam.sides[1].is_backward = (is_over[a] == is_over[b]) != seam.sides[0].is_backward;
            pattern.seams.push_back(seam);
        }
        agree_on_sides(pattern);
        for (const Seam& seam : pattern.seams) {
            EXPECT_FALSE(seam.is_tie);
            EXPECT_FALSE(joins_right_to_wrong(pattern, seam));
        }
    }
}

}  // namespace
}  // namespace arris
