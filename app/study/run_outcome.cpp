// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/run_outcome.h"

#include <algorithm>
#include <cassert>
#include <fstream>
#include <iterator>

#include "app/files/csv_table.h"
#include "app/report/report.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

using Json = nlohmann::json;

Json read_report(const std::string& run_directory)
{
    std::ifstream in(run_directory + "/report.json", std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    return Json::parse(text, nullptr, false);
}

void read_totals(const Json& report, RunOutcome& outcome)
{
    outcome.steps = report.value("steps", std::int64_t{0});
    outcome.max_penetration = report.value("max_penetration", 0.0);
    outcome.crossings = report.value("crossings", std::int64_t{0});
    if (outcome.message.empty() && !outcome.is_finished()) outcome.message = report.value("message", "");
}

// Row 0 has the time of loading, which is no part of a step.
void read_phases(const std::string& run_directory, RunOutcome& outcome)
{
    const CsvTable steps = read_csv(run_directory + "/steps.csv");
    if (steps.row_count() == 0) return;
    outcome.vertices = steps.column("vertices").back();
    for (const std::string& phase : phase_names()) {
        const std::vector<double>& seconds = steps.column(phase + "_s");
        double sum = 0.0;
        for (std::size_t i = 1; i < seconds.size(); ++i) sum += seconds[i];
        outcome.phase_seconds.push_back(sum);
    }
}

void read_task(const std::string& name, const TaskFolder& folder, RunOutcome& outcome)
{
    const std::optional<TaskEnd> end = folder.read_end(name);
    const std::string status = end ? folder.status_of(name, *end) : "not_run";
    const bool is_first = outcome.status.empty();
    if (is_first || (outcome.is_finished() && status != "finished")) {
        outcome.status = status;
        outcome.message = status == "finished" ? "" : folder.last_line(name);
    }
    if (!end) return;
    if (std::find(outcome.machines.begin(), outcome.machines.end(), end->machine) == outcome.machines.end())
        outcome.machines.push_back(end->machine);
    if (status == "bad_input" || status == "crashed" || status == "killed") return;
    const Json report = read_report(folder.run_directory(name));
    if (!report.is_object()) return;
    outcome.cpu_seconds.push_back(report.value("cpu_seconds", 0.0));
    outcome.wall_seconds.push_back(report.value("wall_seconds", 0.0));
    outcome.peak_memory_bytes =
        std::max(outcome.peak_memory_bytes, report.value("peak_memory_bytes", std::int64_t{0}));
    if (!is_first) return;
    read_totals(report, outcome);
    read_phases(folder.run_directory(name), outcome);
}

bool is_finer(const RunOutcome& a, const RunOutcome& b)
{
    const Fineness of_a = fineness_of(a.run), of_b = fineness_of(b.run);
    const double cells_a = of_a.cells > 0 ? of_a.cells : a.vertices,
                 cells_b = of_b.cells > 0 ? of_b.cells : b.vertices;
    if (cells_a > cells_b || cells_a < cells_b) return cells_a > cells_b;
    return of_a.least_step < of_b.least_step;
}

/// The run that `outcome` is compared with, or null: the further run, or the finest finished run.
RunOutcome* find_reference(const ErrorRule& rule, std::vector<RunOutcome>& outcomes,
                           const RunOutcome& outcome)
{
    RunOutcome* best = nullptr;
    for (RunOutcome& other : outcomes) {
        if (other.run.problem != outcome.run.problem || !other.is_finished()) continue;
        if (rule.reference == ErrorRule::Reference::Run ? other.run.is_further
                                                        : !best || is_finer(other, *best))
            best = &other;
    }
    return best;
}

void measure_one(const ErrorRule& rule, const TaskFolder& folder, std::vector<RunOutcome>& outcomes,
                 RunOutcome& outcome)
{
    const bool needs_run =
        rule.reference == ErrorRule::Reference::Finest || rule.reference == ErrorRule::Reference::Run;
    RunOutcome* reference = needs_run ? find_reference(rule, outcomes, outcome) : nullptr;
    try {
        if (needs_run && !reference) throw InputError("the reference run has not finished");
        if (reference) reference->is_reference = true;
        outcome.error = measure_error(rule, folder.run_directory(outcome.run.name),
                                      reference ? folder.run_directory(reference->run.name) : "");
    } catch (const InputError& error) {
        outcome.status = "no_error";
        outcome.message = error.what();
    }
}

}  // namespace

double median(std::vector<double> values)
{
    assert(!values.empty() && "a median of nothing");
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::optional<double> RunOutcome::cpu_median() const
{
    if (cpu_seconds.empty()) return std::nullopt;
    return median(cpu_seconds);
}

std::vector<std::string> phase_names()
{
    std::vector<std::string> names;
    for (const NamedSeconds& phase : list_phases({})) names.emplace_back(phase.name);
    return names;
}

std::vector<std::string> task_names(const std::string& run, int repeats)
{
    std::vector<std::string> names = {run};
    for (int i = 2; i <= repeats; ++i) names.push_back(run + ".repeat" + std::to_string(i));
    return names;
}

std::vector<RunOutcome> collect_outcomes(const std::vector<StudyRun>& runs, int repeats,
                                         const TaskFolder& folder)
{
    std::vector<RunOutcome> outcomes;
    for (const StudyRun& run : runs) {
        RunOutcome outcome;
        outcome.run = run;
        for (const std::string& name : task_names(run.name, repeats)) read_task(name, folder, outcome);
        outcomes.push_back(std::move(outcome));
    }
    return outcomes;
}

void measure_errors(const ErrorRule& rule, const TaskFolder& folder, std::vector<RunOutcome>& outcomes)
{
    std::vector<RunOutcome*> finished;
    for (RunOutcome& outcome : outcomes)
        if (outcome.is_finished()) finished.push_back(&outcome);
    for (RunOutcome* outcome : finished) measure_one(rule, folder, outcomes, *outcome);
}

}  // namespace arris
