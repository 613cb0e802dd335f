// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run.h"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "app/check.h"
#include "app/error_line.h"
#include "app/export_frames.h"
#include "app/frame.h"
#include "app/frame_files.h"
#include "app/interrupt.h"
#include "app/printable.h"
#include "app/progress.h"
#include "app/report_html.h"
#include "app/run_config.h"
#include "app/run_directory.h"
#include "app/state_readings.h"
#include "app/timeline.h"
#include "app/version.h"
#include "geometry/input_error.h"
#include "geometry/mesh_quality.h"
#include "physics/inertia.h"
#include "solver/advance.h"
#include "solver/audit.h"
#include "solver/step.h"
#include "solver/step_mesh.h"
#include "solver/stopwatch.h"

namespace arris {

namespace {

/// How a run ended.
struct Ending {
    RunStatus status = RunStatus::Finished;
    std::string message;
};

/// A run under way: what the loop below works on.
struct Run {
    const RunConfig& config;
    const Timeline timeline;
    RunDirectory files;
    Checkpoint at;  ///< as it would be written now
    Workspace work;
    Audit audited;  ///< of the cloth as it is, where it is a frame
    double cpu_told = process_cpu_seconds();
    std::optional<StepReport> opening;  ///< of the step that is being made, not told yet

    Run(const RunConfig& config_, RunDirectory files_, Checkpoint at_)
        : config(config_), timeline(config_), files(std::move(files_)), at(std::move(at_))
    {
        prepare(config.scene, at.state, work);
    }
};

StepRow make_row(const Run& run, const StepReport& report)
{
    const State& state = run.at.state;
    const Scene& scene = run.config.scene;
    const ClothElements& elements = run.work.elements;
    const Energies energies = compute_energies(elements, run.work.terms, state.mesh.world);
    const CornerVelocities moving =
        compute_corner_velocities(elements, state.mesh.world, state.velocity, state.material_velocity);
    StepRow row;
    row.step = state.step;
    row.time = state.time;
    row.dt = report.dt;
    row.vertices = state.mesh.vertex_count();
    row.faces = state.mesh.face_count();
    row.contacts = report.contacts;
    row.kinetic_energy = kinetic_energy(scene.material.density, elements, moving);
    if (scene.gravity) row.gravity_energy = energies.gravity;
    row.stretch_energy = energies.stretch;
    if (scene.material.bending_stiffness > 0.0) row.bending_energy = energies.bending;
    if (!scene.obstacles.empty()) {
        row.feature_rows = report.feature_rows;
        if (scene.eol) {
            row.eol_vertices = report.eol_vertices;
            row.eol_pressing = report.eol_pressing;
            row.rows_by_cause = report.rows_by_cause;
        }
        row.rewound = report.rewound;
        row.yielded = report.yielded;
    }
    row.energy_rise = report.energy_rise;
    row.material_area = material_area(state.mesh);
    row.max_penetration = run.audited.found.depth;
    row.crossings = state.crossings;
    row.min_angle = least_material_angle(state.mesh);
    row.kkt_residual = report.kkt_residual;
    row.factorisations = report.factorisations;
    row.nlopt_evaluations = report.nlopt_evaluations;
    row.solves = report.solves;
    row.seconds = report.seconds;
    return row;
}

/// What a row tells of a step in two parts: where the second has led, and what both have cost and lost.
StepReport join(const StepReport& opening, StepReport rest)
{
    rest.dt += opening.dt;
    rest.energy_rise += opening.energy_rise;
    rest.kkt_residual = std::max(rest.kkt_residual, opening.kkt_residual);
    rest.yielded += opening.yielded;
    rest.rewound += opening.rewound;
    rest.add_cost(opening);
    return rest;
}

/// Frame, probes and row of the state as it is. The row comes last: where it is there, all of its step is.
void write_outputs(Run& run, const StepReport& report, Stopwatch& watch, bool is_halved)
{
    const State& state = run.at.state;
    prepare(run.config.scene, state, run.work);  // elements where material has flowed
    const bool is_audited = run.timeline.frame_at(state.time) >= 0 || state.time >= run.config.duration;
    run.audited = is_audited ? audit(run.config.scene, state) : Audit();
    StepRow row = make_row(run, report);
    row.is_halved = is_halved;
    if (const std::int64_t index = run.timeline.frame_at(state.time); index >= 0) {
        run.files.write_frame(
            index, make_frame(run.config.scene.obstacles, state, run.work.elements, run.work.terms));
        run.at.frames = index + 1;
    }
    run.files.append_probes(state.time, sample_probes(run.config.probes, state));
    row.seconds.output += watch.lap();
    const double cpu = process_cpu_seconds();
    row.cpu_seconds = cpu - run.cpu_told;
    run.cpu_told = cpu;
    run.files.append_step(row);
    ++run.at.rows;
}

/// A vertex by what a user can find it by; new ones of a step that was not taken by their number alone.
std::string name_vertex(const State& state, std::int64_t id)
{
    const auto at = std::lower_bound(state.ids.begin(), state.ids.end(), id);
    if (at == state.ids.end() || *at != id) return fmt::format("vertex {}", id);
    const auto v = static_cast<std::size_t>(at - state.ids.begin());
    const Vec3& x = state.mesh.world[v];
    const Vec2& X = state.mesh.material[v];
    return fmt::format("vertex {}, at [{:.6g}, {:.6g}, {:.6g}] (m, material [{:.6g}, {:.6g}]),", id, x.x(),
                       x.y(), x.z(), X.x(), X.y());
}

Ending explain(const StepReport& report, double tolerance, const State& state)
{
    const std::string place = fmt::format("in the step after t = {} s (step {})", state.time, state.step);
    switch (report.status) {
        case StepStatus::NotFinite:
            return {RunStatus::NotFinite,
                    fmt::format("a number that is not finite {}, also with 64 times smaller steps", place)};
        case StepStatus::Overrun:
            return {RunStatus::NotConverged,
                    fmt::format("material flows over a feature faster than the mesh can follow {}, also with "
                                "64 times smaller steps",
                                place)};
        case StepStatus::Infeasible:
            return {RunStatus::Infeasible,
                    fmt::format(
                        "nothing keeps {} out of the obstacles {}: a pin drives it into one, or two leave "
                        "it no room",
                        name_vertex(state, report.infeasible_vertex), place)};
        case StepStatus::Penetration:
            return {RunStatus::Penetration,
                    fmt::format("the cloth cannot be kept out of an obstacle {}, also with 64 times smaller "
                                "steps",
                                place)};
        default:
            if (!std::isfinite(report.kkt_residual))
                return {
                    RunStatus::NotConverged,
                    fmt::format("the velocity's system cannot be factorised {}: stiffness and mass are too "
                                "many orders of magnitude apart, also with 64 times smaller steps",
                                place)};
            return {
                RunStatus::NotConverged,
                fmt::format("the velocity solve reached a residual of {:.1e} where {:.1e} is asked {}, also "
                            "with 64 times smaller steps",
                            report.kkt_residual, tolerance, place)};
    }
}

/// What the steps' own check should have found.
Ending explain(const Audit& audited, const Scene& scene, const State& state)
{
    const Vec3& place = audited.found.place;
    return {
        RunStatus::Penetration,
        fmt::format("the cloth reaches {:.3g} m into {} at [{:.6g}, {:.6g}, {:.6g}], at t = {} s",
                    audited.found.depth, scene.obstacles[static_cast<std::size_t>(audited.obstacle)].name(),
                    place.x(), place.y(), place.z(), state.time)};
}

/// One planned step, to its end, with a row for each of its parts but an opening's.
std::optional<Ending> advance(Run& run)
{
    State& state = run.at.state;
    if (run.timeline.jumps_at(state.time)) restart(state);
    const auto accept = [&run](const StepReport& report, bool is_halved) {
        if (report.part == StepPart::Opening) {
            run.opening = report;
            return true;
        }
        Stopwatch watch;
        if (run.opening) --run.at.state.step;
        write_outputs(run, run.opening ? join(*run.opening, report) : report, watch, is_halved);
        run.opening.reset();
        return run.audited.obstacle < 0;
    };
    const double end = run.timeline.next_end(run.at.position);
    if (const std::optional<StepReport> failed =
            advance(run.config.scene, run.config.settings, end, state, run.work, accept)) {
        if (run.opening) {  // is all there is of its step
            Stopwatch watch;
            write_outputs(run, *std::exchange(run.opening, std::nullopt), watch, true);
        }
        return explain(*failed, run.config.settings.tolerance, state);
    }
    if (run.audited.obstacle >= 0) return explain(run.audited, run.config.scene, state);
    run.at.position = run.timeline.advance(run.at.position);
    return std::nullopt;
}

/// Steps until the end, an interrupt or a step that cannot be made. A checkpoint at each frame, every two
/// seconds of work and at the end.
Ending simulate(Run& run, bool is_quiet)
{
    Progress progress(run.at.state.time, run.config.duration, is_quiet);
    Ending ending;
    constexpr double kCheckpointSeconds = 2.0;
    Stopwatch watch;
    double unsaved = 0.0;
    while (!run.timeline.is_over(run.at.position)) {
        if (is_interrupted()) {
            ending = {RunStatus::Interrupted, fmt::format("stopped at t = {:.6g} s", run.at.state.time)};
            break;
        }
        if (const std::optional<Ending> failed = advance(run)) {
            ending = *failed;
            break;
        }
        unsaved += watch.lap();
        if (unsaved > kCheckpointSeconds || run.timeline.frame_at(run.at.state.time) >= 0) {
            run.files.write_checkpoint(run.at);
            unsaved = 0.0;
        }
        progress.update(run.at.state.time, fmt::format("{} vertices", run.at.state.mesh.vertex_count()));
    }
    progress.finish();
    run.files.write_checkpoint(run.at);
    return ending;
}

RunReport make_report(const Run& run, const Ending& ending, double export_seconds, int threads)
{
    RunReport report;
    report.status = ending.status;
    report.message = ending.message;
    report.totals = sum_steps(steps_file(run.files.path()));
    report.totals.phases.output += export_seconds;
    report.totals.wall_seconds += export_seconds;
    report.totals.cpu_seconds += process_cpu_seconds() - run.cpu_told;
    report.peak_memory_bytes = peak_memory_bytes();
    for (const SceneEffect& effect : list_effects(run.config))
        if (effect.is_on) report.effects.push_back(effect.name);
    report.warnings = run.config.warnings;
    report.scene = run.config.as_run;
    report.version = kVersion;
    report.threads = threads;
    return report;
}

/// What is made once, when the steps are over: formats of the frames, reports. A disk that refuses is told in
/// the report where that can still be written.
Ending write_results(const Run& run, Ending ending, int threads)
{
    const std::string& dir = run.files.path();
    Stopwatch watch;
    try {
        if (run.at.frames > 0 && !run.config.output.formats.empty())
            export_frames(dir, run.config.output.formats,
                          {run.config.title, run.config.output.frames_per_second});
    } catch (const std::runtime_error& error) {  // the disk, or frames that a format cannot hold
        ending = {RunStatus::IoError, error_line(error)};
    }
    const RunReport report = make_report(run, ending, watch.lap(), threads);
    write_report_json((std::filesystem::path(dir) / "report.json").string(), report);
    write_report_html(dir, report);
    return ending;
}

void tell_ending(const Run& run, const Ending& ending, bool is_quiet)
{
    const std::string dir = printable(run.files.path());
    if (ending.status != RunStatus::Finished)
        fmt::print(stderr, "arris: {}: {}\n", to_string(ending.status), printable(ending.message));
    if (is_quiet) return;
    if (run.at.frames > 0) fmt::print("frames  {}/frames ({})\n", dir, run.at.frames);
    if (std::filesystem::exists(std::filesystem::path(run.files.path()) / "viewer.html"))
        fmt::print("viewer  {}/viewer.html\n", dir);
    fmt::print("report  {}/report.html\n", dir);
    if (ending.status == RunStatus::Interrupted) fmt::print("go on   arris resume {}\n", dir);
}

/// From here on a run's end is told by its files, whatever it is.
RunStatus run_to_the_end(Run& run, bool is_quiet, int threads)
{
    watch_for_interrupt();
    Ending ending;
    try {
        ending = simulate(run, is_quiet);
    } catch (const std::exception& error) {  // the disk, or memory for a factor that does not fit
        ending = {RunStatus::IoError, error_line(error)};
    }
    ending = write_results(run, ending, threads);
    tell_ending(run, ending, is_quiet);
    return ending.status;
}

std::string default_directory(const std::string& scene)
{
    return (std::filesystem::path("out") / std::filesystem::path(scene).stem()).string();
}

void tell_warnings(const RunConfig& config)
{
    for (const std::string& warning : config.warnings)
        fmt::print(stderr, "warning: {}\n", printable(warning));
}

/// Of a run that is resumed and has no step left to make.
void tell_is_over(const Run& run)
{
    const std::string dir = printable(run.files.path());
    fmt::print("nothing to do: the run has come to its end, t = {} s\n", run.at.state.time);
    fmt::print("go on   arris resume {} --until T, T a later time in s\n", dir);
    fmt::print(
        "        (with the same frames a second; for others run the scene anew: arris run SCENE "
        "--set output.frames_per_second=N)\n");
}

/// A checkpoint is untrusted input: what it names must be in its scene.
void check_references(const std::string& directory, const State& state, const Scene& scene)
{
    const auto is_sound = [](std::int64_t index, std::size_t count) {
        return index >= 0 && index < static_cast<std::int64_t>(count);
    };
    const bool has_pins =
        std::all_of(state.anchors.begin(), state.anchors.end(),
                    [&](const PinAnchor& anchor) { return is_sound(anchor.pin, scene.pins.size()); });
    const auto is_there = [&](const ActiveContact& contact) {
        if (!is_sound(contact.obstacle, scene.obstacles.size())) return false;
        const Obstacle& obstacle = scene.obstacles[static_cast<std::size_t>(contact.obstacle)];
        switch (contact.kind) {
            case ContactKind::Vertex:
                return true;  // its element only serves to compare
            case ContactKind::Edge:
                return is_sound(contact.element, obstacle.topology().edges.size());
            case ContactKind::Triangle:
                return is_sound(contact.element, obstacle.mesh().points.size());
        }
        return false;
    };
    const auto is_on_feature = [&](const EolVertex& vertex) {
        if (!is_sound(vertex.obstacle, scene.obstacles.size())) return false;
        const ObstacleFeatures& features =
            scene.obstacles[static_cast<std::size_t>(vertex.obstacle)].features();
        return is_sound(vertex.feature, vertex.is_corner ? features.corners.size() : features.edges.size());
    };
    const bool has_obstacles = std::all_of(state.active.begin(), state.active.end(), is_there) &&
                               std::all_of(state.eol.begin(), state.eol.end(), is_on_feature);
    if (!has_pins || !has_obstacles)
        throw InputError(fmt::format("{}: is damaged: it names {} that its scene has not",
                                     printable(checkpoint_file(directory)),
                                     has_pins ? "parts of obstacles" : "pins"));
}

/// The cloth as the run began, which says how fine its mesh is to be. Without its frame the run's directory
/// is refused later.
ClothMesh read_first_cloth(const std::string& directory, const State& state)
{
    const std::string path = frame_file(directory, 0, "ply");
    if (!std::filesystem::exists(path)) return state.mesh;
    Frame first = read_frame(path);
    ClothMesh cloth{std::move(first.material), std::move(first.world), std::move(first.faces)};
    if (const std::string defect = validate(cloth); !defect.empty())
        throw InputError(fmt::format("{}: is damaged: {}", printable(path), defect));
    return cloth;
}

/// The scene of a checkpoint in `directory`, to end at `until` where that is given. What is left is planned
/// anew where the new end changes the interval that the run stands in.
RunConfig load_resumed(const std::string& directory, const std::optional<double>& until,
                       Checkpoint& checkpoint)
{
    const std::vector<ObstacleRecord> obstacles = read_obstacles(directory);
    const ClothMesh first = read_first_cloth(directory, checkpoint.state);
    LoadOptions options;
    options.cloth = &first;
    options.obstacles = &obstacles;
    options.obstacles_file = obstacles_file(directory);
    RunConfig config = load_scene(checkpoint.source, options);
    check_references(directory, checkpoint.state, config.scene);
    if (until) {
        if (!(*until > checkpoint.state.time) || !std::isfinite(*until))
            throw InputError(fmt::format("--until {}: not a time after t = {} s, where the run has come to",
                                         *until, checkpoint.state.time));
        const double begin = checkpoint.position.begin;
        const double planned_end = Timeline(config).interval_end(begin);
        checkpoint.source.overrides.push_back(fmt::format("duration={}", *until));
        config = load_scene(checkpoint.source, options);
        if (Timeline(config).interval_end(begin) != planned_end)
            checkpoint.position = {checkpoint.state.time, 0};
    }
    config.warnings = checkpoint.warnings;
    return config;
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
    const RunConfig config = load_scene(start.source);
    start.source.path =
        std::filesystem::absolute(start.source.path).string();  // resume may be called from elsewhere
    tell_warnings(config);
    const std::string directory =
        request.directory.empty() ? default_directory(request.scene) : request.directory;
    RunDirectory files = RunDirectory::create(directory, request.is_overwriting, config);

    start.warnings = config.warnings;
    start.state = make_state(config.scene, config.cloth, config.cloth_velocity);
    Run run(config, std::move(files), std::move(start));
    StepReport initial;
    initial.seconds.advance = watch.lap();  // loading
    write_outputs(run, initial, watch, false);
    run.files.write_checkpoint(run.at);
    return run_to_the_end(run, request.is_quiet, threads);
}

RunStatus resume(const ResumeRequest& request)
{
    const int threads = thread_count(request.threads);
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    require_run(request.directory);
    Checkpoint checkpoint = read_checkpoint(checkpoint_file(request.directory));
    const RunConfig config = load_resumed(request.directory, request.until, checkpoint);
    tell_warnings(config);
    RunDirectory files = RunDirectory::reopen(request.directory, checkpoint, config);
    Run run(config, std::move(files), std::move(checkpoint));
    if (run.timeline.is_over(run.at.position) && !request.is_quiet) tell_is_over(run);
    return run_to_the_end(run, request.is_quiet, threads);
}

}  // namespace arris
