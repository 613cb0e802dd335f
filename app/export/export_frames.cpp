// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/export/export_frames.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "app/export/export_gltf.h"
#include "app/export/export_obj.h"
#include "app/export/export_point_cache.h"
#include "app/export/export_usd.h"
#include "app/export/export_vtk.h"
#include "app/export/viewer_html.h"
#include "app/files/frame_files.h"
#include "app/files/frame_source.h"
#include "app/scene/parts/obstacle_records.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

/// Input of all formats, with cloth and obstacles turned to `options.up`.
struct Source {
    const std::string& run_dir;
    FrameSource frames;    ///< as the run wrote them, or resampled by request
    FrameSource constant;  ///< resampled, if a format needs that
    const ExportOptions& options;
    std::vector<ObstacleRecord> obstacles;

    double time(std::size_t frame) const { return static_cast<double>(frame) / options.frames_per_second; }
};

/// Places of an obstacle's points in a file with `up`, at `time`.
std::vector<Vec3> turned_points(const ObstacleRecord& obstacle, UpAxis up, double time)
{
    std::vector<Vec3> points = obstacle.points_at(time);
    const Placement to_file = turn_to(up) * obstacle.at(time);
    for (Vec3& point : points) point = to_file(point);
    return points;
}

/// Writes each frame's cloth and obstacles by `write` into files of their own.
template <typename Write>
void write_each(const Source& run, const char* extension, const Write& write)
{
    const auto path = [&](std::size_t i, const std::string& name) {
        return frame_file(run.run_dir, static_cast<std::int64_t>(i), extension, name);
    };
    for (std::size_t i = 0; i < run.frames.count; ++i) write(path(i, "cloth"), run.frames.read(i));
    for (const ObstacleRecord& obstacle : run.obstacles)
        for (std::size_t i = 0; i < count_obstacle_frames(obstacle, run.frames.count); ++i)
            write(path(i, obstacle.name), obstacle, turned_points(obstacle, run.options.up, run.time(i)));
}

void export_obj(const Source& run)
{
    write_each(run, "obj", [up = run.options.up](const auto&... parts) { write_obj(parts..., up); });
}

void export_usd(const Source& run)
{
    write_usd(run.run_dir + "/cloth.usda", run.frames, {run.options.title, run.options.frames_per_second},
              run.obstacles);
}

void export_vtk(const Source& run)
{
    write_each(run, "vtp", [](const auto&... parts) { write_vtp(parts...); });
    write_pvd(run.run_dir + "/cloth.pvd", run.obstacles, run.frames.count, run.options.frames_per_second);
}

constexpr const char* kBaseFile = "cloth_base.obj";

/// The mesh that a cache moves.
void export_base(const Source& run)
{
    write_obj((std::filesystem::path(run.run_dir) / kBaseFile).string(), run.constant.read(0),
              run.options.up);
}

void export_pc2(const Source& run)
{
    write_pc2(run.run_dir + "/cloth.pc2", run.constant);
    export_base(run);
}

void export_mdd(const Source& run)
{
    write_mdd(run.run_dir + "/cloth.mdd", run.constant, run.options.frames_per_second);
    export_base(run);
}

void export_gltf(const Source& run)
{
    write_gltf(run.run_dir + "/cloth.glb", run.constant, {run.options.title, run.options.frames_per_second},
               run.obstacles);
}

void export_viewer(const Source& run)
{
    ViewerOptions viewer;
    viewer.title = run.options.title;
    viewer.frames_per_second = run.options.frames_per_second;
    write_viewer(run.run_dir, viewer, run.obstacles);
}

/// A format and the function that makes it.
struct Format {
    const char* name;
    void (*make)(const Source&);
    const char* place;  ///< relative to the run's folder
    bool is_constant;   ///< reads Source::constant
    bool has_own_axis;  ///< states in the file which axis is up, or turns it itself
};

constexpr Format kFormats[] = {
    {"obj", export_obj, "frames/cloth_*.obj", false, false}, {"usd", export_usd, "cloth.usda", false, true},
    {"viewer", export_viewer, "viewer.html", false, true},   {"vtk", export_vtk, "cloth.pvd", false, false},
    {"pc2", export_pc2, "cloth.pc2", true, false},           {"mdd", export_mdd, "cloth.mdd", true, false},
    {"gltf", export_gltf, "cloth.glb", true, true},
};

const Format& find_format(const std::string& name)
{
    std::vector<std::string> names;
    for (const Format& format : kFormats) {
        if (name == format.name) return format;
        names.emplace_back(format.name);
    }
    throw InputError(fmt::format("formats: \"{}\" is unknown; allowed: {}", name, fmt::join(names, ", ")));
}

/// The option by which an export differs from what the run itself makes, as it is written; or "".
std::string differing_option(const ExportOptions& options)
{
    if (options.is_topology_constant) return "--topology constant";
    if (options.grid) return fmt::format("--grid {}x{}", options.grid->u, options.grid->v);
    return options.up == UpAxis::Z ? "" : fmt::format("--up {}", to_string(options.up));
}

/// The file by which an export of `format` is recognised that is there already, relative to the folder; or
/// "".
std::string find_export(const std::string& run_dir, const Format& format)
{
    const std::filesystem::path folder(run_dir);
    std::string file = format.place;
    if (const std::size_t star = file.find('*'); star != std::string::npos) file.replace(star, 1, "00000");
    if (std::filesystem::exists(folder / file)) return file;
    const bool is_cache = format.make == export_pc2 || format.make == export_mdd;
    return is_cache && std::filesystem::exists(folder / kBaseFile) ? kBaseFile : "";
}

/// Throws InputError if the export would replace files by others of another mesh or axis.
void require_no_other_export(const std::string& run_dir, const std::vector<std::string>& formats,
                             const ExportOptions& options)
{
    const std::string option = differing_option(options);
    if (options.is_overwriting || option.empty()) return;
    for (const std::string& name : formats)
        if (const std::string file = find_export(run_dir, find_format(name)); !file.empty())
            throw InputError(fmt::format(
                "{}: holds {}, which \"{}\" with {} would replace; allowed: --overwrite, or another format",
                run_dir, file, name, option));
}

}  // namespace

std::string exported_path(const std::string& run_dir, const std::string& format)
{
    return (std::filesystem::path(run_dir) / find_format(format).place).string();
}

void require_known_formats(const std::vector<std::string>& formats)
{
    for (const std::string& name : formats) find_format(name);
}

void export_frames(const std::string& run_dir, const std::vector<std::string>& formats,
                   const ExportOptions& options)
{
    require_known_formats(formats);
    bool needs_constant = options.is_topology_constant;
    for (const std::string& name : formats) {
        if (options.is_topology_constant && name == "viewer")
            throw InputError(
                "formats: \"viewer\" shows the frames as simulated; allowed with --topology constant: all "
                "others");
        needs_constant = needs_constant || find_format(name).is_constant;
        if (options.up != UpAxis::Z && find_format(name).has_own_axis)
            throw InputError(
                fmt::format("--up {}: \"{}\" has its own axis; allowed with formats obj, vtk, pc2, mdd",
                            to_string(options.up), name));
    }
    if (options.grid && !needs_constant)
        throw InputError("--grid: no format uses it; allowed: with --topology constant, pc2, mdd or gltf");
    require_no_other_export(run_dir, formats, options);
    const FrameSource frames = read_frames_of(run_dir);
    if (frames.count == 0) refuse_no_frames(run_dir);
    const FrameSource constant =
        needs_constant ? resampled_frames(frames, make_constant_mesh(frames.read(0), options.grid)) : frames;
    const Source source{run_dir, turned(options.is_topology_constant ? constant : frames, options.up),
                        turned(constant, options.up), options, read_obstacles(run_dir)};
    for (const std::string& name : formats) find_format(name).make(source);
}

}  // namespace arris
