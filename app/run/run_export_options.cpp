// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/run_export_options.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/run/resumed_scene.h"
#include "app/run/run_directory.h"
#include "app/scene/parts/obstacle_records.h"
#include "app/text/printable.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

nlohmann::ordered_json read_report(const std::string& path)
{
    std::ifstream in(path);
    if (!in || !std::filesystem::is_regular_file(path))
        throw InputError(path + ": does not exist or cannot be read; allowed: the report of a run");
    nlohmann::ordered_json report = nlohmann::ordered_json::parse(in, nullptr, /*allow_exceptions=*/false);
    if (!report.is_object() || !report.contains("scene") || !report["scene"].is_object())
        throw InputError(path + ": is not the report of a run: it has no scene");
    return report;
}

}  // namespace

ExportOptions read_export_options(const std::string& run_dir)
{
    require_run(run_dir);
    const std::string path = run_dir + "/report.json";
    if (!std::filesystem::exists(path) && std::filesystem::exists(checkpoint_file(run_dir))) {
        // The run was killed before its first report.
        const Checkpoint checkpoint = read_checkpoint(checkpoint_file(run_dir));
        const RunConfig config = load_stored(run_dir, checkpoint, read_obstacles(run_dir));
        return {config.title, config.output.frames_per_second};
    }
    if (!std::filesystem::exists(path) &&
        std::filesystem::exists(checkpoint_file(assembly_directory(run_dir))))
        throw InputError(
            fmt::format("{}: has no frames yet, as its cloth was sewn alone; allowed: {} (how it was sewn, "
                        "with cloth.assembly.frames), or this folder after arris resume",
                        printable(run_dir), printable(assembly_directory(run_dir))));
    const nlohmann::ordered_json report = read_report(path);
    const nlohmann::ordered_json& scene = report["scene"];
    ExportOptions options;
    if (scene.contains("title") && scene["title"].is_string()) options.title = scene["title"];
    const auto rate = nlohmann::ordered_json::json_pointer("/output/frames_per_second");
    if (!scene.contains(rate) || !scene[rate].is_number())
        throw InputError(path + ": scene.output.frames_per_second is missing or not a number");
    options.frames_per_second = scene[rate];
    if (!(options.frames_per_second > 0.0) || !std::isfinite(options.frames_per_second))
        throw InputError(fmt::format("{}: scene.output.frames_per_second is {}: the run wrote no frames",
                                     path, options.frames_per_second));
    return options;
}

std::vector<std::string> warn_of_missing_files(const std::string& run_dir)
{
    const std::string report = run_dir + "/report.json", stored = obstacles_file(run_dir);
    if (!std::filesystem::exists(report) || std::filesystem::exists(stored)) return {};
    if (!read_report(report)["scene"].contains("obstacle")) return {};
    return {stored + ": is missing, in which the run stored its obstacles: the export is without them"};
}

}  // namespace arris
