// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/task.h"

#include <gtest/gtest.h>

#include "app/study/fingerprint.h"
#include "tests/app/temporary_directory.h"

namespace arris {
namespace {

class StudyTask : public ::testing::Test {
  protected:
    StudyTask() : folder_(directory_.path()) { folder_.create(); }

    void leave_report(const std::string& status)
    {
        std::filesystem::create_directories(folder_.run_directory("a"));
        write_bytes(folder_.run_directory("a") + "/report.json", "{\"status\": \"" + status + "\"}");
    }

    TemporaryDirectory directory_;
    TaskFolder folder_;
    Task task_{"a", {"/bin/program", "it's"}, "0123"};
};

TEST_F(StudyTask, IsDoneWhenItEndedWithTheSameFingerprint)
{
    EXPECT_FALSE(folder_.is_done(task_));
    folder_.note_start(task_);
    EXPECT_FALSE(folder_.is_done(task_)) << "it has not ended";
    leave_report("finished");
    folder_.write_end("a", {0, "host, processor"});
    EXPECT_TRUE(folder_.is_done(task_));
    EXPECT_EQ(folder_.read_end("a")->machine, "host, processor");
    task_.fingerprint = "0124";
    EXPECT_FALSE(folder_.is_done(task_));
}

TEST_F(StudyTask, IsRunAgainWhereAnotherRunMayEndOtherwise)
{
    struct Case {
        int exit_status;
        const char *report, *status;
        bool is_done;
    };
    for (const Case& c : {Case{0, "finished", "finished", true}, Case{1, "infeasible", "infeasible", true},
                          Case{2, "", "bad_input", true}, Case{1, "io_error", "io_error", false},
                          Case{130, "interrupted", "interrupted", false}, Case{137, "", "killed", false},
                          Case{1, "", "crashed", false}, Case{0, "infeasible", "crashed", false}}) {
        folder_.note_start(task_);
        if (*c.report) leave_report(c.report);
        folder_.write_end("a", {c.exit_status, ""});
        EXPECT_EQ(folder_.status_of("a", *folder_.read_end("a")), c.status) << c.exit_status;
        EXPECT_EQ(folder_.is_done(task_), c.is_done) << c.exit_status;
    }
}

TEST_F(StudyTask, AStartForgetsTheEarlierEnd)
{
    folder_.note_start(task_);
    leave_report("finished");
    folder_.write_end("a", {0, ""});
    folder_.note_start(task_);
    EXPECT_FALSE(folder_.read_end("a"));
    EXPECT_FALSE(std::filesystem::exists(folder_.run_directory("a") + "/report.json"));
}

TEST(ShellQuote, KeepsEveryCharacter)
{
    EXPECT_EQ(shell_quote("a b"), "'a b'");
    EXPECT_EQ(shell_quote("it's $x"), "'it'\\''s $x'");
}

TEST(Fingerprint, DependsOnEachTextAndItsPlace)
{
    EXPECT_EQ(fingerprint({"ab", "c"}), fingerprint({"ab", "c"}));
    EXPECT_NE(fingerprint({"ab", "c"}), fingerprint({"a", "bc"}));
    EXPECT_NE(fingerprint({"ab", "c"}), fingerprint({"c", "ab"}));
    EXPECT_EQ(file_fingerprint("/does/not/exist"), "absent");
}

}  // namespace
}  // namespace arris
