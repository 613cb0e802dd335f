// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/resumed_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "app/files/frame.h"
#include "app/files/frame_files.h"
#include "app/run/run_directory.h"
#include "app/run/timeline.h"
#include "app/scene/scene_load.h"
#include "app/text/printable.h"
#include "geometry/input_error.h"
#include "solver/velocity_solve/blas_kernel.h"

namespace arris {
namespace {

/// Whether a pin's vertex rides on an element of the obstacle that the pin follows, or on none.
bool is_on_surface(const PinAnchor& anchor, const Scene& scene)
{
    const SurfacePlace& on = anchor.on;
    const std::optional<int>& follows = scene.pins[anchor.pin].follows;
    if (on.element < 0) return on.element == -1;
    if (!follows) return false;
    const Obstacle& shape = scene.obstacles[static_cast<std::size_t>(*follows)].shape();
    const std::size_t count = on.kind == SurfaceKind::Triangle ? shape.mesh().faces.size()
                              : on.kind == SurfaceKind::Edge   ? shape.topology().edges.size()
                                                               : shape.mesh().points.size();
    const int points = static_cast<int>(shape.mesh().points.size());
    return on.element < static_cast<int>(count) && on.points[0] >= 0 &&
           std::all_of(on.points.begin(), on.points.end(), [&](int p) { return p >= -1 && p < points; });
}

}  // namespace

void check_references(const std::string& name, const Checkpoint& checkpoint, const Scene& scene)
{
    const State& state = checkpoint.state;
    const auto is_sound = [](std::int64_t index, std::size_t count) {
        return index >= 0 && index < static_cast<std::int64_t>(count);
    };
    const bool has_pins =
        std::all_of(state.anchors.begin(), state.anchors.end(), [&](const PinAnchor& anchor) {
            return is_sound(anchor.pin, scene.pins.size()) && is_on_surface(anchor, scene);
        });
    const auto is_there = [&](const ActiveContact& contact) {
        if (contact.obstacle == kClothItself) return true;
        if (!is_sound(contact.obstacle, scene.obstacles.size())) return false;
        const Obstacle& obstacle = scene.obstacles[static_cast<std::size_t>(contact.obstacle)].shape();
        switch (contact.kind) {
            case ContactKind::Vertex:
                return true;  // the element of a vertex contact is only compared, not used as an index
            case ContactKind::Edge:
                return is_sound(contact.element, obstacle.topology().edges.size());
            case ContactKind::Triangle:
                return is_sound(contact.element, obstacle.mesh().points.size());
        }
        return false;
    };
    const auto is_on_feature = [&](const EolVertex& vertex) {
        if (!is_sound(vertex.on.obstacle, scene.obstacles.size())) return false;
        const ObstacleFeatures& features =
            scene.obstacles[static_cast<std::size_t>(vertex.on.obstacle)].shape().features();
        return is_sound(vertex.on.index,
                        vertex.on.is_corner() ? features.corners.size() : features.edges.size());
    };
    const bool has_obstacles = std::all_of(state.active.begin(), state.active.end(), is_there) &&
                               std::all_of(state.eol.begin(), state.eol.end(), is_on_feature);
    const std::size_t nodes = scene.remesh ? static_cast<std::size_t>(scene.remesh->grid.size()) : 0;
    if (state.sizing_field.size() != nodes)
        throw InputError(fmt::format("{}: is damaged: it has {} cell lengths where the scene has {}",
                                     printable(name), state.sizing_field.size(), nodes));
    const bool has_given =
        std::all_of(checkpoint.given.begin(), checkpoint.given.end(), [&](const GivenMotion& given) {
            return is_sound(given.mover.index,
                            given.mover.is_pin ? scene.pins.size() : scene.obstacles.size());
        });
    if (!has_pins || !has_obstacles || !has_given)
        throw InputError(fmt::format("{}: is damaged: it refers to {} that the scene does not have",
                                     printable(name), has_pins ? "parts of obstacles" : "pins"));
}

namespace {

/// Parts of a checkpoint's scene that load_scene takes instead of files. It refers to its arguments.
struct StoredScene {
    std::vector<SceneSeam> seams;  ///< without pairs, which are the state's
    LoadOptions options;

    StoredScene(const Checkpoint& checkpoint, const ClothMesh& cloth,
                const std::vector<ObstacleRecord>& obstacles, const std::string& pieces_file)
    {
        for (const OpenSeam& seam : checkpoint.seams) seams.push_back({seam, {}});
        options.cloth = &cloth;
        options.pieces = &checkpoint.pieces;
        options.pieces_file = pieces_file;
        options.seams = &seams;
        options.labels = &checkpoint.labels;
        options.obstacles = &obstacles;
    }
    StoredScene(const StoredScene&) = delete;  // `options` points to `seams`
    StoredScene& operator=(const StoredScene&) = delete;
};

/// The cloth at time 0, which determines the target length. If its frame is missing, the checkpoint's cloth
/// is returned, and RunDirectory::reopen refuses the run later.
ClothMesh read_first_cloth(const std::string& directory, const State& state)
{
    const std::string path = frame_file(directory, 0, "ply");
    if (!std::filesystem::exists(path)) return state.mesh;
    Frame first = read_frame(path);
    ClothMesh cloth{std::move(first.material), std::move(first.world), std::move(first.faces),
                    std::move(first.face_points), std::move(first.seam_vertices)};
    if (const std::string defect = validate(cloth); !defect.empty())
        throw InputError(fmt::format("{}: is damaged: {}", printable(path), defect));
    return cloth;
}

/// Warns where another kernel has made the steps so far: the result may differ from that of a run without a
/// stop.
void note_kernel(Checkpoint& checkpoint)
{
    const std::string kernel = blas_kernel();
    if (kernel == checkpoint.kernel) return;
    checkpoint.warnings.push_back(fmt::format(
        "from t = {:.6g} s on computed with the BLAS kernel {}, before with {}: the result may differ from "
        "that of a run without a stop; OPENBLAS_CORETYPE={} in the environment keeps the kernel",
        checkpoint.state.time, kernel, checkpoint.kernel, checkpoint.kernel));
    checkpoint.kernel = kernel;
}

}  // namespace

void set_end(double until, double reached, SceneSource& source)
{
    if (!(until > reached) || !std::isfinite(until))
        throw InputError(fmt::format(
            "--until {}: is not later than t = {} s, the time that the run has reached", until, reached));
    source.overrides.push_back(fmt::format("duration={}", until));
}

RunConfig load_stored(const std::string& directory, const Checkpoint& checkpoint,
                      const std::vector<ObstacleRecord>& obstacles)
{
    StoredScene stored(checkpoint, checkpoint.state.mesh, obstacles, printable(checkpoint_file(directory)));
    stored.options.obstacles_file = printable(directory);
    RunConfig config = load_scene(checkpoint.source, stored.options);
    config.warnings = checkpoint.warnings;
    return config;
}

RunConfig load_sewn(const SceneSource& source, const Checkpoint& sewn, const RunConfig& unsewn)
{
    const State& state = sewn.state;
    const std::vector<ObstacleRecord> obstacles = record_obstacles(unsewn);
    StoredScene stored(sewn, state.mesh, obstacles, "the assembly");
    for (const SeamPair& pair : state.seam_pairs)
        stored.seams[static_cast<std::size_t>(pair.seam)].pairs.push_back(
            {state.index_of(pair.vertex_ids[0]), state.index_of(pair.vertex_ids[1])});
    std::erase_if(stored.seams, [](const SceneSeam& seam) { return seam.pairs.empty(); });
    for (SceneSeam& seam : stored.seams) seam.is_tie = true;  // what a scene keeps unsewn, too
    stored.options.is_start = true;
    RunConfig config = load_scene(source, stored.options);
    config.warnings = unsewn.warnings;
    config.notes = unsewn.notes;
    return config;
}

RunConfig load_resumed(const std::string& directory, const std::optional<double>& until,
                       Checkpoint& checkpoint)
{
    const std::vector<ObstacleRecord> obstacles = read_obstacles(directory);
    const ClothMesh first = read_first_cloth(directory, checkpoint.state);
    StoredScene stored(checkpoint, first, obstacles, printable(checkpoint_file(directory)));
    LoadOptions& options = stored.options;
    options.obstacles_file = obstacles_file(directory);
    RunConfig config = load_scene(checkpoint.source, options);
    check_references(checkpoint_file(directory), checkpoint, config.scene);
    if (until) {
        const double begin = checkpoint.position.begin;
        const double planned_end = Timeline(config).interval_end(begin);
        set_end(*until, checkpoint.state.time, checkpoint.source);
        config = load_scene(checkpoint.source, options);
        if (Timeline(config).interval_end(begin) != planned_end)
            checkpoint.position = {checkpoint.state.time, 0};
    }
    if (!Timeline(config).is_over(checkpoint.position)) note_kernel(checkpoint);
    config.warnings = checkpoint.warnings;
    return config;
}

}  // namespace arris
