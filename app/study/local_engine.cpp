// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/local_engine.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <map>
#include <string_view>
#include <system_error>
#include <thread>

#include "app/run/interrupt.h"

namespace arris {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kNap{10};    // between looks at the children
constexpr std::chrono::seconds kTimeToStop{10};  // for an interrupted run to write its checkpoint
constexpr int kNotStarted = 127;                 // as in shells

// Libraries that start threads of their own get one.
std::vector<char*> make_environment()
{
    static char blas[] = "OPENBLAS_NUM_THREADS=1", openmp[] = "OMP_NUM_THREADS=1";
    std::vector<char*> environment = {blas, openmp};
    for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
        const std::string_view name(*entry);
        if (!name.starts_with("OPENBLAS_NUM_THREADS=") && !name.starts_with("OMP_NUM_THREADS="))
            environment.push_back(*entry);
    }
    environment.push_back(nullptr);
    return environment;
}

// In the child: only system calls. The group of its own keeps a terminal's Ctrl-C from arriving twice.
[[noreturn]] void become(char* const* arguments, char* const* environment, const char* log, pid_t parent)
{
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(kNotStarted);
    const int output = ::open(log, O_CREAT | O_TRUNC | O_WRONLY, 0666);
    const int input = ::open("/dev/null", O_RDONLY);
    if (output < 0 || input < 0) ::_exit(kNotStarted);
    if (::dup2(input, 0) < 0 || ::dup2(output, 1) < 0 || ::dup2(output, 2) < 0) ::_exit(kNotStarted);
    if (::close_range(3, ~0u, 0) != 0) ::_exit(kNotStarted);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::signal(signal, SIG_DFL);
    ::execve(arguments[0], arguments, environment);
    ::_exit(kNotStarted);
}

pid_t start(const Task& task, const TaskFolder& folder)
{
    std::vector<char*> arguments;
    for (const std::string& word : task.command) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const std::vector<char*> environment = make_environment();
    const std::string log = folder.log_file(task.name);
    const pid_t parent = ::getpid(), pid = ::fork();
    if (pid == 0) become(arguments.data(), environment.data(), log.c_str(), parent);
    if (pid < 0) throw std::system_error(errno, std::generic_category(), "cannot start a run");
    return pid;
}

int exit_status(int status)
{
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

/// Tasks that are running, by process. Ends them when it is destroyed.
class Children {
  public:
    Children(const TaskFolder& folder, const TaskEnded& ended) : folder_(folder), ended_(ended) {}
    Children(const Children&) = delete;
    Children& operator=(const Children&) = delete;
    ~Children()
    {
        for (const auto& [pid, task] : running_) {
            ::kill(pid, SIGKILL);
            ::waitpid(pid, nullptr, 0);
        }
    }

    int count() const { return static_cast<int>(running_.size()); }

    void add(const Task& task)
    {
        folder_.note_start(task);
        running_[start(task, folder_)] = &task;
    }

    void collect()
    {
        for (auto child = running_.begin(); child != running_.end();) {
            int status = 0;
            const pid_t pid = ::waitpid(child->first, &status, WNOHANG);
            if (pid == 0 || (pid < 0 && errno == EINTR)) {
                ++child;
                continue;
            }
            const Task& task = *child->second;
            child = running_.erase(child);
            if (pid < 0) throw std::system_error(errno, std::generic_category(), "lost run " + task.name);
            const TaskEnd end{exit_status(status), machine_};
            folder_.write_end(task.name, end);
            ended_(task, end);
        }
    }

    /// Interrupts the children, and ends those that go on.
    void stop()
    {
        for (const auto& [pid, task] : running_) ::kill(pid, SIGINT);
        const auto end = Clock::now() + kTimeToStop;
        while (count() > 0 && Clock::now() < end) {
            collect();
            std::this_thread::sleep_for(kNap);
        }
    }

  private:
    const TaskFolder& folder_;
    const TaskEnded& ended_;
    const std::string machine_ = describe_machine();
    std::map<pid_t, const Task*> running_;
};

}  // namespace

bool run_locally(const std::vector<Task>& tasks, const TaskFolder& folder, int jobs, const TaskEnded& ended)
{
    Children children(folder, ended);
    std::size_t next = 0;
    while (next < tasks.size() || children.count() > 0) {
        if (is_interrupted()) {
            children.stop();
            return false;
        }
        while (next < tasks.size() && children.count() < jobs) children.add(tasks[next++]);
        std::this_thread::sleep_for(kNap);
        children.collect();
    }
    return true;
}

}  // namespace arris
