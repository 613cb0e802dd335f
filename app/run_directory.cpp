// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run_directory.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "app/frame_files.h"
#include "app/printable.h"
#include "geometry/input_error.h"

namespace arris {

namespace {

namespace fs = std::filesystem;

/// What a run leaves besides its frames' folder.
constexpr std::array kRunFiles = {"steps.csv",   "probes.csv", "report.json", "report.html",
                                  "viewer.html", "cloth.usda", "checkpoint"};

std::vector<std::string> probe_names(const RunConfig& config)
{
    std::vector<std::string> names;
    for (const Probe& probe : config.probes) names.push_back(probe.name);
    return names;
}

bool holds_run(const fs::path& dir)
{
    for (const char* name : kRunFiles)
        if (fs::exists(dir / name)) return true;
    return fs::exists(frames_directory(dir.string()));
}

/// Files of frames whose index is `first` or more, in every format and of every object.
void remove_frames(const std::string& dir, std::int64_t first)
{
    if (!fs::is_directory(frames_directory(dir))) return;
    for (const fs::directory_entry& entry : fs::directory_iterator(frames_directory(dir))) {
        const std::string stem = entry.path().stem().string();
        const std::size_t digits = stem.find_last_not_of("0123456789") + 1;
        if (digits == stem.size() || digits == 0 || stem[digits - 1] != '_' || stem.size() - digits > 12)
            continue;
        if (std::stoll(stem.substr(digits)) >= first) fs::remove(entry.path());
    }
}

void make_folders(const std::string& path)
{
    std::error_code error;
    fs::create_directories(frames_directory(path), error);
    if (error) throw InputError(fmt::format("-o {}: cannot be made: {}", printable(path), error.message()));
}

}  // namespace

std::string checkpoint_file(const std::string& run_dir)
{
    return (fs::path(run_dir) / "checkpoint").string();
}
std::string steps_file(const std::string& run_dir)
{
    return (fs::path(run_dir) / "steps.csv").string();
}
std::string probes_file(const std::string& run_dir)
{
    return (fs::path(run_dir) / "probes.csv").string();
}

RunDirectory::RunDirectory(std::string path, CsvWriter steps, CsvWriter probes)
    : path_(std::move(path)), steps_(std::move(steps)), probes_(std::move(probes))
{
}

RunDirectory RunDirectory::create(const std::string& path, bool is_overwriting, const RunConfig& config)
{
    if (fs::exists(path) && !fs::is_directory(path))
        throw InputError(fmt::format("-o {}: is not a folder", printable(path)));
    if (holds_run(path)) {
        if (!is_overwriting)
            throw InputError(fmt::format(
                "-o {}: holds a run already; --overwrite replaces it, another -o keeps it", printable(path)));
        for (const char* name : kRunFiles) fs::remove(fs::path(path) / name);
        remove_frames(path, 0);
    }
    make_folders(path);
    return {path, CsvWriter::create(steps_file(path), step_header()),
            CsvWriter::create(probes_file(path), probe_header(probe_names(config)))};
}

RunDirectory RunDirectory::reopen(const std::string& path, const Checkpoint& checkpoint,
                                  const RunConfig& config)
{
    truncate_csv(steps_file(path), checkpoint.rows);
    truncate_csv(probes_file(path), checkpoint.rows);
    remove_frames(path, checkpoint.frames);
    make_folders(path);
    return {path, CsvWriter::append_to(steps_file(path), step_header()),
            CsvWriter::append_to(probes_file(path), probe_header(probe_names(config)))};
}

void RunDirectory::write_frame(std::int64_t index, const Frame& frame)
{
    arris::write_frame(frame_file(path_, index, "ply"), frame);
}

void RunDirectory::write_checkpoint(const Checkpoint& checkpoint)
{
    arris::write_checkpoint(checkpoint_file(path_), checkpoint);
}

}  // namespace arris
