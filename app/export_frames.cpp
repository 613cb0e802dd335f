// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/export_frames.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/export_obj.h"
#include "app/export_usd.h"
#include "app/frame.h"
#include "app/frame_files.h"
#include "app/obstacle_records.h"
#include "app/run_directory.h"
#include "app/viewer_html.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

/// What the formats are made from.
struct Source {
    const std::string& run_dir;
    std::int64_t frame_count;
    const ExportOptions& options;
    std::vector<ObstacleRecord> obstacles;

    double time(std::int64_t frame) const { return static_cast<double>(frame) / options.frames_per_second; }
};

void export_obj(const Source& run)
{
    for (std::int64_t i = 0; i < run.frame_count; ++i)
        write_obj(frame_file(run.run_dir, i, "obj"), read_frame(frame_file(run.run_dir, i, "ply")));
    for (const ObstacleRecord& obstacle : run.obstacles)
        for (std::int64_t i = 0; i < count_obstacle_frames(obstacle, run.frame_count); ++i)
            write_obj(frame_file(run.run_dir, i, "obj", obstacle.name), obstacle, obstacle.at(run.time(i)));
}

void export_usd(const Source& run)
{
    std::vector<std::string> paths;
    for (std::int64_t i = 0; i < run.frame_count; ++i) paths.push_back(frame_file(run.run_dir, i, "ply"));
    write_usd(run.run_dir + "/cloth.usda", paths, {run.options.title, run.options.frames_per_second},
              run.obstacles);
}

void export_viewer(const Source& run)
{
    ViewerOptions viewer;
    viewer.title = run.options.title;
    viewer.frames_per_second = run.options.frames_per_second;
    write_viewer(run.run_dir, viewer, run.obstacles);
}

/// A format's name and what makes it; one that is planned has no function yet.
struct Format {
    const char* name;
    void (*make)(const Source&);
    const char* place;  ///< in the run's folder
};

constexpr Format kFormats[] = {
    {"obj", export_obj, "frames/cloth_*.obj"},
    {"usd", export_usd, "cloth.usda"},
    {"viewer", export_viewer, "viewer.html"},
    {"vtk", nullptr, ""},
    {"gltf", nullptr, ""},
    {"pc2", nullptr, ""},
};

const Format& find_format(const std::string& name)
{
    std::vector<std::string> built;
    bool is_planned = false;
    for (const Format& format : kFormats) {
        if (format.make != nullptr) built.push_back(format.name);
        if (name == format.name && format.make != nullptr) return format;
        is_planned = is_planned || name == format.name;
    }
    throw InputError(fmt::format("formats: \"{}\" is {}; allowed: {}", name,
                                 is_planned ? "not built yet" : "unknown", fmt::join(built, ", ")));
}

nlohmann::ordered_json read_report(const std::string& path)
{
    std::ifstream in(path);
    if (!in || !std::filesystem::is_regular_file(path))
        throw InputError(path + ": is not there or cannot be read; allowed: the report of a run");
    nlohmann::ordered_json report = nlohmann::ordered_json::parse(in, nullptr, /*allow_exceptions=*/false);
    if (!report.is_object() || !report.contains("scene") || !report["scene"].is_object())
        throw InputError(path + ": not a run's report: it has no scene");
    return report;
}

}  // namespace

std::string exported_path(const std::string& run_dir, const std::string& format)
{
    return (std::filesystem::path(run_dir) / find_format(format).place).string();
}

ExportOptions read_export_options(const std::string& run_dir)
{
    require_run(run_dir);
    const std::string path = run_dir + "/report.json";
    if (!std::filesystem::exists(path) && std::filesystem::exists(checkpoint_file(run_dir))) {
        // A run that was killed before its first report.
        const Checkpoint checkpoint = read_checkpoint(checkpoint_file(run_dir));
        const std::vector<ObstacleRecord> obstacles = read_obstacles(run_dir);
        LoadOptions load;
        load.cloth = &checkpoint.state.mesh;
        load.obstacles = &obstacles;
        const RunConfig config = load_scene(checkpoint.source, load);
        return {config.title, config.output.frames_per_second};
    }
    const nlohmann::ordered_json report = read_report(path);
    const nlohmann::ordered_json& scene = report["scene"];

    ExportOptions options;
    if (scene.contains("title") && scene["title"].is_string()) options.title = scene["title"];
    const auto rate = nlohmann::ordered_json::json_pointer("/output/frames_per_second");
    if (!scene.contains(rate) || !scene[rate].is_number())
        throw InputError(path + ": scene.output.frames_per_second is not there or not a number");
    options.frames_per_second = scene[rate];
    if (!(options.frames_per_second > 0.0) || !std::isfinite(options.frames_per_second))
        throw InputError(fmt::format("{}: scene.output.frames_per_second is {}: the run wrote no frames",
                                     path, options.frames_per_second));
    return options;
}

void require_known_formats(const std::vector<std::string>& formats)
{
    for (const std::string& name : formats) find_format(name);
}

void export_frames(const std::string& run_dir, const std::vector<std::string>& formats,
                   const ExportOptions& options)
{
    require_known_formats(formats);
    const std::int64_t frame_count = count_frames(run_dir);
    if (frame_count == 0) throw InputError(frames_directory(run_dir) + ": no frames (cloth_00000.ply, ...)");
    const Source source{run_dir, frame_count, options, read_obstacles(run_dir)};
    for (const std::string& name : formats) find_format(name).make(source);
}

}  // namespace arris
