// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/study_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/app/error_of.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Study read(const std::string& text, bool is_quick = false)
{
    const TemporaryDirectory folder;
    write_bytes(folder / "study.toml", text);
    return read_study(folder / "study.toml", is_quick);
}

std::vector<std::string> listed(const Study& study)
{
    std::vector<std::string> lines;
    for (const std::vector<Setting>& run : study.runs) lines.push_back(list_settings(run));
    return lines;
}

TEST(StudyFile, AGridIsEveryCombinationWithTheLastKeyFastest)
{
    const Study study = read(
        "scene = 's.toml'\n"
        "vary = { \"time.step\" = [0.01, 5e-3], \"eol.enabled\" = [true, false] }\n");
    EXPECT_THAT(
        listed(study),
        ElementsAre("time.step = 0.01, eol.enabled = true", "time.step = 0.01, eol.enabled = false",
                    "time.step = 0.005, eol.enabled = true", "time.step = 0.005, eol.enabled = false"));
    EXPECT_EQ(study.repeats, 1);
    EXPECT_FALSE(study.error);
}

TEST(StudyFile, KeysInTablesAreDottedKeysAndValuesAreTomlAgain)
{
    const Study study = read(
        "scene = 's.toml'\n"
        "[set]\ncloth.material.preset = \"silk\"\ngravity = {}\n"
        "[[runs]]\ncloth.resolution = [4, 16]\n"
        "[[runs]]\ncloth.resolution = [8, 2]\ntime.integrator = \"bdf2\"\n");
    EXPECT_THAT(listed(study), ElementsAre("cloth.resolution = [4, 16]",
                                           "cloth.resolution = [8, 2], time.integrator = bdf2"));
    ASSERT_EQ(study.common.size(), 2u);
    EXPECT_EQ(assignment(study.common[0]), "cloth.material.preset=\"silk\"");
    EXPECT_EQ(study.common[1].key, "gravity");
    EXPECT_EQ(study.runs[0][0].number, 16.0) << "the number of a resolution is that of its longer side";
}

TEST(StudyFile, AxesAreNumbersThatVaryAloneAndNamesLeaveOutWhatFollows)
{
    const Study grid = read(
        "scene = 's.toml'\n"
        "vary = { \"time.step\" = [0.1, 0.2], \"eol.enabled\" = [true, false], \"cloth.resolution\" = [[4, "
        "4], [8, 8]], "
        "\"solver.tolerance\" = [1e-9] }\n");
    EXPECT_THAT(grid.axis_keys, ElementsAre("cloth.resolution", "time.step"));
    EXPECT_THAT(grid.telling_keys, ElementsAre("time.step", "eol.enabled", "cloth.resolution"));
    // The stiffness follows from the pattern, the size from the resolution.
    const Study list = read(
        "scene = 's.toml'\nruns = [\n"
        "{ cloth.pattern = 'cross', cloth.material.bending_stiffness = 1, cloth.resolution = [4, 1], "
        "cloth.size = [2, 1] },\n"
        "{ cloth.pattern = 'cross', cloth.material.bending_stiffness = 1, cloth.resolution = [8, 1], "
        "cloth.size = [2, 2] },\n"
        "{ cloth.pattern = 'diagonal', cloth.material.bending_stiffness = 3, cloth.resolution = [4, 1], "
        "cloth.size = [2, 1] }]\n");
    EXPECT_THAT(list.telling_keys, ElementsAre("cloth.pattern", "cloth.resolution"));
    EXPECT_THAT(list.axis_keys, ElementsAre("cloth.resolution"));
}

TEST(StudyFile, QuickKeysReplaceOnlyWhatTheyName)
{
    const std::string text =
        "scene = 's.toml'\nrepeats = 5\n"
        "vary = { \"time.step\" = [0.01, 0.005], \"cloth.resolution\" = [[64, 64]] }\n"
        "error = { probe = 'tip', reference = 't', norm = 'rms' }\n"
        "[quick]\nrepeats = 1\nvary = { \"cloth.resolution\" = [[4, 4]] }\nerror = { norm = 'final' }\n";
    const Study whole = read(text), quick = read(text, true);
    EXPECT_EQ(whole.repeats, 5);
    EXPECT_EQ(whole.error->norm, ErrorRule::Norm::Rms);
    EXPECT_EQ(quick.repeats, 1);
    EXPECT_EQ(quick.error->norm, ErrorRule::Norm::Final);
    EXPECT_EQ(quick.error->probe, "tip");
    EXPECT_THAT(listed(quick), ElementsAre("time.step = 0.01, cloth.resolution = [4, 4]",
                                           "time.step = 0.005, cloth.resolution = [4, 4]"));
}

TEST(StudyFile, ReferencesAreAFormulaAFileTheFinestOrARun)
{
    const std::string head = "scene = 's.toml'\nvary = { \"time.step\" = [0.01] }\n";
    using Reference = ErrorRule::Reference;
    const auto rule = [&](const std::string& error) {
        return *read(head + "error = {" + error + "}\n").error;
    };
    EXPECT_EQ(rule("probe = 'tip', reference = '0.1-0.1*cosh(t*sqrt(9.81))'").reference, Reference::Formula);
    EXPECT_EQ(rule("column = 'vertices', reference = 'a.csv'").reference, Reference::File);
    EXPECT_EQ(rule("column = 'vertices'").reference, Reference::None);
    EXPECT_EQ(rule("shape = 'all', reference = 'finest'").reference, Reference::Finest);
    const ErrorRule further = rule("shape = 'last', reference = { \"time.step\" = 0.001 }");
    EXPECT_EQ(further.reference, Reference::Run);
    ASSERT_EQ(further.reference_run.size(), 1u);
    EXPECT_EQ(assignment(further.reference_run[0]), "time.step=0.001");
}

TEST(StudyFile, BadInputNamesLineKeyAndWhatIsAllowed)
{
    const std::string vary = "vary = { \"time.step\" = [0.01] }\n", head = "scene = 's.toml'\n" + vary;
    const std::vector<std::pair<std::string, std::string>> wrong = {
        {vary, "scene: is required and missing; allowed: a scene file"},
        {"scene = 's.toml'\n",
         "vary: is required and missing; allowed: either vary (a grid) or runs (a list)"},
        {head + "runs = [{}]\n", "runs = [{}]: contradicts vary"},
        {head + "reapets = 2\n", ":3: reapets = 2: unknown key; allowed: title, scene"},
        {head + "repeats = 0\n", ":3: repeats = 0: is out of range; allowed: an integer from 1 to 100"},
        {head + "repeats = 2.5\n", "is of another type; allowed: an integer"},
        {"scene = 's.toml'\nvary = { \"time.step\" = [] }\n", "is empty; allowed: an array of values"},
        {"scene = 's.toml'\nvary = { \"time.step\" = 0.1 }\n", "allowed: an array of values"},
        {"scene = 's.toml'\nvary = { \"time.step\" = [0.1, 0.1] }\n", "has two runs with time.step = 0.1"},
        {"scene = 's.toml'\nvary = { \"time.step\" = [2020-01-01] }\n", "holds a date"},
        {head + "error = { probe = 'tip' }\n", "error.reference: is required and missing"},
        {head + "error = { probe = 'tip', column = 'time' }\n", "names not exactly one quantity"},
        {head + "error = { column = 'time', axis = 'x' }\n", "error.axis = 'x': has no probe"},
        {head + "error = { probe = 'tip', axis = 'w', reference = 't' }\n",
         "error.axis = 'w': is not a choice"},
        {head + "error = { probe = 'tip', reference = '2*s' }\n", "is not a formula in t: "},
        {head + "error = { probe = 'tip', reference = 'cosh(t' }\n", "is not a formula in t: "},
        {head + "error = { shape = 'last', reference = 't' }\n", "is no shape; allowed: \"finest\""},
        {head + "error = { shape = 'last', reference = 'finest', norm = 'rms' }\n", "allowed: mean max"},
        {head + "quick = { scene = 'x' }\n", "quick.scene = 'x': unknown key"},
    };
    for (const auto& [text, line] : wrong) {
        const std::string error = error_of([&, &content = text] { read(content); });
        EXPECT_THAT(error, HasSubstr("study.toml:")) << text;
        EXPECT_THAT(error, HasSubstr(line)) << text;
    }
}

}  // namespace
}  // namespace arris
