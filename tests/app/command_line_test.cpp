// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/command_line.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/app/program.h"

namespace arris {
namespace {

constexpr const char* kScene = "duration = 0.02\n[cloth]\nsize = [1, 1]\nresolution = [2, 2]\n[gravity]\n";

TEST(CommandLine, BadArgumentsAreOneLineAndStatusTwo)
{
    const TemporaryDirectory folder;
    const std::string scene = folder / "scene.toml";
    write_bytes(scene, kScene);
    const std::vector<std::vector<std::string>> wrong = {
        {},
        {"fly"},
        {"run"},
        {"run", scene, "--fast"},
        {"run", scene, scene},
        {"run", folder / "missing.toml"},
        {"run", scene, "--threads", "0"},
        {"run", scene, "--threads", "many"},
        {"run", scene, "--set"},
        {"run", scene, "--set", "time.stap=0.1"},
        {"run", scene, "-o", scene},
        {"run", scene, "-o", "/proc/none/here"},
        {"check", folder.path()},
        {"resume", folder.path()},
        {"resume", folder / "none"},
        {"export", folder.path(), "--formats", "obj"},
        {"export", folder.path(), "--formats", "stl"},
        {"view", folder.path()},
        {"docs"},
        {"docs", "everything"},
    };
    for (const std::vector<std::string>& arguments : wrong) {
        std::string call;
        for (const std::string& argument : arguments) call += " " + argument;
        Program program(folder, arguments);
        EXPECT_EQ(program.wait(), 2) << call;
        const std::string err = program.err();
        EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << call << ": " << err;
        EXPECT_EQ(err.rfind("arris: ", 0), 0u) << call << ": " << err;
        EXPECT_EQ(program.out(), "") << call;
    }
}

TEST(CommandLine, WhatIsNoCommandIsToldWithWhatWouldBeOne)
{
    const TemporaryDirectory folder;
    const auto line_of = [&](const std::vector<std::string>& arguments) {
        Program program(folder, arguments);
        program.wait();
        return program.err();
    };
    const std::string kAllowed =
        "; allowed: run, resume, check, study, export, view, docs (see arris --help)\n";
    EXPECT_EQ(line_of({}), "arris: a command is missing" + kAllowed);
    EXPECT_EQ(line_of({"fly", "high"}), "arris: fly: is not a command" + kAllowed);
    EXPECT_EQ(line_of({"docs"}),
              "arris: topic is required; allowed: scene, schema, step, man, bash (see arris --help)\n");
}

TEST(CommandLine, WhatIsNoRunIsToldWithWhatWouldBeOne)
{
    const TemporaryDirectory folder;
    const std::string empty = folder / "empty", file = folder / "file", loop = folder / "loop",
                      full = folder / "full", scene = folder / "scene.toml",
                      name = folder / std::string(300, 'a');
    write_bytes(scene, kScene);
    write_bytes(file, "");
    std::filesystem::create_directories(empty);
    std::filesystem::create_directories(full + "/report.json/in_it");
    std::filesystem::create_directory_symlink(loop, loop);
    const std::string kAllowed = "; allowed: a folder that arris run has written\n";
    const auto line_of = [&](const std::vector<std::string>& arguments) {
        Program program(folder, arguments);
        EXPECT_EQ(program.wait(), 2) << program.err();
        return program.err();
    };
    for (const std::vector<std::string>& rest :
         std::vector<std::vector<std::string>>{{"resume"}, {"export", "--formats", "obj"}}) {
        const auto line = [&](const std::string& directory) {
            std::vector<std::string> arguments = rest;
            arguments.insert(arguments.begin() + 1, directory);
            return line_of(arguments);
        };
        EXPECT_EQ(line(empty),
                  "arris: " + empty + ": holds no run (no checkpoint, steps.csv or report.json)" + kAllowed);
        EXPECT_EQ(line(file), "arris: " + file + ": is not a folder" + kAllowed);
        EXPECT_EQ(line(folder / "none"),
                  "arris: " + (folder / "none") + ": No such file or directory" + kAllowed);
        EXPECT_EQ(line(loop), "arris: " + loop + ": Too many levels of symbolic links" + kAllowed);
        EXPECT_NE(line(name).find(": File name too long" + kAllowed), std::string::npos);
    }
    EXPECT_EQ(
        line_of({"export", full, "--formats", "obj"}),
        "arris: " + full + "/report.json: does not exist or cannot be read; allowed: the report of a run\n");
    EXPECT_EQ(line_of({"resume", full}),
              "arris: " + full +
                  "/checkpoint: there is no checkpoint to resume from; arris run starts the run again\n");
    EXPECT_EQ(line_of({"run", scene, "-o", name}),
              "arris: -o " + name + ": cannot be created: File name too long\n");
    std::filesystem::create_directories(folder / "kept/viewer.html/in_it");
    write_bytes(folder / "kept/steps.csv", "");
    EXPECT_EQ(
        line_of({"run", scene, "-o", folder / "kept", "--overwrite"}),
        "arris: -o " + (folder / "kept") + ": file viewer.html cannot be replaced: Directory not empty\n");
}

TEST(CommandLine, HelpAndVersionAreNoErrors)
{
    const TemporaryDirectory folder;
    for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
             {"--help"}, {"--version"}, {"run", "--help"}, {"docs", "scene"}}) {
        Program program(folder, arguments);
        EXPECT_EQ(program.wait(), 0);
        EXPECT_GT(program.out().size(), 5u);
        EXPECT_EQ(program.err(), "");
    }
}

TEST(CommandLine, CheckWritesNothing)
{
    const TemporaryDirectory folder;
    write_bytes(folder / "scene.toml", kScene);
    Program program(folder, {"check", folder / "scene.toml"});
    EXPECT_EQ(program.wait(), 0) << program.err();
    EXPECT_NE(program.out().find("1 x 1 m"), std::string::npos) << program.out();
    EXPECT_EQ(folder.entry_count(), 3u) << "the scene and the two files of this test";
}

TEST(CommandLine, OutputThatIsNoTerminalHasNoProgressBar)
{
    const TemporaryDirectory folder;
    write_bytes(folder / "scene.toml", kScene);
    Program program(folder, {"run", folder / "scene.toml", "-o", folder / "run"});
    EXPECT_EQ(program.wait(), 0) << program.err();
    EXPECT_EQ(program.out().find('\r'), std::string::npos);
    EXPECT_EQ(program.out().find('\x1b'), std::string::npos);
    Program quiet(folder, {"run", folder / "scene.toml", "-o", folder / "run", "--overwrite", "--quiet"});
    EXPECT_EQ(quiet.wait(), 0);
    EXPECT_EQ(quiet.out(), "");
}

TEST(CommandLine, ControlCharactersOfFilesAreEscaped)
{
    const TemporaryDirectory folder;
    write_bytes(folder / "scene.toml", std::string("title = \"a\\u001b[31mred\"\n") + kScene);
    Program program(folder, {"check", folder / "scene.toml"});
    EXPECT_EQ(program.wait(), 0) << program.err();
    EXPECT_EQ(program.out().find('\x1b'), std::string::npos);
}

TEST(CommandLine, ExportMakesWhatTheRunDidNot)
{
    const TemporaryDirectory folder;
    write_bytes(folder / "scene.toml", kScene);
    Program program(folder, {"run", folder / "scene.toml", "-o", folder / "run", "--quiet"});
    EXPECT_EQ(program.wait(), 0) << program.err();
    EXPECT_FALSE(std::filesystem::exists(folder / "run/cloth.usda"));
    Program exported(folder, {"export", folder / "run", "--formats", "usd,obj"});
    EXPECT_EQ(exported.wait(), 0) << exported.err();
    EXPECT_TRUE(std::filesystem::exists(folder / "run/cloth.usda"));
    EXPECT_TRUE(std::filesystem::exists(folder / "run/frames/cloth_00000.obj"));
}

}  // namespace
}  // namespace arris
