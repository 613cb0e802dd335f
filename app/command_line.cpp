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

/// One line for arguments that cannot be, as for every other bad input.
int tell_parse_error(const CLI::App& app, const CLI::ParseError& error)
{
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::string line = error.what();
    const bool is_missing = error.get_name() == "RequiredError";
    if (is_missing && app.get_subcommands().empty()) {
        const std::vector<std::string> words = app.remaining();
        line = words.empty() ? "a command is missing" : words.front() + ": is no command";
        line += "; allowed: run, resume, check, export, docs";
    }
    if (is_missing && app.got_subcommand("docs")) line += "; allowed: scene, schema";
    for (char& c : line)
        if (c == '\n') c = ' ';
    fmt::print(stderr, "arris: {} (arris --help tells more)\n", printable(line));
    return 2;
}

}  // namespace

int run_command_line(int argc, char** argv)
{
    CLI::App app("Arris simulates cloth that slides over sharp edges without snagging.", "arris");
    app.set_version_flag("--version", std::string("arris ") + kVersion);
    app.require_subcommand(1);

    RunRequest run_request;
    CLI::App* run_command = app.add_subcommand("run", "Simulate a scene");
    run_command->add_option("scene", run_request.scene, "Scene file (TOML)")->required();
    run_command->add_option("-o,--output", run_request.directory,
                            "Folder for the results; default out/<scene>");
    run_command->add_flag("--overwrite", run_request.is_overwriting, "Replace the run that the folder holds");
    run_command
        ->add_option("--set", run_request.overrides, "Any dotted scene key, VALUE as TOML; once for each key")
        ->allow_extra_args(false)
        ->type_name("KEY=VALUE");
    run_command->add_option("--threads", run_request.threads, "Default: as many as the machine has")
        ->check(CLI::Range(1, 1024));
    run_command->add_flag("--quiet", run_request.is_quiet, "Say nothing but warnings and errors");

    ResumeRequest resume_request;
    double until = 0.0;
    CLI::App* resume_command = app.add_subcommand("resume", "Go on from a run's last checkpoint");
    resume_command->add_option("dir", resume_request.directory, "Folder of the run")->required();
    CLI::Option* until_option = resume_command->add_option("--until", until, "End at this time (s) instead");
    resume_command->add_option("--threads", resume_request.threads, "Default: as many as the machine has")
        ->check(CLI::Range(1, 1024));
    resume_command->add_flag("--quiet", resume_request.is_quiet, "Say nothing but warnings and errors");

    std::string check_scene;
    std::vector<std::string> check_overrides;
    CLI::App* check_command =
        app.add_subcommand("check", "Load a scene, say what it would simulate, write nothing");
    check_command->add_option("scene", check_scene, "Scene file (TOML)")->required();
    check_command->add_option("--set", check_overrides, "As for run")
        ->allow_extra_args(false)
        ->type_name("KEY=VALUE");

    std::string export_directory;
    std::vector<std::string> export_formats;
    CLI::App* export_command = app.add_subcommand("export", "Make further formats from a run's frames");
    export_command->add_option("dir", export_directory, "Folder of the run")->required();
    export_command->add_option("--formats", export_formats, "obj,usd,viewer")
        ->required()
        ->delimiter(',')
        ->type_name("FORMAT,...");

    std::string topic;
    CLI::App* docs_command = app.add_subcommand("docs", "Print the reference of scene keys");
    docs_command->add_option("topic", topic, "scene (Markdown) or schema (JSON schema for editors)")
        ->required()
        ->check(CLI::IsMember({"scene", "schema"}));

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return tell_parse_error(app, error);
    }

    if (*run_command) return exit_status(run(run_request));
    if (*resume_command) {
        if (*until_option) resume_request.until = until;
        return exit_status(resume(resume_request));
    }
    if (*check_command) {
        LoadOptions options;
        options.tells_intersections = true;
        const RunConfig config = load_scene(check_scene, check_overrides, options);
        for (const std::string& line : describe_scene(config)) fmt::print("{}\n", line);
        std::fflush(stdout);  // before what follows on standard error
        if (!config.intersections.empty()) throw InputError(config.intersections.front());
        return 0;
    }
    if (*export_command) {
        require_known_formats(export_formats);
        export_frames(export_directory, export_formats, read_export_options(export_directory));
        for (const std::string& format : export_formats)
            fmt::print("{:<7} {}\n", format, printable(exported_path(export_directory, format)));
        return 0;
    }
    fmt::print("{}", topic == "scene" ? scene_markdown() : scene_schema());
    return 0;
}

}  // namespace arris
