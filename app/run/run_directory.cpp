// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/run_directory.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "app/files/frame_files.h"
#include "app/report/report.h"
#include "app/scene/parts/obstacle_records.h"
#include "app/scene/scene_load.h"
#include "app/text/printable.h"
#include "app/text/shell_word.h"
#include "geometry/input_error.h"

namespace arris {

namespace {

namespace fs = std::filesystem;

/// Files of a run besides the folder of frames.
constexpr std::array kRunFiles = {"steps.csv",  "probes.csv", "report.json", "report.html", "viewer.html",
                                  "cloth.usda", "cloth.pvd",  "checkpoint",  "obstacles"};

/// Names of the files of a run in `dir`, besides the folder of frames. Inaccessible ones are left out.
std::vector<std::string> find_run_files(const std::string& dir)
{
    std::vector<std::string> names;
    std::error_code error;
    for (const char* name : kRunFiles)
        if (fs::exists(fs::path(dir) / name, error)) names.emplace_back(name);
    for (fs::directory_iterator entry(dir, error), end; !error && entry != end; entry.increment(error))
        if (const std::string name = entry->path().filename().string(); is_poses_file(name))
            names.push_back(name);
    return names;
}

std::vector<std::string> probe_names(const RunConfig& config)
{
    std::vector<std::string> names;
    for (const Probe& probe : config.probes) names.push_back(probe.name);
    return names;
}

bool holds_run(const std::string& dir)
{
    std::error_code error;  // an inaccessible file is reported where it is used
    return fs::exists(checkpoint_file(dir), error) || fs::exists(steps_file(dir), error);
}

/// Object and index of a frame's file: "table" and 7 for table_00007.obj.
struct FrameName {
    std::string_view subject;
    std::int64_t index;
};

std::optional<FrameName> parse_frame_name(std::string_view name)
{
    const std::size_t digits = name.find_last_of('_') + 1;  // 0 for npos
    std::int64_t index = -1;
    const char* end = name.data() + name.size();
    const auto [rest, error] = std::from_chars(name.data() + digits, end, index);
    const std::string_view extension(rest, static_cast<std::size_t>(end - rest));
    const bool is_frame = extension == ".ply" || extension == ".obj" || extension == ".vtp" ||
                          extension == ".ply.tmp" || extension == ".obj.tmp" || extension == ".vtp.tmp";
    if (digits == 0 || error != std::errc() || !is_frame) return std::nullopt;
    return FrameName{name.substr(0, digits - 1), index};
}

/// Removes files of frames with an index of at least `first`, in every format, of the cloth and of
/// `obstacles`. Other files belong to the user and stay.
void remove_frames(const std::string& dir, std::int64_t first, const std::set<std::string>& obstacles)
{
    if (!fs::is_directory(frames_directory(dir))) return;
    for (const fs::directory_entry& entry : fs::directory_iterator(frames_directory(dir))) {
        const std::string file = entry.path().filename().string();
        const std::optional<FrameName> name = parse_frame_name(file);
        if (!name || name->index < first) continue;
        if (name->subject == "cloth" || obstacles.contains(std::string(name->subject)))
            fs::remove(entry.path());
    }
}

/// Names of the obstacles of the run in `dir`; empty if the file is unreadable.
std::set<std::string> stored_names(const std::string& dir)
{
    std::set<std::string> names;
    try {
        for (const ObstacleRecord& record : read_obstacles(dir)) names.insert(record.name);
    } catch (const InputError&) {  // the run is about to be removed, so its errors do not matter
    }
    return names;
}

/// Removes the files of an earlier run, with those of its assembly, and no others.
void remove_run(const std::string& dir)
{
    std::error_code no_error;  // a file that stays is replaced later, or is in the way then
    if (const std::string assembly = assembly_directory(dir); fs::is_directory(assembly, no_error)) {
        remove_run(assembly);
        fs::remove(assembly_cloth_file(dir), no_error);
    }
    remove_frames(dir, 0, stored_names(dir));
    for (const std::string& name : find_run_files(dir)) {
        std::error_code error;
        fs::remove(fs::path(dir) / name, error);
        if (error)
            throw InputError(
                fmt::format("-o {}: file {} cannot be replaced: {}", printable(dir), name, error.message()));
    }
}

/// A file in `dir` that a run would replace, relative to `dir`; empty if there is none.
std::string find_run_file(const std::string& dir)
{
    if (const std::vector<std::string> names = find_run_files(dir); !names.empty()) return names.front();
    std::error_code error;  // an inaccessible file is reported where it is used
    for (fs::directory_iterator entry(frames_directory(dir), error), end; !error && entry != end;
         entry.increment(error)) {
        const std::string file = entry->path().filename().string();
        if (const std::optional<FrameName> name = parse_frame_name(file); name && name->subject == "cloth")
            return (fs::path("frames") / file).string();
    }
    return {};
}

/// ", unfinished at t = 0.17 s: arris resume DIR continues it" for a run that resume can continue.
std::string tell_unfinished(const RunTarget& target)
{
    try {
        if (std::error_code no_error; !fs::exists(checkpoint_file(target.path), no_error) &&
                                      fs::exists(checkpoint_file(assembly_directory(target.path)), no_error))
            return fmt::format(", whose cloth is sewn or being sewn: {} continues it",
                               resume_command(target.program, target.path));
        const fs::path report = fs::path(target.path) / "report.json";
        const bool is_killed = !fs::exists(report);  // before its first report
        const std::string status = is_killed ? "interrupted" : read_status(report.string());
        if (status != "interrupted" && status != "io_error") return {};
        return fmt::format(", unfinished at t = {:.3g} s: {} continues it",
                           read_checkpoint(checkpoint_file(target.path)).state.time,
                           resume_command(target.program, target.path));
    } catch (const InputError&) {  // such as a damaged checkpoint: there is nothing to continue
        return {};
    }
}

/// Throws InputError if the folder holds a run, or a file that a run would replace.
void require_no_run(const RunTarget& target)
{
    const std::string& path = target.path;
    if (holds_run(path))
        throw InputError(fmt::format(
            "-o {}: holds a run already{}; allowed: --overwrite, which replaces it, or another folder",
            printable(path), tell_unfinished(target)));
    if (const std::string file = find_run_file(path); !file.empty())
        throw InputError(
            fmt::format("-o {}: holds {}, which a run would replace; allowed: --overwrite, or another folder",
                        printable(path), printable(file)));
}

void make_folders(const std::string& path)
{
    std::error_code error;
    fs::create_directories(frames_directory(path), error);
    if (error)
        throw InputError(fmt::format("-o {}: cannot be created: {}", printable(path), error.message()));
}

}  // namespace

std::string assembly_directory(const std::string& run_dir)
{
    return (fs::path(run_dir) / "assembly").string();
}

std::string assembly_cloth_file(const std::string& run_dir)
{
    return (fs::path(assembly_directory(run_dir)) / "cloth.obj").string();
}

std::string worn_directory(const std::string& assembly_dir)
{
    return fs::weakly_canonical(assembly_dir).parent_path().lexically_proximate(fs::current_path()).string();
}

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

void require_run(const std::string& path)
{
    constexpr const char* kAllowed = "allowed: a folder that arris run has written";
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status))
        throw InputError(fmt::format("{}: {}; {}", path.empty() ? "\"\"" : printable(path),
                                     error ? error.message() : "does not exist", kAllowed));
    if (!fs::is_directory(status))
        throw InputError(fmt::format("{}: is not a folder; {}", printable(path), kAllowed));
    const bool has_report = fs::exists(fs::path(path) / "report.json", error);
    if (!holds_run(path) && !has_report)
        throw InputError(fmt::format("{}: holds no run (no checkpoint, steps.csv or report.json); {}",
                                     printable(path), kAllowed));
}

FolderLock::FolderLock(const std::string& path)
    : descriptor_(open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC))
{
    if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), path);
    if (flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
    close(descriptor_);
    throw InputError(fmt::format("{}: another arris process is using this folder", printable(path)));
}

FolderLock::FolderLock(FolderLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

FolderLock::~FolderLock()
{
    if (descriptor_ >= 0) close(descriptor_);
}

RunDirectory::RunDirectory(std::string path, FolderLock lock, CsvWriter steps, CsvWriter probes)
    : path_(std::move(path)), lock_(std::move(lock)), steps_(std::move(steps)), probes_(std::move(probes))
{
}

RunDirectory RunDirectory::create(const RunTarget& target, const RunConfig& config)
{
    const std::string& path = target.path;
    std::error_code error;  // ignored: make_folders fails with the reason
    if (fs::exists(path, error) && !fs::is_directory(path, error))
        throw InputError(fmt::format("-o {}: is not a folder", printable(path)));
    if (!target.is_overwriting) require_no_run(target);
    make_folders(path);
    FolderLock lock(path);
    if (target.is_overwriting) remove_run(path);
    RunDirectory files(path, std::move(lock), CsvWriter::create(steps_file(path), step_header()),
                       CsvWriter::create(probes_file(path), probe_header(probe_names(config))));
    if (!config.scene.obstacles.empty()) write_obstacles(path, record_obstacles(config));
    return files;
}

RunDirectory RunDirectory::begin_again(const std::string& path, const RunConfig& config)
{
    FolderLock lock(path);
    make_folders(path);
    remove_frames(path, 0, stored_names(path));
    return {path, std::move(lock), CsvWriter::create(steps_file(path), step_header()),
            CsvWriter::create(probes_file(path), probe_header(probe_names(config)))};
}

RunDirectory RunDirectory::reopen(const std::string& path, const Checkpoint& checkpoint,
                                  const RunConfig& config)
{
    FolderLock lock(path);
    if (const std::int64_t frames = count_frames(path); frames < checkpoint.frames)
        throw InputError(fmt::format("{}: holds {} frames, but the checkpoint counts {}",
                                     printable(frames_directory(path)), frames, checkpoint.frames));
    truncate_csv(steps_file(path), checkpoint.rows);
    truncate_csv(probes_file(path), checkpoint.rows);
    sum_steps(steps_file(path));  // reports a damaged row now, not after the rest has been simulated
    std::set<std::string> obstacles;
    for (const MovingObstacle& obstacle : config.scene.obstacles) obstacles.insert(obstacle.name());
    remove_frames(path, checkpoint.frames, obstacles);
    make_folders(path);
    return {path, std::move(lock), CsvWriter::append_to(steps_file(path), step_header()),
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
