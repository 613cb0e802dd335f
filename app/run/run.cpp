// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/run.h"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "app/export/export_frames.h"
#include "app/export/export_obj.h"
#include "app/files/frame_files.h"
#include "app/report/report_html.h"
#include "app/run/interrupt.h"
#include "app/run/progress.h"
#include "app/run/resumed_scene.h"
#include "app/run/run_directory.h"
#include "app/run/run_ending.h"
#include "app/run/run_warnings.h"
#include "app/run/simulation.h"
#include "app/scene/mesh_forecast.h"
#include "app/scene/parts/assembly.h"
#include "app/scene/parts/obstacle_records.h"
#include "app/scene/parts/run_config.h"
#include "app/scene/parts/scene_effects.h"
#include "app/scene/scene_load.h"
#include "app/text/error_line.h"
#include "app/text/printable.h"
#include "app/text/shell_word.h"
#include "app/text/version.h"
#include "geometry/input_error.h"
#include "solver/model/stopwatch.h"
#include "solver/sewing/closing.h"

namespace arris {

namespace {

constexpr const char* kStopping =
    "\narris: stopping; a second Ctrl-C stops at once (arris resume continues in both cases)\n";
/// What a command line asks for besides the scene.
struct Asked {
    const std::string& program;
    bool is_quiet;
    int threads;
};

/// A run in progress: a simulation, and the files that it leaves.
struct Run {
    Simulation simulation;
    RunDirectory files;
    double cpu_told = process_cpu_seconds();
    double cut_off_seconds = 0.0;  ///< of the last step, if it was cut off or failed, and so has no row

    const RunConfig& config() const { return simulation.config(); }
    const Checkpoint& at() const { return simulation.at(); }
};

/// Writes frame, probes and row of the current state. The row is last, so that a row implies the other two.
void write_outputs(Run& run, StepRow& row)
{
    Stopwatch watch;
    const Simulation& simulation = run.simulation;
    const double time = simulation.state().time;
    if (const std::int64_t index = simulation.timeline().frame_at(time); index >= 0)
        run.files.write_frame(index, simulation.frame());
    run.files.append_probes(time, simulation.probes());
    row.seconds.output += watch.lap();
    const double cpu = process_cpu_seconds();
    row.cpu_seconds = cpu - run.cpu_told;
    run.cpu_told = cpu;
    run.files.append_step(row);
}

/// "3281 vertices"; while seams close "14 of 18 seams closed".
std::string progress_detail(const Simulation& simulation)
{
    const Scene& scene = simulation.config().scene;
    const State& state = simulation.state();
    if (!simulation.config().is_assembly) return fmt::format("{} vertices", state.mesh.vertex_count());
    const std::size_t all = scene.sewing->seams.size(), open = find_open_seams(scene, state).size();
    return fmt::format("{} of {} seams closed", all - open, all);
}

/// Steps until the end, an interrupt or a failed step. Writes a checkpoint at each frame, after every two
/// seconds of work and at the end.
RunEnding simulate(Run& run, bool is_quiet)
{
    Simulation& simulation = run.simulation;
    const State& state = simulation.state();
    Progress progress(state.time, is_quiet);
    RunEnding ending = simulation.find_unsewn().value_or(RunEnding{});
    constexpr double kCheckpointSeconds = 2.0;
    Stopwatch watch;
    double unsaved = 0.0;
    while (!simulation.is_over()) {
        if (const std::optional<RunEnding> stop =
                simulation.step([&](StepRow& row) { write_outputs(run, row); })) {
            ending = *stop;
            break;
        }
        unsaved += watch.lap();
        if (unsaved > kCheckpointSeconds || simulation.timeline().frame_at(state.time) >= 0) {
            run.files.write_checkpoint(simulation.at());
            unsaved = 0.0;
        }
        progress.update(state.time, simulation.expected_end(), progress_detail(simulation));
    }
    progress.finish();
    if (ending.status != RunStatus::Finished) run.cut_off_seconds = simulation.seconds_since_row();
    run.files.write_checkpoint(simulation.at());
    return ending;
}

/// What the rows of a run sum to, and the warnings of its end.
struct RunSummary {
    StepTotals totals;
    std::vector<std::string> warnings;
};

RunSummary summarise(const Run& run, RunStatus status)
{
    RunSummary summary;
    summary.totals = sum_steps(steps_file(run.files.path()));
    summary.warnings = warn_at_end(run.config(), run.at(), status);
    return summary;
}

RunReport make_report(const Run& run, const RunEnding& ending, const RunSummary& summary,
                      double export_seconds, int threads)
{
    RunReport report;
    report.status = ending.status;
    report.message = ending.message;
    report.totals = summary.totals;
    report.totals.phases.output += export_seconds;
    report.totals.phases.advance += run.cut_off_seconds;
    report.totals.wall_seconds += export_seconds + run.cut_off_seconds;
    report.totals.cpu_seconds += process_cpu_seconds() - run.cpu_told;
    report.peak_memory_bytes = peak_memory_bytes();
    report.effects = list_effects(run.config());
    report.warnings = run.config().warnings;
    report.warnings.insert(report.warnings.end(), summary.warnings.begin(), summary.warnings.end());
    report.scene = run.config().as_run;
    report.version = kVersion;
    report.threads = threads;
    report.kernel = run.at().kernel;
    report.processor = processor_name();
    return report;
}

/// Writes exported formats and reports after the last step. A write error is reported in report.json if that
/// can still be written.
RunEnding write_results(const Run& run, RunEnding ending, const RunSummary& summary, int threads)
{
    const std::string& dir = run.files.path();
    Stopwatch watch;
    try {
        if (run.at().frames > 0 && !run.config().output.formats.empty())
            export_frames(dir, run.config().output.formats,
                          {run.config().title, run.config().output.frames_per_second});
    } catch (const std::runtime_error& error) {  // write error, or frames that a format cannot represent
        ending = {RunStatus::IoError, error_line(error)};
    }
    const RunReport report = make_report(run, ending, summary, watch.lap(), threads);
    write_report_json((std::filesystem::path(dir) / "report.json").string(), report);
    write_report_html(dir, report);
    return ending;
}

void tell_warnings(const std::vector<std::string>& warnings)
{
    for (const std::string& warning : warnings) fmt::print(stderr, "warning: {}\n", printable(warning));
}

void tell_ending(const Run& run, const RunEnding& ending, const Asked& asked)
{
    const std::string dir = printable(run.files.path());
    if (ending.status != RunStatus::Finished)
        fmt::print(stderr, "arris: {}: {}\n", to_string(ending.status), printable(ending.message));
    if (asked.is_quiet) return;
    if (run.at().frames > 0) fmt::print("frames  {}/frames ({})\n", dir, run.at().frames);
    if (std::filesystem::exists(std::filesystem::path(run.files.path()) / "viewer.html"))
        fmt::print("viewer  {}/viewer.html\n", dir);
    fmt::print("report  {}/report.html\n", dir);
    if (ending.status == RunStatus::Interrupted)
        fmt::print("resume  {}\n",
                   resume_command(asked.program, run.config().is_assembly ? worn_directory(run.files.path())
                                                                          : run.files.path()));
}

/// Runs and writes the results. From here on every ending, errors included, is recorded in the run's files.
RunStatus run_to_the_end(Run& run, const Asked& asked)
{
    watch_for_interrupt(kStopping);
    run.simulation.watch(is_interrupted);
    RunEnding ending;
    try {
        ending = simulate(run, asked.is_quiet);
    } catch (const std::exception& error) {  // write error, or too little memory for a factorisation
        ending = {RunStatus::IoError, error_line(error)};
    }
    const RunSummary summary = summarise(run, ending.status);
    tell_warnings(summary.warnings);
    ending = write_results(run, ending, summary, asked.threads);
    tell_ending(run, ending, asked);
    return ending.status;
}

std::string default_directory(const std::string& scene)
{
    return (std::filesystem::path("out") / std::filesystem::path(scene).stem()).string();
}

/// Says that a resumed run has no step left.
void tell_is_over(const Run& run, const std::string& program)
{
    fmt::print("nothing to do: the run has reached its end, t = {} s\n", run.at().state.time);
    fmt::print("resume  {} --until T, with T a later time in s\n", resume_command(program, run.files.path()));
    fmt::print(
        "        (at the same frame rate; another rate needs a new run: {} run SCENE --set "
        "output.frames_per_second=N)\n",
        shell_word(program));
}

int thread_count(int asked)
{
    return asked > 0 ? asked : tbb::info::default_concurrency();
}

/// Starts a scene whose cloth is made, and runs it to the end. `seconds`: of loading.
RunStatus start(RunConfig config, SceneSource source, RunDirectory files, double seconds, const Asked& asked)
{
    Checkpoint at = start_checkpoint(config, std::move(source));
    Run run{Simulation(std::move(config), std::move(at)), std::move(files)};
    run.simulation.tell_start(seconds, [&](StepRow& row) { write_outputs(run, row); });
    run.files.write_checkpoint(run.at());
    return run_to_the_end(run, asked);
}

/// Closes the seams of a scene, or goes on with that, and then runs it.
RunStatus sew_and_run(const RunConfig& unsewn, Run assembly, RunDirectory files, bool is_assembly_alone,
                      const Asked& asked)
{
    const std::string dir = assembly.files.path();
    const RunStatus status = run_to_the_end(assembly, asked);
    const bool is_kept = status == RunStatus::Unsewn && keeps_unsewn(unsewn);
    if (status != RunStatus::Finished && !is_kept) {  // so that the run's own folder tells how it ended
        std::filesystem::copy_file(std::filesystem::path(dir) / "report.json",
                                   std::filesystem::path(files.path()) / "report.json",
                                   std::filesystem::copy_options::overwrite_existing);
        return status;
    }
    const std::string obj = assembly_cloth_file(files.path());
    Frame cloth = assembly.simulation.frame();
    cloth.pieces.clear();  // with panels side by side in the UVs, as a cloth's file needs them
    write_obj(obj, cloth, UpAxis::Z);
    if (!asked.is_quiet) fmt::print("{}    {}\n", is_kept ? "open" : "sewn", printable(obj));
    if (is_assembly_alone) {
        if (!asked.is_quiet) fmt::print("resume  {}\n", resume_command(asked.program, files.path()));
        return status;
    }
    if (is_kept)
        fmt::print(stderr, "warning: cloth.assembly.unsewn is \"keep\": these seams stay as they are\n");
    Stopwatch watch;
    const SceneSource source = assembly.at().source;
    RunConfig config = load_sewn(source, assembly.at(), unsewn);
    return start(std::move(config), source, std::move(files), watch.lap(), asked);
}

/// Goes on with a run that was stopped while its seams were closing, or between that and its first step.
RunStatus resume_assembly(const ResumeRequest& request, const Asked& asked)
{
    const std::string dir = assembly_directory(request.directory);
    const std::vector<ObstacleRecord> obstacles = read_obstacles(request.directory);
    Checkpoint checkpoint = read_checkpoint(checkpoint_file(dir));
    if (request.until) set_end(*request.until, 0.0, checkpoint.source);
    const RunConfig unsewn = load_stored(dir, checkpoint, obstacles);
    RunConfig config = make_assembly(unsewn, checkpoint.assembly_duration);
    check_references(checkpoint_file(dir), checkpoint, config.scene);
    RunDirectory files = RunDirectory::begin_again(request.directory, unsewn);
    RunDirectory own = RunDirectory::reopen(dir, checkpoint, config);
    Run assembly{Simulation(std::move(config), std::move(checkpoint)), std::move(own)};
    return sew_and_run(unsewn, std::move(assembly), std::move(files), false, asked);
}

}  // namespace

RunStatus run(const RunRequest& request)
{
    const int threads = thread_count(request.threads);
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    Stopwatch watch;
    SceneSource source = read_scene_source(request.scene, request.overrides);
    if (const std::optional<std::string> line = forecast_long_meshing(source); line && !request.is_quiet) {
        fmt::print("{}\n", *line);
        std::fflush(stdout);
    }
    RunConfig config = load_scene(source);
    source.path =
        std::filesystem::absolute(source.path).string();  // resume may run in another working directory
    tell_warnings(config.warnings);
    const std::string directory =
        request.directory.empty() ? default_directory(request.scene) : request.directory;
    const bool is_open = needs_assembly(config);
    if (request.is_assembly_alone && !is_open)
        throw InputError(
            fmt::format("--assemble-only: {} has no seams that are open", printable(request.scene)));
    RunDirectory files = RunDirectory::create({directory, request.is_overwriting, request.program}, config);
    const Asked asked = {request.program, request.is_quiet, threads};
    if (!is_open) return start(std::move(config), std::move(source), std::move(files), watch.lap(), asked);
    RunConfig sewing = make_assembly(config);
    Checkpoint at = start_checkpoint(sewing, std::move(source));
    RunDirectory own = RunDirectory::create(
        {assembly_directory(directory), request.is_overwriting, request.program}, sewing);
    Run assembly{Simulation(std::move(sewing), std::move(at)), std::move(own)};
    assembly.simulation.tell_start(watch.lap(), [&](StepRow& row) { write_outputs(assembly, row); });
    assembly.files.write_checkpoint(assembly.at());
    return sew_and_run(config, std::move(assembly), std::move(files), request.is_assembly_alone, asked);
}

RunStatus resume(const ResumeRequest& request)
{
    const int threads = thread_count(request.threads);
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    require_run(request.directory);
    const Asked asked = {request.program, request.is_quiet, threads};
    if (!std::filesystem::exists(checkpoint_file(request.directory)) &&
        std::filesystem::exists(checkpoint_file(assembly_directory(request.directory))))
        return resume_assembly(request, asked);
    Checkpoint checkpoint = read_checkpoint(checkpoint_file(request.directory));
    if (checkpoint.assembly_duration > 0.0)
        throw InputError(fmt::format("{}: is the sewing of a run's cloth; allowed: {}",
                                     printable(request.directory),
                                     resume_command(request.program, worn_directory(request.directory))));
    RunConfig config = load_resumed(request.directory, request.until, checkpoint);
    tell_warnings(config.warnings);
    RunDirectory files = RunDirectory::reopen(request.directory, checkpoint, config);
    Run run{Simulation(std::move(config), std::move(checkpoint)), std::move(files)};
    if (run.simulation.is_over() && !request.is_quiet) tell_is_over(run, request.program);
    return run_to_the_end(run, asked);
}

}  // namespace arris
