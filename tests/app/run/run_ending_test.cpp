// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/run_ending.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "geometry/obstacle_input/obstacle_shapes.h"
#include "solver/step.h"
#include "tests/app/program.h"

namespace arris {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;

struct EndingCase {
    const char* name;
    std::string text;  ///< after kSheet
    const char*
        message;  ///< regular expression after "no velocity keeps vertex .., at [..] (m, ..), out of "
};

// A sheet of half a metre that falls from z = 0.11.
constexpr const char* kSheet =
    "duration = 1\n[cloth]\nsize = [0.5, 0.5]\nresolution = [4, 4]\ntranslate = [-0.25, -0.25, 0.11]\n"
    "[gravity]\n";

std::string box(const std::string& name, const std::string& sizes, const std::string& more)
{
    return "[[obstacle]]\nname = \"" + name + "\"\nbox = " + sizes + "\n" + more + "\n";
}

std::string pin(const std::string& material, const std::string& more = "")
{
    return "[[pin]]\nmaterial = " + material + "\n" + more + "\n";
}

const std::string kCorner = "[[0.5, 0.5], [0.5, 0.5]]", kMiddle = "[[0.25, 0.25], [0.25, 0.25]]",
                  kLeft = "[[0, 0], [0, 0.5]]", kRight = "[[0.5, 0], [0.5, 0.5]]";

const EndingCase kEndings[] = {
    {"a second pin drives cloth into a floor",
     box("ground", "[3, 3, 0.2]", "") + pin(kCorner) + pin(kLeft, "velocity = [0, 0, -0.2]"),
     "ground in the step .*: pin.1 holds the vertex where ground is.*"},
    {"an obstacle is driven into a pin",
     box("ram", "[3, 3, 0.2]", "motion = { velocity = [0, 0, 0.5] }") + pin(kMiddle),
     "ram in the step .*: pin.0 holds the vertex where ram is.*"},
    {"a pin drives cloth into a wall",
     box("ground", "[3, 3, 0.02]", "translate = [0, 0, -3]") +
         box("wall", "[0.1, 3, 3]", "translate = [0.5, 0, 0]") + pin(kRight, "velocity = [0.5, 0, 0]"),
     "wall in the step .*: pin.0 holds the vertex where wall is.*"},
    {"a wire is driven into a pin",
     "[[obstacle]]\nname = \"rope\"\nwire = [[-1, 0, 0.4], [1, 0, 0.4]]\nmotion = { velocity = [0, 0, -0.5] "
     "}\n" +
         pin(kLeft) + pin(kRight),
     "rope in the step .*: pin.[01] holds the vertex where rope is.*"},
    {"a nail is driven into a pin",
     "[[obstacle]]\nname = \"nail\"\npoints = [[0, 0, 0.4]]\nmotion = { velocity = [0, 0, -0.5] }\n" +
         pin(kMiddle),
     "nail in the step .*: pin.0 holds the vertex where nail is.*"},
    {"two plates meet",
     box("slab", "[0.3, 0.3, 0.2]", "") +
         box("lid", "[0.3, 0.3, 0.1]", "translate = [0, 0, 0.3]\nmotion = { velocity = [0, 0, -1] }"),
     "slab and lid in the step .*: these obstacles leave it no room"},
    {"a wire meets a plate",
     box("slab", "[2, 2, 0.2]", "") + "[[obstacle]]\nname = \"blade\"\nwire = [[-2, 0, 0.4], [2, 0, "
                                      "0.4]]\nmotion = { velocity = [0, 0, -1] }\n",
     "(blade and slab|slab and blade) in the step .*: these obstacles leave it no room"},
    {"a nail meets a plate",
     box("slab", "[2, 2, 0.2]", "") +
         "[[obstacle]]\nname = \"spike\"\npoints = [[0.03, 0.02, 0.4]]\nmotion = { velocity = [0, 0, -1] }\n",
     "(spike and slab|slab and spike) in the step .*: these obstacles leave it no room"},
    {"a pin drives cloth into a pinned part of it",
     "[self_contact]\n" + pin("[[0, 0], [0.125, 0.5]]") +
         pin("[[0.375, 0], [0.5, 0.5]]",
             "keyframes = [{time = 0}, {time = 0.3, translate = [-0.3, 0, 0.1]}, "
             "{time = 0.9, translate = [-0.3, 0, -0.2]}]"),
     // The fold between them is pressed to its least thickness first or last.
     "the cloth itself in the step .*: (pin.0 and pin.1 press two layers into each other|pin.1 presses it "
     "into "
     "another layer).*"},
    {"an obstacle presses a free layer against a pinned one",
     "[self_contact]\n[friction]\ncoefficient = 2.0\n" + pin("[[0.25, 0], [0.5, 0.5]]") +
         box("ram", "[0.1, 0.7, 0.04]",
             "keyframes = [{time = 0.2, translate = [-0.2, 0, -0.05]}, "
             "{time = 0.6, translate = [0.1, 0, -0.05]}, {time = 1, translate = [0.1, 0, 0.2]}]"),
     // The free layer is pressed onto the pinned one, or out from between, first.
     "(the cloth itself in the step .*: ram presses another layer into it, and pin.0 holds it"
     "|ram in the step .*: pin.0 holds the vertex where ram is).*"},
    {"plates that meet far from others",
     box("other", "[0.3, 0.3, 0.1]", "translate = [9, 0, 0]") +
         box("lid", "[0.3, 0.3, 0.1]", "translate = [0, 0, 0.3]\nmotion = { velocity = [0, 0, -1] }") +
         box("slab", "[0.3, 0.3, 0.2]", ""),
     "lid and slab in the step .*: these obstacles leave it no room"},
};

TEST(RunEnding, NamesThePinAndTheObstaclesThatCannotBeMetTogether)
{
    for (const EndingCase& one : kEndings) {
        SCOPED_TRACE(one.name);
        const TemporaryDirectory folder;
        write_bytes(folder / "scene.toml", kSheet + one.text);
        Program program(folder, {"run", folder / "scene.toml", "-o", folder / "out", "--quiet"});
        EXPECT_EQ(program.wait(), 1);
        const nlohmann::json report = nlohmann::json::parse(read_bytes(folder / "out/report.json"));
        EXPECT_EQ(report["status"], "infeasible");
        const std::string message = report["message"];
        EXPECT_THAT(message, MatchesRegex("no velocity keeps vertex [0-9]+, at .*m, material .*, out of " +
                                          std::string(one.message)));
        EXPECT_THAT(program.err(), HasSubstr("arris: infeasible: " + message + "\n"));
    }
}

TEST(RunEnding, OfAnInfeasibleStepWithoutAVertexOrWithOneObstacleIsAWholeSentence)
{
    Scene scene;
    scene.obstacles.push_back(MovingObstacle("vee", make_box({1, 1, 1}), {}, {}, 30.0));
    State state;
    state.time = 0.5;
    StepReport report;
    report.status = StepStatus::Infeasible;
    EXPECT_THAT(explain_ending(report, 1e-9, scene, state).message,
                AllOf(HasSubstr("keeps the cloth out of the obstacles in the step after t = 0.5 s"),
                      Not(HasSubstr("-1"))));
    report.infeasible = {7, -1, {0, -1}};
    EXPECT_THAT(explain_ending(report, 1e-9, scene, state).message,
                AllOf(HasSubstr("keeps vertex 7 out of vee in the step"),
                      HasSubstr("two parts of this obstacle leave it no room")));
}

TEST(RunEnding, NamesPlaceAndObstaclesWhateverTheStatus)
{
    Scene scene;
    for (const char* name : {"vee", "lid"})
        scene.obstacles.push_back(MovingObstacle(name, make_box({1, 1, 1}), {}, {}, 30.0));
    struct Case {
        StepStatus status;
        double residual;
        int factorisations;
        std::array<int, 2> obstacles;
        bool is_with_itself;
        std::string message;  ///< regular expression
    };
    const std::string at = "vertex 7, at \\[1, 2, 3\\] \\(m, material \\[4, 5\\]\\),";
    const Case kCases[] = {
        {StepStatus::Penetration,
         0,
         1,
         {0, -1},
         false,
         "the cloth cannot be kept out of vee at " + at + " in the .*"},
        {StepStatus::Penetration, 0, 1, {1, 0}, false, ".* kept out of lid and vee at " + at + " in the .*"},
        {StepStatus::Penetration,
         0,
         1,
         {1, -1},
         true,
         ".* kept out of lid and itself at " + at + " in the .*"},
        {StepStatus::Penetration, 0, 1, {-1, -1}, true, ".* kept out of itself at " + at + " in the .*"},
        {StepStatus::Overrun,
         0,
         1,
         {1, -1},
         false,
         "material flows over lid faster .* follow at " + at + " in the .*"},
        {StepStatus::NotConverged,
         1e-3,
         1,
         {0, 1},
         false,
         ".*residual of .*; the cloth presses hardest at " + at + " on vee and lid"},
        {StepStatus::NotConverged,
         NAN,
         9,
         {0, -1},
         false,
         ".*found no answer .*; the cloth presses hardest at " + at + " on vee"},
        {StepStatus::NotConverged, NAN, 1, {-1, -1}, false, ".*factorised .*; the stiffest part is " + at},
    };
    for (const Case& one : kCases) {
        SCOPED_TRACE(one.message);
        StepReport report;
        report.status = one.status;
        report.kkt_residual = one.residual;
        report.factorisations = one.factorisations;
        report.place = {7, {1, 2, 3}, {4, 5}, one.obstacles, one.is_with_itself};
        EXPECT_THAT(explain_ending(report, 1e-9, scene, State()).message, MatchesRegex(one.message));
    }
}

TEST(RunEnding, SaysWhereFrictionLocksClothInACrease)
{
    Scene scene;
    for (const char* name : {"upper", "fore"})
        scene.obstacles.push_back(MovingObstacle(name, make_box({1, 1, 1}), {}, {}, 30.0));
    const auto message_of = [&](StepStatus status, double degrees) {
        StepReport report;
        report.status = status;
        report.infeasible = {7, -1, {0, 1}};
        report.place = {7, {1, 2, 3}, {4, 5}, {0, 1}};
        report.place.crease = {0, 1};
        report.place.crease_angle = degrees * M_PI / 180.0;
        return explain_ending(report, 1e-9, scene, State()).message;
    };
    for (const StepStatus status : {StepStatus::Infeasible, StepStatus::Penetration}) {
        scene.friction.reset();
        EXPECT_THAT(message_of(status, 40.0), Not(HasSubstr("friction")));
        scene.friction = Friction{{0.3}, {0.9, 0.6}, {}};
        EXPECT_THAT(
            message_of(status, 40.0),
            HasSubstr("; friction locks it there: with a coefficient of 0.6 cloth does not slip out of a "
                      "crease of less than 62 degrees, and this one has 40"));
        EXPECT_THAT(message_of(status, 63.0), Not(HasSubstr("friction"))) << "the cloth slips out";
        EXPECT_THAT(message_of(status, 0.0), Not(HasSubstr("friction"))) << "parallel plates";
    }
}

TEST(RunEnding, NamesTheNumberThatIsNotFinite)
{
    Scene scene;
    scene.obstacles.push_back(MovingObstacle("vee", make_box({1, 1, 1}), {}, {}, 30.0));
    State state;
    StepReport report;
    report.status = StepStatus::NotFinite;
    const auto message = [&](const NotFinite& found) {
        report.not_finite = found;
        return explain_ending(report, 1e-9, scene, state).message;
    };
    EXPECT_THAT(message({"pin's target", 7, -1, 2}),
                HasSubstr("the pin's target of vertex 7 of pin.2 is not"));
    EXPECT_THAT(message({"contact", 7, 0, -1}), HasSubstr("the contact of vertex 7 with vee is not finite"));
    EXPECT_THAT(message({"placement", -1, 0, -1}), HasSubstr("the placement of vee is not finite"));
}

}  // namespace
}  // namespace arris
