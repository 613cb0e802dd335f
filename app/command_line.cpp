// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "app/check.h"
#include "app/command_pages.h"
#include "app/crossings.h"
#include "app/export/export_frames.h"
#include "app/run/run.h"
#include "app/run/run_export_options.h"
#include "app/scene/mesh_forecast.h"
#include "app/scene/scene_docs.h"
#include "app/scene/scene_load.h"
#include "app/step_docs.h"
#include "app/study/study.h"
#include "app/text/printable.h"
#include "app/text/version.h"
#include "app/view.h"
#include "geometry/input_error.h"

namespace arris {

namespace {

int exit_status(RunStatus status)
{
    switch (status) {
        case RunStatus::Finished:
            return 0;
        case RunStatus::Interrupted:
            return 130;
        default:
            return 1;
    }
}

/// Prints one line for invalid arguments, as for every other invalid input.
int tell_parse_error(const CLI::App& app, const CLI::ParseError& error)
{
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::string line = error.what();
    const bool is_missing = error.get_name() == "RequiredError";
    if (is_missing && app.get_subcommands().empty()) {
        const std::vector<std::string> words = app.remaining();
        line = words.empty() ? "a command is missing" : words.front() + ": is not a command";
        line += "; allowed: " + list_commands(app);
    }
    if (is_missing && app.got_subcommand("docs")) line += "; allowed: scene, schema, step, man, bash";
    for (char& c : line)
        if (c == '\n') c = ' ';
    fmt::print(stderr, "arris: {} (see arris --help)\n", printable(line));
    return 2;
}

struct CheckRequest {
    std::string scene;
    std::vector<std::string> overrides;
    std::optional<std::string> crossings;  ///< path of a file to write
};

struct ExportRequest {
    std::string directory;
    std::vector<std::string> formats;
    std::string topology = "simulated";
    std::string grid;
    std::string up = "z";
    bool is_overwriting = false;
};

constexpr const char* kExitStatus =
    "Exit status: 0 done; 1 the run stopped before its end and says why; 2 invalid input; 130 interrupted, "
    "continue with arris resume.";

/// A command whose --help and entry in the manual end with an example.
CLI::App* add_command(CLI::App& app, const char* name, const char* summary, const char* example)
{
    CLI::App* command = app.add_subcommand(name, summary);
    command->footer(std::string("Example:\n  ") + example);
    return command;
}

// Each adds a command, whose arguments are parsed into the request, and returns it.

CLI::App* add_run(CLI::App& app, RunRequest& request)
{
    CLI::App* command = add_command(app, "run", "Simulate a scene",
                                    "arris run data/scenes/slipping.toml -o out/fine --set time.step=0.002");
    command->add_option("scene", request.scene, "Scene file (TOML)")->required();
    command->add_option("-o,--output", request.directory, "Folder for the results; default out/<scene>");
    command->add_flag("--overwrite", request.is_overwriting, "Replace the run in the folder");
    command->add_flag("--assemble-only", request.is_assembly_alone,
                      "Sew the cloth's panels together and stop: assembly/cloth.obj in the folder");
    command->add_option("--set", request.overrides, "Set a dotted scene key; VALUE is TOML; may be repeated")
        ->allow_extra_args(false)
        ->type_name("KEY=VALUE");
    command->add_option("--threads", request.threads, "Number of threads; default: all that the machine has")
        ->check(CLI::Range(1, 1024));
    command->add_flag("--quiet", request.is_quiet, "Print only warnings and errors");
    return command;
}

CLI::App* add_resume(CLI::App& app, ResumeRequest& request)
{
    CLI::App* command = add_command(app, "resume", "Continue a run from its last checkpoint",
                                    "arris resume out/fine --until 3");
    command->add_option("dir", request.directory, "Folder of the run")->required();
    command->add_option_function<double>(
        "--until", [&request](double time) { request.until = time; },
        "End at this time (s) instead of the scene's duration");
    command->add_option("--threads", request.threads, "Number of threads; default: all that the machine has")
        ->check(CLI::Range(1, 1024));
    command->add_flag("--quiet", request.is_quiet, "Print only warnings and errors");
    return command;
}

CLI::App* add_check(CLI::App& app, CheckRequest& request)
{
    CLI::App* command = add_command(app, "check", "Load a scene and print what would be simulated",
                                    "arris check data/scenes/slipping.toml");
    command->add_option("scene", request.scene, "Scene file (TOML)")->required();
    command->add_option("--set", request.overrides, "As for run")
        ->allow_extra_args(false)
        ->type_name("KEY=VALUE");
    command
        ->add_option(
            "--crossings", request.crossings,
            "Write the faces that cross at time 0, if any: .html is a page that shows them, else OBJ")
        ->type_name("FILE");
    return command;
}

CLI::App* add_study(CLI::App& app, StudyRequest& request)
{
    CLI::App* command = add_command(app, "study", "Run a scene over a grid of settings: error against time",
                                    "arris study data/studies/tablecloth.toml --quick");
    command->add_option("study", request.study, "Study file (TOML)")->required();
    command->add_option("-o,--output", request.directory, "Folder for the results; default out/<study>");
    command->add_option("--jobs", request.jobs, "Runs at a time, each with one thread; default: one a core")
        ->check(CLI::Range(1, 1024));
    command
        ->add_option_function<std::string>(
            "--engine",
            [&request](const std::string& name) {
                request.engine = name == "slurm" ? StudyEngine::Slurm : StudyEngine::Local;
            },
            "local, or slurm: a Slurm job array")
        ->check(CLI::IsMember({"local", "slurm"}));
    command->add_flag("--quick", request.is_quick, "The study's coarse variant, its table quick");
    command->add_flag("--overwrite", request.is_overwriting, "Run again what has finished");
    command->add_flag("--quiet", request.is_quiet, "Print only failed runs and errors");
    return command;
}

CLI::App* add_export(CLI::App& app, ExportRequest& request)
{
    CLI::App* command = add_command(app, "export", "Export a run's frames to other formats",
                                    "arris export out/fine --formats usd,obj");
    command->add_option("dir", request.directory, "Folder of the run")->required();
    command->add_option("--formats", request.formats, "obj,usd,viewer,vtk,pc2,mdd,gltf")
        ->required()
        ->delimiter(',')
        ->type_name("FORMAT,...");
    command
        ->add_option("--topology", request.topology,
                     "simulated: the mesh of each frame; constant: one mesh, for every format but viewer")
        ->check(CLI::IsMember({"simulated", "constant"}));
    command
        ->add_option("--grid", request.grid,
                     "Cells of the constant mesh of a rectangular cloth; default: the first frame's mesh")
        ->type_name("NxM");
    command->add_option("--up", request.up, "Upward axis of obj, vtk, pc2 and mdd; the others state theirs")
        ->check(CLI::IsMember({"y", "z"}));
    command->add_flag("--overwrite", request.is_overwriting,
                      "Replace files by those of another topology, grid or axis");
    return command;
}

CLI::App* add_view(CLI::App& app, std::string& directory)
{
    CLI::App* command =
        add_command(app, "view", "Make a run's viewer.html if need be, and open it", "arris view out/fine");
    command->add_option("dir", directory, "Folder of the run")->required();
    return command;
}

void add_docs(CLI::App& app, std::string& topic)
{
    CLI::App* command = add_command(app, "docs", "Print a reference or a completion script",
                                    "arris docs bash > ~/.local/share/bash-completion/completions/arris");
    command
        ->add_option("topic", topic,
                     "scene (keys, Markdown), schema (JSON schema for editors), step (rules of a step, "
                     "Markdown), man (manual page), bash (completion)")
        ->required()
        ->check(CLI::IsMember({"scene", "schema", "step", "man", "bash"}));
}

void tell_warnings(const std::vector<std::string>& warnings)
{
    for (const std::string& warning : warnings) fmt::print(stderr, "warning: {}\n", printable(warning));
}

int check(const CheckRequest& request)
{
    LoadOptions options;
    options.tells_intersections = true;
    const SceneSource source = read_scene_source(request.scene, request.overrides);
    if (const std::optional<std::string> line = forecast_long_meshing(source)) {
        fmt::print("{}\n", *line);
        std::fflush(stdout);
    }
    const RunConfig config = load_scene(source, options);
    for (const std::string& line : describe_scene(config)) fmt::print("{}\n", line);
    std::fflush(stdout);  // so that it precedes what follows on standard error
    tell_warnings(config.warnings);
    if (request.crossings) {
        write_crossings(*request.crossings, config);
        fmt::print("crossings  {}\n", printable(*request.crossings));
        std::fflush(stdout);
    }
    if (!config.intersections.empty()) throw InputError(config.intersections.front());
    return 0;
}

int export_formats(const ExportRequest& request)
{
    require_known_formats(request.formats);
    ExportOptions options = read_export_options(request.directory);
    options.is_topology_constant = request.topology == "constant";
    if (!request.grid.empty()) options.grid = parse_grid(request.grid);
    if (request.up == "y") options.up = UpAxis::Y;
    options.is_overwriting = request.is_overwriting;
    tell_warnings(warn_of_missing_files(request.directory));
    export_frames(request.directory, request.formats, options);
    for (const std::string& format : request.formats)
        fmt::print("{:<7} {}{}\n", format, printable(exported_path(request.directory, format)),
                   format == "obj" ? ", and those of each obstacle" : "");
    return 0;
}

int print_docs(const CLI::App& app, const std::string& topic)
{
    fmt::print("{}", topic == "scene"    ? scene_markdown()
                     : topic == "schema" ? scene_schema()
                     : topic == "step"   ? step_markdown()
                     : topic == "man"    ? man_page(app, kVersion)
                                         : bash_completion(app));
    return 0;
}

}  // namespace

int run_command_line(int argc, char** argv)
{
    CLI::App app("Arris simulates cloth that slides over sharp edges without snagging.", "arris");
    app.set_version_flag("--version", std::string("arris ") + kVersion);
    app.require_subcommand(1);
    app.footer(kExitStatus);

    RunRequest run_request;
    ResumeRequest resume_request;
    run_request.program = resume_request.program = argc > 0 ? argv[0] : "arris";
    CheckRequest check_request;
    StudyRequest study_request;
    ExportRequest export_request;
    std::string viewed, topic;
    const CLI::App* run_command = add_run(app, run_request);
    const CLI::App* resume_command = add_resume(app, resume_request);
    const CLI::App* check_command = add_check(app, check_request);
    const CLI::App* study_command = add_study(app, study_request);
    const CLI::App* export_command = add_export(app, export_request);
    const CLI::App* view_command = add_view(app, viewed);
    add_docs(app, topic);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return tell_parse_error(app, error);
    }

    if (*run_command) return exit_status(run(run_request));
    if (*resume_command) return exit_status(resume(resume_request));
    if (*check_command) return check(check_request);
    if (*study_command) return run_study(study_request);
    if (*export_command) return export_formats(export_request);
    if (*view_command) {
        view(viewed);
        return 0;
    }
    return print_docs(app, topic);
}

}  // namespace arris
