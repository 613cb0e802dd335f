// SPDX-License-Identifier: GPL-3.0-or-later
// The files in the study's folder decide what runs next: tasks/NAME.task says what was submitted,
// tasks/NAME.job its array and index, and tasks/NAME.exit that it has ended. So a study goes on wherever it
// was interrupted.
#include "app/study/slurm_engine.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "app/files/atomic_file.h"
#include "app/run/interrupt.h"
#include "app/text/printable.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostArrayTasks = 1000;  // Slurm's default MaxArraySize is 1001
constexpr std::chrono::milliseconds kBetweenLooks{500};
constexpr int kLooksBetweenQueues = 10;  // squeue is asked every 5 s, files every 0.5 s
constexpr int kLooksAfterQueue = 20;     // for a shared file system to show a task's last file

struct CommandResult {
    int status = 0;
    std::string output;  ///< standard output and error
};

CommandResult run_command(const std::string& command)
{
    const auto close = [](FILE* pipe) { return pclose(pipe); };
    FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    if (pipe == nullptr) throw std::runtime_error("cannot start " + command);
    CommandResult result;
    std::array<char, 4096> buffer;
    while (const std::size_t size = std::fread(buffer.data(), 1, buffer.size(), pipe))
        result.output.append(buffer.data(), size);
    const int status = close(pipe);
    result.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return result;
}

std::string job_file(const TaskFolder& folder, const std::string& name)
{
    return folder.path() + "/tasks/" + name + ".job";
}

/// The array in which a task was submitted; empty if it was not.
std::string job_of(const TaskFolder& folder, const std::string& name)
{
    std::ifstream in(job_file(folder, name));
    std::string job;
    in >> job;
    return job;
}

/// The script of one task of an array. Its exit file appears whole, by a renaming.
std::string task_script(const Task& task, const TaskFolder& folder)
{
    std::string command;
    for (const std::string& word : task.command) command.append(shell_quote(word)).append(" ");
    const std::string end = shell_quote(folder.exit_file(task.name));
    return fmt::format(
        "#!/bin/sh\n# Written by arris study.\nexport OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1\n"
        "{}>{} 2>&1 </dev/null\nstatus=$?\n"
        "processor=$(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n 1)\n"
        "echo \"$status $(uname -n), $processor\" >{}.tmp && mv {}.tmp {}\n",
        command, shell_quote(folder.log_file(task.name)), end, end, end);
}

/// The batch script of an array: task N runs line N + 1 of the list.
std::string array_script(const std::string& list, std::size_t count, int jobs)
{
    return fmt::format(
        "#!/bin/sh\n#SBATCH --job-name=arris-study\n#SBATCH --array=0-{}{}\n#SBATCH --ntasks=1\n"
        "#SBATCH --cpus-per-task=1\n#SBATCH --output=/dev/null\n"
        "script=$(sed -n \"$((SLURM_ARRAY_TASK_ID + 1))p\" {})\nexec sh \"$script\"\n",
        count - 1, jobs > 0 ? fmt::format("%{}", jobs) : "", shell_quote(list));
}

/// Submits tasks as one array and notes its number with each task.
void submit_array(const std::vector<Task>& tasks, const TaskFolder& folder, int jobs)
{
    std::string list;
    for (const Task& task : tasks) {
        folder.note_start(task);
        const std::string script = folder.path() + "/tasks/" + task.name + ".sh";
        write_atomically(script, task_script(task, folder));
        list += script + "\n";
    }
    const std::string base = folder.path() + "/tasks/array-" + tasks.front().fingerprint;
    write_atomically(base + ".list", list);
    write_atomically(base + ".sh", array_script(base + ".list", tasks.size(), jobs));
    const CommandResult sbatch = run_command("sbatch --parsable " + shell_quote(base + ".sh"));
    std::string job = sbatch.output.substr(0, sbatch.output.find_first_of(";\n"));
    const bool is_number = !job.empty() && job.find_first_not_of("0123456789") == std::string::npos;
    if (sbatch.status != 0 || !is_number)
        throw std::runtime_error("sbatch: " + sbatch.output.substr(0, sbatch.output.find('\n')));
    for (const Task& task : tasks) write_atomically(job_file(folder, task.name), job + "\n");
    fmt::print("Slurm job {}: {} runs (scancel {} ends them)\n", job, tasks.size(), job);
    std::fflush(stdout);
}

/// Arrays of which some task is queued or running. Nothing where squeue fails, as while Slurm restarts.
std::optional<std::set<std::string>> list_queued_jobs()
{
    const CommandResult squeue = run_command("squeue --noheader --array --me --format=%F");
    if (squeue.status != 0) return std::nullopt;
    std::set<std::string> jobs;
    std::istringstream in(squeue.output);
    for (std::string job; in >> job;) jobs.insert(job);
    return jobs;
}

void submit_what_is_not_queued(const std::vector<Task>& tasks, const TaskFolder& folder, int jobs)
{
    const std::optional<std::set<std::string>> queued = list_queued_jobs();
    if (!queued) throw std::runtime_error("squeue: does not answer; is Slurm running?");
    std::vector<Task> open;
    for (const Task& task : tasks) {
        const std::string job = job_of(folder, task.name);
        const bool is_queued = queued->contains(job) && !folder.read_end(task.name);
        if (is_queued && !folder.is_started(task))
            throw InputError(
                fmt::format("{}: Slurm job {} still has this run with other settings or another "
                            "version; allowed: to wait, or scancel {}",
                            printable(task.name), job, job));
        if (!is_queued) open.push_back(task);
    }
    if (open.size() < tasks.size())
        fmt::print("{} runs are in Slurm's queue already\n", tasks.size() - open.size());
    for (std::size_t first = 0; first < open.size(); first += kMostArrayTasks) {
        const auto begin = open.begin() + static_cast<std::ptrdiff_t>(first);
        const auto end =
            open.begin() + static_cast<std::ptrdiff_t>(std::min(first + kMostArrayTasks, open.size()));
        submit_array({begin, end}, folder, jobs);
    }
}

/// Waits for tasks by the files that they leave.
class Waiting {
  public:
    Waiting(const std::vector<Task>& tasks, const TaskFolder& folder, const TaskEnded& ended)
        : folder_(folder), ended_(ended)
    {
        for (const Task& task : tasks) open_.push_back(&task);
    }

    bool is_over() const { return open_.empty(); }

    void look()
    {
        std::erase_if(open_, [this](const Task* task) {
            const std::optional<TaskEnd> end = folder_.read_end(task->name);
            if (end) ended_(*task, *end);
            return end.has_value();
        });
    }

    /// Gives up tasks whose array has left the queue, once their files have had the time to appear.
    void look_at_queue()
    {
        const std::optional<std::set<std::string>> queued = list_queued_jobs();
        if (!queued) return;
        const bool is_any_left = std::any_of(open_.begin(), open_.end(), [&](const Task* task) {
            return queued->contains(job_of(folder_, task->name));
        });
        looks_without_ = is_any_left ? 0 : looks_without_ + kLooksBetweenQueues;
        if (looks_without_ < kLooksAfterQueue) return;
        constexpr int kCancelled = 143;  // as after SIGTERM
        for (const Task* task : open_) {
            folder_.write_end(task->name, {kCancelled, "left Slurm's queue"});
            ended_(*task, {kCancelled, ""});
        }
        open_.clear();
    }

  private:
    const TaskFolder& folder_;
    const TaskEnded& ended_;
    std::vector<const Task*> open_;
    int looks_without_ = 0;
};

bool is_on_path(const std::string& program)
{
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (access((folder + "/" + program).c_str(), X_OK) == 0) return true;
    return false;
}

}  // namespace

void require_slurm()
{
    for (const char* program : {"sbatch", "squeue"})
        if (!is_on_path(program))
            throw InputError(
                fmt::format("--engine slurm: {} is not on the PATH; allowed: local, or a machine "
                            "with Slurm",
                            program));
}

bool run_with_slurm(const std::vector<Task>& tasks, const TaskFolder& folder, int jobs,
                    const TaskEnded& ended)
{
    submit_what_is_not_queued(tasks, folder, jobs);
    Waiting waiting(tasks, folder, ended);
    for (int look = 1; !waiting.is_over(); ++look) {
        if (is_interrupted()) {
            fmt::print("the runs go on in Slurm; the same command waits for them\n");
            return false;
        }
        std::this_thread::sleep_for(kBetweenLooks);
        waiting.look();
        if (look % kLooksBetweenQueues == 0 && !waiting.is_over()) waiting.look_at_queue();
    }
    return true;
}

}  // namespace arris
