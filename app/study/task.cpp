// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/task.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "app/files/atomic_file.h"
#include "app/text/printable.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

namespace fs = std::filesystem;

std::string read_text(const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::string task_text(const Task& task)
{
    std::string text = task.fingerprint + "\n";
    for (const std::string& word : task.command) text += shell_quote(word) + " ";
    return text + "\n";
}

/// `status` of report.json; empty if there is no valid report.
std::string reported_status(const std::string& run_directory)
{
    const auto report = nlohmann::json::parse(read_text(run_directory + "/report.json"), nullptr, false);
    if (!report.is_object() || !report.contains("status") || !report["status"].is_string()) return "";
    return report["status"].get<std::string>();
}

}  // namespace

std::string TaskFolder::run_directory(const std::string& name) const
{
    return directory_ + "/runs/" + name;
}
std::string TaskFolder::log_file(const std::string& name) const
{
    return directory_ + "/tasks/" + name + ".log";
}
std::string TaskFolder::exit_file(const std::string& name) const
{
    return directory_ + "/tasks/" + name + ".exit";
}
std::string TaskFolder::task_file(const std::string& name) const
{
    return directory_ + "/tasks/" + name + ".task";
}

void TaskFolder::create() const
{
    for (const char* folder : {"/runs", "/tasks"}) {
        std::error_code error;
        fs::create_directories(directory_ + folder, error);
        if (error)
            throw InputError(
                fmt::format("-o {}: cannot be created: {}", printable(directory_), error.message()));
    }
}

void TaskFolder::note_start(const Task& task) const
{
    fs::remove(exit_file(task.name));
    fs::remove(run_directory(task.name) + "/report.json");  // of an earlier run, whose status it would tell
    write_atomically(task_file(task.name), task_text(task));
}

bool TaskFolder::is_started(const Task& task) const
{
    return read_text(task_file(task.name)).starts_with(task.fingerprint + "\n");
}

void TaskFolder::write_end(const std::string& name, const TaskEnd& end) const
{
    write_atomically(exit_file(name), fmt::format("{} {}\n", end.exit_status, end.machine));
}

std::optional<TaskEnd> TaskFolder::read_end(const std::string& name) const
{
    std::ifstream in(exit_file(name));
    TaskEnd end;
    if (!(in >> end.exit_status)) return std::nullopt;
    std::getline(in >> std::ws, end.machine);
    return end;
}

bool TaskFolder::is_done(const Task& task) const
{
    const std::optional<TaskEnd> end = read_end(task.name);
    if (!end || !is_started(task)) return false;
    const std::string status = status_of(task.name, *end);
    return status != "interrupted" && status != "io_error" && status != "killed" && status != "crashed";
}

std::string TaskFolder::status_of(const std::string& name, const TaskEnd& end) const
{
    if (end.exit_status == 2) return "bad_input";
    if (end.exit_status > 128 && end.exit_status != 130) return "killed";
    const std::string status = reported_status(run_directory(name));
    const bool is_consistent = end.exit_status == 0     ? status == "finished"
                               : end.exit_status == 130 ? status == "interrupted"
                               : end.exit_status == 1   ? !status.empty() && status != "finished"
                                                        : false;
    return is_consistent ? status : "crashed";
}

std::string TaskFolder::last_line(const std::string& name) const
{
    std::ifstream in(log_file(name));
    std::string line, last;
    while (std::getline(in, line))
        if (!line.empty()) last = line;
    return last;
}

std::string describe_machine()
{
    std::array<char, 256> host{};
    if (gethostname(host.data(), host.size() - 1) != 0) host[0] = '?';
    std::ifstream cpu("/proc/cpuinfo");
    std::string line, model = "unknown processor";
    while (std::getline(cpu, line))
        if (line.starts_with("model name") && line.find(": ") != std::string::npos) {
            model = line.substr(line.find(": ") + 2);
            break;
        }
    return fmt::format("{}, {}", host.data(), model);
}

std::string shell_quote(const std::string& word)
{
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

}  // namespace arris
