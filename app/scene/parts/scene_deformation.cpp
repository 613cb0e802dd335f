// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/scene_deformation.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <utility>

#include "app/files/pose_file.h"
#include "app/scene/keys/scene_json.h"
#include "app/scene/parts/merge_events.h"
#include "app/text/counted.h"
#include "geometry/input_error.h"
#include "geometry/obstacle_input/deform/mesh_poses.h"
#include "geometry/obstacle_input/deform/slit.h"
#include "geometry/obstacle_input/deform/slit_samples.h"
#include "geometry/obstacle_input/deform/vertex_cache.h"
#include "geometry/sort_unique.h"
#include "solver/motion_parts.h"

namespace arris {
namespace {

using Json = nlohmann::ordered_json;

// m: nothing near cloth moves as far within a frame; a file whose vertices change their order does.
constexpr double kFarMove = 1.0;

// The distances that two sides of a cloth keep, and a half for its folds.
constexpr double kSlitThicknesses = 2.5;

// Of the mesh's size: a wider slit would be a part of the body itself, and each point would have to look at
// thousands of faces.
constexpr double kSlitShare = 0.02;

std::optional<int> to_sample(const Json& value)
{
    return value.is_null() ? std::nullopt : std::optional<int>(value.get<int>());
}

VertexCacheRequest to_request(const SceneDocument& document, const Json& deform, int vertex_count)
{
    VertexCacheRequest request;
    const std::filesystem::path file(deform["file"].get<std::string>());
    request.path = (std::filesystem::path(document.path()).parent_path() / file).string();
    if (!deform["frames_per_second"].is_null())
        request.frames_per_second = to_double(deform["frames_per_second"]);
    request.first = to_sample(deform["first"]);
    request.last = to_sample(deform["last"]);
    request.vertex_count = vertex_count;
    if (!deform["prim"].is_null()) request.prim = deform["prim"].get<std::string>();
    if (!deform["animation"].is_null()) request.animation = deform["animation"].get<std::string>();
    return request;
}

/// `units` and `up` are those of the obstacle's file. Another file may declare its own, as USD does.
FileFrame to_frame(const Json& obstacle, const DeclaredFrame& declared)
{
    const bool is_own = obstacle["deform"]["file"] == obstacle["file"];
    const bool has_unit = !obstacle["units"].is_null(), has_up = !obstacle["up"].is_null();
    FileFrame frame;
    if (has_unit) frame.metres_per_unit = metres_of(obstacle["units"].get<std::string>());
    if (has_up) frame.up = obstacle["up"].get<std::string>()[0];
    if (declared.metres_per_unit && !(is_own && has_unit)) frame.metres_per_unit = *declared.metres_per_unit;
    if (declared.up && !(is_own && has_up)) frame.up = *declared.up;
    frame.scale = to_double(obstacle["scale"]);
    return frame;
}

/// Times of the samples in the scene.
std::vector<double> to_scene_times(const std::vector<double>& times, const Json& deform)
{
    const double start = to_double(deform["start"]), speed = to_double(deform["speed"]);
    std::vector<double> scaled;
    for (const double time : times) scaled.push_back(start + time / speed);
    return scaled;
}

void tell(const SceneDocument& document, const std::string& key, const VertexCache& cache,
          const PoseFileHead& head, const PoseSurvey& survey, double speed, RunConfig& config)
{
    const std::string where = document.describe(key);
    if (survey.most_collapsed > 0)
        config.warnings.push_back(fmt::format(
            "{}: {} ({}): they have no side there, and sharp edges beside them are not found", where,
            counted(static_cast<std::size_t>(survey.most_collapsed), "face has no area",
                    "faces have no area"),
            cache.describe(survey.collapsed_at)));
    if (survey.greatest_move > kFarMove)
        config.warnings.push_back(fmt::format(
            "{}: vertex {} moves {:.3g} m from one sample to the next ({}): has the order of the "
            "vertices changed?",
            where, survey.moved_vertex + 1, survey.greatest_move, cache.describe(survey.moved_at)));
    const double step = config.settings.step;
    for (std::size_t k = 1; k < head.times.size(); ++k)
        if (const double apart = head.times[k] - head.times[k - 1]; apart < step * (1.0 - 1e-9)) {
            config.warnings.push_back(
                fmt::format("{}: samples are {:.3g} s apart, less than time.step, {:g} s: steps pass over "
                            "samples; lower frames_per_second or time.step",
                            where, apart, step));
            break;
        }
    const double chord = survey.greatest_acceleration * std::pow(speed * step, 2) / 8.0;
    if (head.interpolation == PoseInterpolation::Cubic &&
        chord > kMostChordShare * config.scene.materials.thickness())
        config.warnings.push_back(fmt::format(
            "{}: a vertex leaves its straight way by {:.2g} m within a step ({}); above a quarter "
            "of the cloth's thickness, {:g} m, steps near the cloth are made in parts",
            where, chord, cache.describe(survey.accelerated_at), config.scene.materials.thickness()));
    config.notes.push_back(fmt::format("{}: {} of {} from {:g} s to {:g} s, the fastest vertex at {:.3g} m/s",
                                       where, counted(head.times.size(), "sample", "samples"),
                                       counted(head.point_count, "point", "points"), head.times.front(),
                                       head.times.back(), speed * survey.greatest_speed));
}

void check_slit(const SceneDocument& document, const std::string& key, const ObstacleMesh& mesh, double width)
{
    Box3 box;
    for (const Vec3& point : mesh.points) box.extend(point);
    const double most = kSlitShare * box.diagonal().norm();
    if (width > most)
        document.fail(key, "is too wide for this mesh",
                      fmt::format("at most {:.3g} m, a fiftieth of the mesh's size", most));
}

/// The same samples with a slit between parts of the body.
std::shared_ptr<const PoseFile> with_slit(const SceneDocument& document, const std::string& key,
                                          const VertexCache& cache, const PoseFile& samples,
                                          const ObstacleMesh& mesh, double width, RunConfig& config)
{
    const double least = kSlitThicknesses * config.scene.materials.thickness();
    if (width < least)
        config.warnings.push_back(
            fmt::format("{}: {:g} m has no room for cloth; use {:g} m or more, {:g} "
                        "times the cloth's thickness",
                        document.describe(key), width, least, kSlitThicknesses));
    PoseFileWriter writer(samples.head());
    const SlitSurvey survey =
        make_slit(samples, mesh, width, [&](const std::vector<Vec3>& points) { writer.add(points); });
    config.notes.push_back(survey.samples == 0
                               ? fmt::format("{}: no parts come together", document.describe(key))
                               : fmt::format("{}: the skin retreats in {} of {}, by at most {:.3g} m ({})",
                                             document.describe(key), survey.samples,
                                             counted(samples.times().size(), "sample", "samples"),
                                             survey.greatest_retreat, cache.describe(survey.greatest_at)));
    return writer.finish();
}

/// "0.4 s to 1.2 s, 2 s": the times of the samples that are set. At most three spans.
std::string describe_times(const std::vector<double>& times, const std::vector<char>& is_set)
{
    constexpr int kMostSpans = 3;
    std::string text;
    int spans = 0;
    for (std::size_t k = 0; k < times.size(); ++k) {
        if (is_set[k] == 0 || (k > 0 && is_set[k - 1] != 0)) continue;
        if (spans++ == kMostSpans) return text + ", …";
        std::size_t last = k;
        while (last + 1 < times.size() && is_set[last + 1] != 0) ++last;
        text += fmt::format("{}{:.4g} s", text.empty() ? "" : ", ", times[k]);
        if (last > k) text += fmt::format(" to {:.4g} s", times[last]);
    }
    return text;
}

std::size_t count_crossing_faces(const ObstacleMesh& mesh, const std::vector<Vec3>& points)
{
    std::vector<int> crossing;
    for (const std::array<int, 2>& pair : find_crossing_faces(mesh, points))
        crossing.insert(crossing.end(), pair.begin(), pair.end());
    sort_unique(crossing);
    return crossing.size();
}

/// Many bodies are made of pieces that cross, such as boots over legs: only what the motion adds is told.
void tell_crossings(const SceneDocument& document, const std::string& key, const VertexCache& cache,
                    const PoseFile& samples, const ObstacleMesh& mesh, bool has_slit, RunConfig& config)
{
    const std::size_t own = count_crossing_faces(mesh, mesh.points);
    std::vector<char> crosses(samples.times().size(), 0);
    std::size_t most = own, most_at = 0;
    std::vector<Vec3> points;
    for (std::size_t k = 0; k < crosses.size(); ++k) {
        samples.read(k, points);
        const std::size_t now = count_crossing_faces(mesh, points);
        crosses[k] = now > own ? 1 : 0;
        if (now <= most) continue;
        most = now;
        most_at = k;
    }
    if (most == own) return;
    config.warnings.push_back(fmt::format(
        "{}: up to {} other faces of the mesh ({}){}, at {}: cloth between such parts has no place; {}",
        document.describe(key), counted(most, "face crosses", "faces cross"), cache.describe(most_at),
        own > 0 ? fmt::format(", {} in its own pose", own) : "", describe_times(samples.times(), crosses),
        has_slit ? "they overlap too deeply for this `slit`: part them in the animation"
                 : "`slit` makes one"));
}

}  // namespace

std::shared_ptr<const Deformation> load_deformation(const SceneDocument& document, std::size_t index,
                                                    const ObstacleFile& mesh,
                                                    const std::vector<RigidMotion>& motions,
                                                    RunConfig& config)
{
    const Json& obstacle = config.as_run["obstacle"][index];
    const std::string path = fmt::format("obstacle.{}", index);
    const Json& deform = obstacle["deform"];
    const std::string key = path + ".deform.file";
    if (mesh.origins.vertex_count == 0)
        document.fail(path + ".file",
                      "has vertices without an order of their own, and the obstacle has `deform`",
                      "OBJ, PLY or glTF");
    if (!deform["slit"].is_null())
        check_slit(document, path + ".deform.slit", mesh.mesh, to_double(deform["slit"]));
    try {
        const std::unique_ptr<VertexCache> cache =
            open_vertex_cache(to_request(document, deform, mesh.origins.vertex_count));
        PoseFileHead head;
        head.times = to_scene_times(cache->times(), deform);
        merge_with_events(config, motions, head.times);
        head.point_count = mesh.mesh.points.size();
        head.is_single = cache->is_single();
        head.interpolation =
            deform["interpolation"] == "linear" ? PoseInterpolation::Linear : PoseInterpolation::Cubic;
        PoseFileWriter writer(head);
        MeshPoses poses(*cache, mesh.mesh, mesh.origins, to_frame(obstacle, cache->declared()));
        std::vector<Vec3> points;
        for (std::size_t k = 0; k < head.times.size(); ++k) {
            poses.read_next(points);
            writer.add(points);
        }
        tell(document, key, *cache, head, poses.survey(), to_double(deform["speed"]), config);
        std::shared_ptr<const PoseFile> samples = writer.finish();
        if (!deform["slit"].is_null())
            samples = with_slit(document, path + ".deform.slit", *cache, *samples, mesh.mesh,
                                to_double(deform["slit"]), config);
        tell_crossings(document, key, *cache, *samples, mesh.mesh, !deform["slit"].is_null(), config);
        return std::make_shared<PointCache>(samples, head.interpolation);
    } catch (const InputError& error) {
        document.fail(key, error.what());
    }
}

}  // namespace arris
