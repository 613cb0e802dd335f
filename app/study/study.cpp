// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <thread>
#include <utility>

#include "app/files/atomic_file.h"
#include "app/run/interrupt.h"
#include "app/run/run_directory.h"
#include "app/study/analysis.h"
#include "app/study/local_engine.h"
#include "app/study/slurm_engine.h"
#include "app/study/study_files.h"
#include "app/study/study_panels.h"
#include "app/study/study_tasks.h"
#include "app/text/build.h"
#include "app/text/printable.h"
#include "app/text/version.h"

namespace arris {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStopping = "\narris: stopping; the same command goes on with the study\n";

/// Prints one line for each task that ends.
class StudyProgress {
  public:
    StudyProgress(const TaskFolder& folder, std::size_t count, bool is_quiet)
        : folder_(folder), count_(count), is_quiet_(is_quiet)
    {
    }

    void tell(const Task& task, const TaskEnd& end)
    {
        ++ended_;
        const std::string status = folder_.status_of(task.name, end);
        const bool is_failure = status != "finished";
        if (is_quiet_ && !is_failure) return;
        fmt::print("{:>4}/{}  {:<13} {}\n", ended_, count_, status, printable(task.name));
        if (is_failure) fmt::print("           {}\n", printable(folder_.last_line(task.name)));
        std::fflush(stdout);
    }

  private:
    const TaskFolder& folder_;
    std::size_t count_, ended_ = 0;
    bool is_quiet_;
};

/// Runs what is not done yet. Returns whether everything has ended.
bool run_tasks(const StudyRequest& request, const std::vector<Task>& tasks, const TaskFolder& folder)
{
    std::vector<Task> open;
    for (const Task& task : tasks)
        if (request.is_overwriting || !folder.is_done(task)) open.push_back(task);
    if (!request.is_quiet && open.size() < tasks.size())
        fmt::print("{} of {} runs are done already\n", tasks.size() - open.size(), tasks.size());
    if (open.empty()) return true;
    StudyProgress progress(folder, open.size(), request.is_quiet);
    const TaskEnded ended = [&](const Task& task, const TaskEnd& end) { progress.tell(task, end); };
    if (request.engine == StudyEngine::Slurm) return run_with_slurm(open, folder, request.jobs, ended);
    const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    return run_locally(open, folder, request.jobs > 0 ? request.jobs : cores, ended);
}

StudyProvenance describe_provenance(const StudyRequest& request, const std::vector<RunOutcome>& outcomes)
{
    StudyProvenance provenance;
    provenance.version = describe_version();
    provenance.build = kBuild;
    provenance.engine = request.engine == StudyEngine::Slurm ? "a Slurm job array"
                        : request.jobs > 0                   ? fmt::format("{} at a time", request.jobs)
                                                             : "as many at a time as the machine has cores";
    for (const RunOutcome& outcome : outcomes)
        for (const std::string& machine : outcome.machines)
            if (std::find(provenance.machines.begin(), provenance.machines.end(), machine) ==
                provenance.machines.end())
                provenance.machines.push_back(machine);
    return provenance;
}

void write_results(const StudyRequest& request, const Study& study, const std::vector<RunOutcome>& outcomes,
                   const std::string& directory)
{
    const StudyProvenance provenance = describe_provenance(request, outcomes);
    const std::string svg = draw_study(study, outcomes);
    constexpr int kIndent = 2;
    const auto replace = nlohmann::ordered_json::error_handler_t::replace;
    write_atomically(directory + "/study.csv", study_csv(study, outcomes));
    write_atomically(directory + "/study.json",
                     study_json(study, outcomes, provenance).dump(kIndent, ' ', false, replace) + "\n");
    write_atomically(directory + "/study.svg", svg);
    write_atomically(directory + "/study.html", study_html(study, outcomes, provenance, svg));
}

int tell_results(const StudyRequest& request, const Study& study, const std::vector<RunOutcome>& outcomes,
                 const std::string& directory)
{
    const auto finished = std::count_if(outcomes.begin(), outcomes.end(),
                                        [](const RunOutcome& outcome) { return outcome.is_finished(); });
    for (const RunOutcome& outcome : outcomes)
        if (!outcome.is_finished())
            fmt::print(stderr, "arris: {}: {}: {}\n", printable(outcome.run.name), outcome.status,
                       printable(outcome.message));
    if (!request.is_quiet) {
        fmt::print("{} of {} runs finished\n", finished, outcomes.size());
        fmt::print("{}\n", printable(tell_cheapest(study, outcomes)));
        for (const char* file : {"study.html", "study.svg", "study.csv", "study.json"})
            fmt::print("{:<8}{}/{}\n", fs::path(file).extension().string().substr(1), printable(directory),
                       file);
    }
    return finished > 0 ? 0 : 1;
}

}  // namespace

int run_study(const StudyRequest& request)
{
    const Study study = read_study(request.study, request.is_quick);
    const std::vector<StudyRun> runs = list_runs(study);
    const std::string directory = request.directory.empty()
                                      ? (fs::path("out") / fs::path(request.study).stem()).string()
                                      : request.directory;
    const TaskFolder folder(fs::absolute(directory).lexically_normal().string());
    folder.create();
    const FolderLock lock(folder.path());
    if (request.engine == StudyEngine::Slurm) require_slurm();

    watch_for_interrupt(kStopping);
    if (!run_tasks(request, make_tasks(study, runs, folder), folder)) return 130;
    std::vector<RunOutcome> outcomes = collect_outcomes(runs, study.repeats, folder);
    if (study.error) measure_errors(*study.error, folder, outcomes);
    write_results(request, study, outcomes, directory);
    return tell_results(request, study, outcomes, directory);
}

}  // namespace arris
