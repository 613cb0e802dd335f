// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "app/scene/parts/run_config.h"
#include "tests/app/temporary_directory.h"

namespace arris {

/// Scenes are loaded with their mesh files read by the program, not by the test.
inline LoadOptions with_program()
{
    LoadOptions options;
    options.importer = {ARRIS_PROGRAM, "import-obstacle"};
    return options;
}

/// The arris program as a child process, its output in files.
class Program {
  public:
    /// `name`: of its output's files; two at once need two.
    Program(const TemporaryDirectory& folder, const std::vector<std::string>& arguments,
            const std::string& name = "program")
        : out_(folder / (name + ".out")), err_(folder / (name + ".err"))
    {
        child_ = fork();
        if (child_ != 0) return;
        dup2(open(out_.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600), STDOUT_FILENO);
        dup2(open(err_.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600), STDERR_FILENO);
        std::vector<char*> argv = {const_cast<char*>(ARRIS_PROGRAM)};
        for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
        argv.push_back(nullptr);
        execv(ARRIS_PROGRAM, argv.data());
        _exit(127);
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    /// Exit status, or minus the signal that ended it.
    int wait()
    {
        int status = 0;
        waitpid(child_, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }
    int stop_after(std::chrono::milliseconds delay, int signal)
    {
        std::this_thread::sleep_for(delay);
        kill(child_, signal);
        return wait();
    }
    std::string out() const { return read_bytes(out_); }
    std::string err() const { return read_bytes(err_); }

  private:
    std::string out_, err_;
    pid_t child_ = -1;
};

}  // namespace arris
