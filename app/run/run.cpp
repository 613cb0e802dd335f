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
#include "app/files/frame.h"
#include "app/files/frame_files.h"
#include "app/report/report_html.h"
#include "app/run/interrupt.h"
#include "app/run/progress.h"
#include "app/run/resumed_scene.h"
#include "app/run/run_directory.h"
#include "app/run/run_ending.h"
#include "app/run/run_warnings.h"
#include "app/run/state_readings.h"
#include "app/run/step_row.h"
#include "app/run/timeline.h"
#include "app/scene/mesh_forecast.h"
#include "app/scene/parts/run_config.h"
#include "app/scene/parts/scene_effects.h"
#include "app/scene/scene_load.h"
#include "app/text/error_line.h"
#include "app/text/printable.h"
#include "app/text/shell_word.h"
#include "app/text/version.h"
#include "geometry/input_error.h"
#include "solver/advance.h"
#include "solver/cloth_strain.h"
#include "solver/contact/audit.h"
#include "solver/mesh_change/step_mesh.h"
#include "solver/model/stopwatch.h"
#include "solver/step.h"
#include "solver/velocity_solve/blas_kernel.h"

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

/// The state of a run in progress.
struct Run {
    const RunConfig& config;
    const Timeline timeline;
    RunDirectory files;
    Checkpoint at;  ///< the current checkpoint
    Workspace work;
    Audit audited;          ///< of the current cloth, if the time is that of a frame or the end
    SelfCrossings crossed;  ///< likewise
    double cpu_told = process_cpu_seconds();
    Stopwatch since_row;                ///< wall time since the last row
    double cut_off_seconds = 0.0;       ///< of the last step, if it was cut off or failed, and so has no row
    std::optional<StepReport> opening;  ///< first part of the current step, not yet written as a row

    Run(const RunConfig& config_, RunDirectory files_, Checkpoint at_)
        : config(config_), timeline(config_), files(std::move(files_)), at(std::move(at_))
    {
        prepare(config.scene, at.state, work);
    }
};

/// Writes frame, probes and row of the current state. The row is last, so that a row implies the other two.
void write_outputs(Run& run, const StepReport& report, Stopwatch& watch, bool is_halved)
{
    const State& state = run.at.state;
    prepare(run.config.scene, state, run.work);  // rebuilds elements where material has flowed
    const bool is_audited = run.timeline.frame_at(state.time) >= 0 || state.time >= run.config.duration;
    run.audited = is_audited ? audit(run.config.scene, state) : Audit();
    run.crossed = is_audited ? find_self_crossings(run.config.scene, state.mesh) : SelfCrossings();
    run.at.state.crossings += run.crossed.count;
    StepRow row = make_step_row(run.config, state, run.work, run.audited, report);
    row.step = run.at.rows;
    row.is_halved = is_halved;
    MeshCache& mesh = run.work.mesh;
    const ClothStrain strain = measure_cloth_strain(run.config.scene.materials, find_stretches(state, mesh),
                                                    state.mesh, mesh.stars.faces);
    row.max_strain = strain.greatest();
    note_strain(state, strain, run.at.strain);
    note_friction(report, state.time, run.at.friction);
    if (const std::int64_t index = run.timeline.frame_at(state.time); index >= 0) {
        Frame frame =
            make_frame(run.config.scene.obstacles, state, run.work.mesh.elements, run.work.mesh.terms);
        const std::vector<ClothPiece>& pieces = run.config.pieces;
        if (pieces.size() > 1) frame.pieces.assign(pieces.begin(), pieces.end());
        run.files.write_frame(index, frame);
        run.at.frames = index + 1;
    }
    run.files.append_probes(state.time, sample_probes(run.config.probes, state));
    row.seconds.output += watch.lap();
    const double cpu = process_cpu_seconds();
    row.cpu_seconds = cpu - run.cpu_told;
    run.cpu_told = cpu;
    run.files.append_step(row);
    ++run.at.rows;
    run.since_row.lap();
}

/// Makes one planned step and writes a row for each part; an opening has no row of its own. Throws
/// Interrupted.
std::optional<RunEnding> make_planned_step(Run& run)
{
    State& state = run.at.state;
    if (run.timeline.jumps_at(state.time)) restart(state);
    const auto accept = [&run](const StepReport& report, bool is_halved) {
        if (report.part == StepPart::Opening) {
            run.opening = report;
            return true;
        }
        Stopwatch watch;
        write_outputs(run, run.opening ? join_parts(*run.opening, report) : report, watch, is_halved);
        run.opening.reset();
        return run.audited.obstacle < 0 && run.crossed.count == 0;
    };
    const double end = run.timeline.next_end(run.at.position);
    Settings settings = run.config.settings;
    settings.is_interrupted = is_interrupted;
    if (const std::optional<StepReport> failed =
            advance(run.config.scene, settings, end, state, run.work, accept)) {
        if (run.opening) {  // the rest of this step has failed
            Stopwatch watch;
            write_outputs(run, *std::exchange(run.opening, std::nullopt), watch, true);
        }
        return explain_ending(*failed, run.config.settings.tolerance, run.config.scene, state);
    }
    if (run.audited.obstacle >= 0) return explain_ending(run.audited, run.config.scene, state);
    if (run.crossed.count > 0) return explain_ending(run.crossed, state);
    run.at.position = run.timeline.next(run.at.position);
    return std::nullopt;
}

/// Steps until the end, an interrupt or a failed step. Writes a checkpoint at each frame, after every two
/// seconds of work and at the end.
RunEnding simulate(Run& run, bool is_quiet)
{
    Progress progress(run.at.state.time, run.config.duration, is_quiet);
    RunEnding ending;
    constexpr double kCheckpointSeconds = 2.0;
    Stopwatch watch;
    double unsaved = 0.0;
    while (!run.timeline.is_over(run.at.position)) {
        if (is_interrupted()) {
            ending = {RunStatus::Interrupted, fmt::format("stopped at t = {:.6g} s", run.at.state.time)};
            break;
        }
        RunProgress before = run.at;
        try {
            if (const std::optional<RunEnding> failed = make_planned_step(run)) {
                ending = *failed;
                break;
            }
        } catch (const Interrupted&) {  // a resumed run makes the whole planned step again
            static_cast<RunProgress&>(run.at) = std::move(before);
            run.opening.reset();
            continue;
        }
        unsaved += watch.lap();
        if (unsaved > kCheckpointSeconds || run.timeline.frame_at(run.at.state.time) >= 0) {
            run.files.write_checkpoint(run.at);
            unsaved = 0.0;
        }
        progress.update(run.at.state.time, fmt::format("{} vertices", run.at.state.mesh.vertex_count()));
    }
    progress.finish();
    if (ending.status != RunStatus::Finished) run.cut_off_seconds = run.since_row.lap();
    run.files.write_checkpoint(run.at);
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
    summary.warnings = warn_at_end(run.config, run.at, status, summary.totals);
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
    report.effects = list_effects(run.config);
    report.warnings = run.config.warnings;
    report.warnings.insert(report.warnings.end(), summary.warnings.begin(), summary.warnings.end());
    report.scene = run.config.as_run;
    report.version = kVersion;
    report.threads = threads;
    report.kernel = run.at.kernel;
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
        if (run.at.frames > 0 && !run.config.output.formats.empty())
            export_frames(dir, run.config.output.formats,
                          {run.config.title, run.config.output.frames_per_second});
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
    if (run.at.frames > 0) fmt::print("frames  {}/frames ({})\n", dir, run.at.frames);
    if (std::filesystem::exists(std::filesystem::path(run.files.path()) / "viewer.html"))
        fmt::print("viewer  {}/viewer.html\n", dir);
    fmt::print("report  {}/report.html\n", dir);
    if (ending.status == RunStatus::Interrupted)
        fmt::print("resume  {}\n", resume_command(asked.program, run.files.path()));
}

/// Runs and writes the results. From here on every ending, errors included, is recorded in the run's files.
RunStatus run_to_the_end(Run& run, const Asked& asked)
{
    watch_for_interrupt(kStopping);
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
    fmt::print("nothing to do: the run has reached its end, t = {} s\n", run.at.state.time);
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

}  // namespace

RunStatus run(const RunRequest& request)
{
    const int threads = thread_count(request.threads);
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    Stopwatch watch;
    Checkpoint start;
    start.source = read_scene_source(request.scene, request.overrides);
    if (const std::optional<std::string> line = forecast_long_meshing(start.source);
        line && !request.is_quiet) {
        fmt::print("{}\n", *line);
        std::fflush(stdout);
    }
    const RunConfig config = load_scene(start.source);
    start.source.path =
        std::filesystem::absolute(start.source.path).string();  // resume may run in another working directory
    tell_warnings(config.warnings);
    const std::string directory =
        request.directory.empty() ? default_directory(request.scene) : request.directory;
    RunDirectory files = RunDirectory::create({directory, request.is_overwriting, request.program}, config);

    start.warnings = config.warnings;
    start.kernel = blas_kernel();
    start.pieces = config.pieces;
    start.state = make_state(config.scene, config.cloth, config.cloth_velocity);
    Run run(config, std::move(files), std::move(start));
    StepReport initial;
    initial.seconds.advance = watch.lap();  // time of loading
    write_outputs(run, initial, watch, false);
    run.files.write_checkpoint(run.at);
    return run_to_the_end(run, {request.program, request.is_quiet, threads});
}

RunStatus resume(const ResumeRequest& request)
{
    const int threads = thread_count(request.threads);
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    require_run(request.directory);
    Checkpoint checkpoint = read_checkpoint(checkpoint_file(request.directory));
    const RunConfig config = load_resumed(request.directory, request.until, checkpoint);
    tell_warnings(config.warnings);
    RunDirectory files = RunDirectory::reopen(request.directory, checkpoint, config);
    Run run(config, std::move(files), std::move(checkpoint));
    if (run.timeline.is_over(run.at.position) && !request.is_quiet) tell_is_over(run, request.program);
    return run_to_the_end(run, {request.program, request.is_quiet, threads});
}

}  // namespace arris
