// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/analysis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/study/study_axes.h"
#include "app/study/study_panels.h"

namespace arris {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

Setting number(const std::string& key, double value)
{
    return {key, std::to_string(value), std::to_string(value), value};
}

/// A study of time.step and eol.enabled. Errors are absolute, their scale is 10.
class StudyAnalysis : public ::testing::Test {
  protected:
    void add(double step, bool eol, double cpu, double error, const std::string& status = "finished")
    {
        RunOutcome outcome;
        const std::string enabled = eol ? "true" : "false";
        outcome.run.settings = {number("time.step", step), {"eol.enabled", enabled, enabled, {}}};
        outcome.status = status;
        outcome.cpu_seconds = {cpu};
        outcome.wall_seconds = {cpu};
        if (status == "finished") outcome.error = RunError{error, 10.0, ErrorScale::Range, {}, {}};
        study_.runs.push_back(outcome.run.settings);
        outcomes_.push_back(outcome);
        find_axes(study_);
    }
    void SetUp() override
    {
        study_.title = "Test";
        study_.keys = {"time.step", "eol.enabled"};
        study_.error.emplace();
        study_.error->probe = "tip";
        study_.error->reference = ErrorRule::Reference::Formula;
        study_.error->formula = "t";
    }

    Study study_;
    std::vector<RunOutcome> outcomes_;
};

TEST_F(StudyAnalysis, FitsTheOrderOfEachMethodAndLeavesFailedRunsOut)
{
    add(0.1, true, 1, 3 * 0.01);
    add(0.2, true, 0.5, 3 * 0.04);
    add(0.4, true, 0.25, 3 * 0.16);
    add(0.1, false, 1, 7 * 0.1);
    add(0.2, false, 0.5, 7 * 0.2);
    add(0.4, false, 0.2, 0, "infeasible");
    const std::vector<StudyCurve> curves = make_curves(study_, outcomes_, "time.step");
    ASSERT_EQ(curves.size(), 2u);
    EXPECT_EQ(curves[0].name, "EOL");
    EXPECT_EQ(curves[1].name, "rows only");
    EXPECT_THAT(curves[0].runs, ElementsAre(0, 1, 2));
    EXPECT_NEAR(*curves[0].slope, 2.0, 1e-12);
    EXPECT_NEAR(*curves[1].slope, 1.0, 1e-12);
}

TEST(StudyAxes, EdgeLengthStandsForVerticesWhereTimeAloneIsMeasured)
{
    RunOutcome outcome;
    outcome.run.settings = {number("cloth.edge_length", 0.05)};
    outcome.vertices = 500;
    EXPECT_EQ(abscissa(outcome, "cloth.edge_length", false), 500.0);
    EXPECT_EQ(abscissa(outcome, "cloth.edge_length", true), 0.05);
}

TEST_F(StudyAnalysis, TheFrontIsWhatNoRunBeatsInBoth)
{
    add(0.1, true, 4, 0.1);   // best
    add(0.2, true, 2, 0.5);   // on the front
    add(0.4, true, 3, 0.6);   // beaten by the one above
    add(0.8, true, 1, 5.0);   // cheapest
    add(0.1, false, 1, 6.0);  // as cheap, worse
    add(0.2, false, 0.1, 0, "infeasible");
    EXPECT_THAT(find_pareto_front(outcomes_), ElementsAre(3, 1, 0));
}

TEST_F(StudyAnalysis, TellsTheCheapestSettingForEachError)
{
    add(0.1, true, 4, 0.05);
    add(0.2, true, 2, 0.05);
    add(0.4, true, 1, 0.9);
    add(0.4, false, 0.5, 5.0);
    const std::vector<CheapestRun> cheapest = find_cheapest(outcomes_, "");
    ASSERT_EQ(cheapest.size(), 3u);
    EXPECT_EQ(cheapest[0].run, 2u) << "0.9 of 10 is 9 %";
    EXPECT_EQ(cheapest[1].run, 1u);
    EXPECT_FALSE(cheapest[2].run);
    const std::string sentence = tell_cheapest(study_, outcomes_);
    EXPECT_THAT(sentence,
                HasSubstr("10 %: time.step = 0.400000, eol.enabled = true (error 9 %, 1 CPU s); 1 %: "));
    EXPECT_THAT(sentence, HasSubstr("; 0.1 %: no run of the study. Per cent are of the reference"));
}

TEST_F(StudyAnalysis, ARunIsNeverComparedWithItself)
{
    add(0.1, true, 4, 0.0);
    add(0.2, true, 2, 0.5);
    outcomes_[0].is_reference = true;
    EXPECT_THAT(find_pareto_front(outcomes_), ElementsAre(1));
    EXPECT_FALSE(find_cheapest(outcomes_, "")[2].run);
}

TEST_F(StudyAnalysis, WithoutAReferenceSmallIsNotBetter)
{
    study_.error->reference = ErrorRule::Reference::None;
    study_.error->quantity = ErrorRule::Quantity::Column;
    study_.error->column = "kinetic_energy";
    add(0.1, true, 4, 0.05);
    add(0.2, true, 2, 0.5);
    for (RunOutcome& outcome : outcomes_) outcome.error->scale.reset();
    EXPECT_TRUE(find_pareto_front(outcomes_).empty());
    EXPECT_FALSE(make_curves(study_, outcomes_, "time.step")[0].slope);
    EXPECT_THAT(tell_cheapest(study_, outcomes_), HasSubstr("has no reference"));
    EXPECT_THAT(draw_study(study_, outcomes_), HasSubstr("kinetic_energy against CPU time"));
}

TEST_F(StudyAnalysis, DrawsACurveAMethodTheFrontAndFailedRuns)
{
    add(0.1, true, 1, 0.01);
    add(0.2, true, 0.5, 0.04);
    add(0.1, false, 2, 0.1);
    add(0.2, false, 3, 0, "<infeasible>");
    study_.title = "Tom & <Jerry>";
    const std::string svg = draw_study(study_, outcomes_);
    EXPECT_THAT(svg, HasSubstr("EOL (order 2.00)"));
    EXPECT_THAT(svg, HasSubstr("rows only<"));
    EXPECT_THAT(svg, HasSubstr("Error against CPU time"));
    EXPECT_THAT(svg, HasSubstr("Error against time step (s)"));
    EXPECT_THAT(svg, HasSubstr("Pareto front"));
    EXPECT_THAT(svg, HasSubstr("failed run"));
    EXPECT_THAT(svg, HasSubstr("Tom &amp; &lt;Jerry&gt;"));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr("inf ")));
}

TEST(FitSlope, NeedsTwoPositivePointsOfDifferentX)
{
    EXPECT_FALSE(fit_slope({}, {}));
    EXPECT_FALSE(fit_slope({1.0, 1.0}, {1.0, 2.0}));
    EXPECT_FALSE(fit_slope({1.0, 2.0}, {1.0, 0.0}));
    EXPECT_NEAR(*fit_slope({1.0, 10.0, 100.0}, {5.0, 500.0, 50000.0}), 2.0, 1e-12);
}

TEST(Median, IsTheMiddleOrTheMeanOfTheTwoMiddleValues)
{
    EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
    EXPECT_EQ(median({4.0, 1.0, 2.0, 8.0}), 3.0);
}

}  // namespace
}  // namespace arris
