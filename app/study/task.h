// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace arris {

/// One process of a study: a run, or a repetition of a run for its time.
struct Task {
    std::string name;
    std::vector<std::string> command;  ///< program and arguments
    std::string fingerprint;           ///< of all that decides the outcome
};

/// How a task ended.
struct TaskEnd {
    int exit_status = 0;  ///< as in shells: 128 + N for signal N
    std::string machine;  ///< host and processor
};

/// The files that tasks leave in a study's folder, whatever ran them:
///   runs/NAME         the run
///   tasks/NAME.task   the fingerprint of the task that was started, and its command
///   tasks/NAME.log    its output
///   tasks/NAME.exit   exit status and machine, written when it has ended
/// All names are safe in paths.
class TaskFolder {
  public:
    explicit TaskFolder(std::string directory) : directory_(std::move(directory)) {}

    const std::string& path() const { return directory_; }
    std::string run_directory(const std::string& name) const;
    std::string log_file(const std::string& name) const;
    std::string exit_file(const std::string& name) const;
    std::string task_file(const std::string& name) const;

    /// Makes the folders. Throws InputError if that fails.
    void create() const;

    /// Notes that a task is about to start: writes NAME.task, removes NAME.exit and an earlier report.json.
    void note_start(const Task& task) const;

    /// Whether the task that was last started under this name has the same fingerprint.
    bool is_started(const Task& task) const;

    void write_end(const std::string& name, const TaskEnd& end) const;

    /// Nothing if the task has not ended.
    std::optional<TaskEnd> read_end(const std::string& name) const;

    /// Whether the task has ended with an outcome that will not change when it is run again.
    bool is_done(const Task& task) const;

    /// finished, another status of report.json, bad_input, killed or crashed.
    std::string status_of(const std::string& name, const TaskEnd& end) const;

    /// The last line of the task's log.
    std::string last_line(const std::string& name) const;

  private:
    std::string directory_;
};

/// "host, processor" of this machine.
std::string describe_machine();

/// A word quoted for sh.
std::string shell_quote(const std::string& word);

}  // namespace arris
