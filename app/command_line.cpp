// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <vector>

#include "app/check.h"
#include "app/export/export_frames.h"
#include "app/run/run.h"
#include "app/run/run_export_options.h"
#include "app/scene/scene_docs.h"
#include "app/study/study.h"
#include "app/text/printable.h"
#include "app/text/version.h"
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
        line += "; allowed: run, resume, check, study, export, docs";
    }
    if (is_missing && app.got_subcommand("docs")) line += "; allowed: scene, schema";
    for (char& c : line)
        if (c == '\n') c = ' ';
    fmt::print(stderr, "arris: {} (see arris --help)\n", printable(line));
    return 2;
}

struct CheckRequest {
    std::string scene;
    std::vector<std::string> overrides;
};

struct ExportRequest {
    std::string directory;
    std::vector<std::string> formats;
};

// Each adds a command, whose arguments are parsed into the request, and returns it.

CLI::App* add_run(CLI::App& app, RunRequest& request)
{
    CLI::App* command = app.add_subcommand("run", "Simulate a scene");
    command->add_option("scene", request.scene, "Scene file (TOML)")->required();
    command->add_option("-o,--output", request.directory, "Folder for the results; default out/<scene>");
    command->add_flag("--overwrite", request.is_overwriting, "Replace the run in the folder");
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
    CLI::App* command = app.add_subcommand("resume", "Continue a run from its last checkpoint");
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
    CLI::App* command =
        app.add_subcommand("check", "Load a scene and print what would be simulated; write nothing");
    command->add_option("scene", request.scene, "Scene file (TOML)")->required();
    command->add_option("--set", request.overrides, "As for run")
        ->allow_extra_args(false)
        ->type_name("KEY=VALUE");
    return command;
}

CLI::App* add_study(CLI::App& app, StudyRequest& request)
{
    CLI::App* command =
        app.add_subcommand("study", "Run a scene over a grid of settings: error against time");
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
    CLI::App* command = app.add_subcommand("export", "Export a run's frames to other formats");
    command->add_option("dir", request.directory, "Folder of the run")->required();
    command->add_option("--formats", request.formats, "obj,usd,viewer")
        ->required()
        ->delimiter(',')
        ->type_name("FORMAT,...");
    return command;
}

void add_docs(CLI::App& app, std::string& topic)
{
    CLI::App* command = app.add_subcommand("docs", "Print the reference of scene keys");
    command->add_option("topic", topic, "scene (Markdown) or schema (JSON schema for editors)")
        ->required()
        ->check(CLI::IsMember({"scene", "schema"}));
}

void tell_warnings(const std::vector<std::string>& warnings)
{
    for (const std::string& warning : warnings) fmt::print(stderr, "warning: {}\n", printable(warning));
}

int check(const CheckRequest& request)
{
    LoadOptions options;
    options.tells_intersections = true;
    const RunConfig config = load_scene(request.scene, request.overrides, options);
    for (const std::string& line : describe_scene(config)) fmt::print("{}\n", line);
    std::fflush(stdout);  // so that it precedes what follows on standard error
    tell_warnings(config.warnings);
    if (!config.intersections.empty()) throw InputError(config.intersections.front());
    return 0;
}

int export_formats(const ExportRequest& request)
{
    require_known_formats(request.formats);
    const ExportOptions options = read_export_options(request.directory);
    tell_warnings(warn_of_missing_files(request.directory));
    export_frames(request.directory, request.formats, options);
    for (const std::string& format : request.formats)
        fmt::print("{:<7} {}\n", format, printable(exported_path(request.directory, format)));
    return 0;
}

}  // namespace

int run_command_line(int argc, char** argv)
{
    CLI::App app("Arris simulates cloth that slides over sharp edges without snagging.", "arris");
    app.set_version_flag("--version", std::string("arris ") + kVersion);
    app.require_subcommand(1);

    RunRequest run_request;
    ResumeRequest resume_request;
    run_request.program = resume_request.program = argc > 0 ? argv[0] : "arris";
    CheckRequest check_request;
    StudyRequest study_request;
    ExportRequest export_request;
    std::string topic;
    const CLI::App* run_command = add_run(app, run_request);
    const CLI::App* resume_command = add_resume(app, resume_request);
    const CLI::App* check_command = add_check(app, check_request);
    const CLI::App* study_command = add_study(app, study_request);
    const CLI::App* export_command = add_export(app, export_request);
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
    fmt::print("{}", topic == "scene" ? scene_markdown() : scene_schema());
    return 0;
}

}  // namespace arris
