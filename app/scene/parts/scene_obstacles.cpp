// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/scene_obstacles.h"

#include <fmt/format.h>

#include <filesystem>
#include <numbers>
#include <optional>
#include <utility>

#include "app/scene/keys/scene_json.h"
#include "app/scene/parts/scene_deformation.h"
#include "app/scene/parts/scene_estimate.h"
#include "app/text/counted.h"
#include "app/text/printable.h"
#include "geometry/cloth/mesh_topology.h"
#include "geometry/input_error.h"
#include "geometry/obstacle/obstacle_topology.h"
#include "geometry/obstacle_input/obstacle_file.h"
#include "geometry/obstacle_input/obstacle_shapes.h"
#include "solver/contact/audit.h"
#include "solver/contact/clearance.h"
#include "solver/motion_parts.h"
#include "solver/step.h"

namespace arris {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kFarthest = 1e6;  // m, the bound of every length of a scene

RigidMotion to_motion(const Json& obstacle)
{
    RigidMotion motion;
    if (obstacle.contains("keyframes")) motion.keyframes = to_keyframes(obstacle["keyframes"]);
    if (!obstacle.contains("motion")) return motion;
    const Json& json = obstacle["motion"];
    motion.velocity = to_vec3(json["velocity"]);
    motion.angular_velocity = to_vec3(json["angular_velocity"]);
    motion.pivot = to_vec3(json["pivot"]);
    motion.start = to_double(json["start"]);
    motion.stop = to_time(json["stop"]);
    return motion;
}

std::vector<Vec3> to_points(const Json& values)
{
    std::vector<Vec3> points;
    for (const Json& value : values) points.push_back(to_vec3(value));
    return points;
}

ObstacleFile read_mesh(const SceneDocument& document, const LoadOptions& options, const std::string& key,
                       const Json& obstacle, RunConfig& config)
{
    const std::filesystem::path file(obstacle["file"].get<std::string>());
    ObstacleFileRequest request;
    request.path = (std::filesystem::path(document.path()).parent_path() / file).string();
    if (!obstacle["units"].is_null())
        request.metres_per_unit = metres_of(obstacle["units"].get<std::string>());
    if (!obstacle["up"].is_null()) request.up = obstacle["up"].get<std::string>()[0];
    request.importer = options.importer;
    ObstacleFile read = read_obstacle_file(request);
    for (const std::string& warning : read.warnings)
        config.warnings.push_back(fmt::format("{}: {}", document.describe(key), warning));
    for (const std::string& note : read.notes)
        config.notes.push_back(fmt::format("{}: {}", document.describe(key), note));
    return read;
}

ObstacleMesh to_teeth(const Json& teeth)
{
    return make_teeth({teeth["count"].get<int>(), to_double(teeth["pitch"]), to_double(teeth["height"]),
                       to_double(teeth["width"]), to_double(teeth["tip_degrees"])});
}

/// The key that defines the obstacle's shape.
std::string shape_of(const Json& obstacle)
{
    for (const char* shape : {"file", "box", "points", "wire"})
        if (obstacle.contains(shape)) return shape;
    return "teeth";
}

ObstacleFile make_mesh(const SceneDocument& document, const LoadOptions& options, const std::string& key,
                       const Json& obstacle, RunConfig& config)
{
    try {
        if (obstacle.contains("file")) return read_mesh(document, options, key, obstacle, config);
        ObstacleFile made;
        if (obstacle.contains("box"))
            made.mesh = make_box(to_vec3(obstacle["box"]));
        else if (obstacle.contains("points"))
            made.mesh = make_points(to_points(obstacle["points"]));
        else if (obstacle.contains("wire"))
            made.mesh = make_wire(to_points(obstacle["wire"]), obstacle["closed"].get<bool>());
        else
            made.mesh = to_teeth(obstacle["teeth"]);
        return made;
    } catch (const InputError& error) {
        document.fail(key, error.what());
    }
}

/// Scales the mesh about its origin. Refuses a mesh that rounding has made degenerate.
void scale_mesh(const SceneDocument& document, const std::string& path, const std::string& shape_key,
                double scale, ObstacleMesh& mesh)
{
    const std::string scale_key = path + ".scale";
    const std::string& key = document.find(scale_key) ? scale_key : shape_key;
    for (Vec3& point : mesh.points) {
        point *= scale;
        if (!(point.cwiseAbs().maxCoeff() <= kFarthest))
            document.fail(key, fmt::format("makes the obstacle reach beyond {:g} m", kFarthest),
                          "a smaller scale");
    }
    if (const std::string defect = validate(mesh); !defect.empty())
        document.fail(key, fmt::format("makes the obstacle invalid: {}", defect));
}

/// What the run has stored for the `index`-th obstacle, `plan`.
const ObstacleRecord& stored_record(const SceneDocument& document, const LoadOptions& options,
                                    std::size_t index, const ObstaclePlan& plan)
{
    const std::vector<ObstacleRecord>& stored = *options.obstacles;
    if (stored.empty())  // a run with obstacles has always stored them
        document.fail(fmt::format("obstacle.{}", index),
                      fmt::format("{} is missing, in which the run stored its obstacles",
                                  printable(options.obstacles_file)),
                      "the whole folder of a run; arris run with --overwrite starts the run again");
    if (index >= stored.size() || stored[index].name != plan.name)
        document.fail(fmt::format("obstacle.{}", index),
                      fmt::format("{} is not among the obstacles that the run stored in {}", plan.name,
                                  printable(options.obstacles_file)));
    return stored[index];
}

void check_sizes(const SceneDocument& document, const RunConfig& config)
{
    SceneEstimate estimate;
    estimate.vertices = config.cloth.vertex_count();
    estimate.faces = config.cloth.face_count();
    add_obstacles(config.scene.obstacles, estimate);
    if (estimate.obstacle_elements > kMaxObstacleElements)
        document.fail(
            "obstacle",
            fmt::format("the run would have {:.0f} triangles, wire segments and points of obstacles",
                        estimate.obstacle_elements),
            fmt::format("at most {:g}", kMaxObstacleElements));
    estimate_bytes(config.output.formats, estimate);
    if (const std::optional<Excess> excess = find_memory_excess(estimate, machine_memory_bytes()))
        document.fail("obstacle", excess->wrong, excess->allowed);
}

/// Advice for a cloth that starts in obstacle `i`. `is_enclosed`: the cloth is wholly inside.
std::string remedy(const RunConfig& config, std::size_t i, bool is_enclosed)
{
    const auto is_from_file = [](const nlohmann::ordered_json& json) { return json.contains("file"); };
    const std::vector<const nlohmann::ordered_json*> pieces = cloth_tables(config.as_run);
    const bool has_units =
        is_from_file(config.as_run["obstacle"][i]) ||
        std::any_of(pieces.begin(), pieces.end(), [&](const auto* piece) { return is_from_file(*piece); });
    const bool can_untangle = !is_enclosed && config.as_run["obstacle"][i]["start"] == "clear" &&
                              !config.scene.obstacles[i].shape().mesh().faces.empty();
    return fmt::format(
        "{}move the cloth or the obstacle ('translate') until they are at least {:g} m apart, the cloth's "
        "thickness{}{}",
        is_enclosed
            ? "the cloth is wholly inside a closed surface, which is solid whichever way its faces "
              "look; for a room around the cloth, leave out a face, or give the walls an inner and an "
              "outer surface; else "
            : "",
        config.scene.materials.thickness(), can_untangle ? ", or start = \"untangle\" of the obstacle" : "",
        has_units ? "; a file that is not in metres with z up needs 'units' or 'up'" : "");
}

}  // namespace

std::vector<ObstaclePlan> plan_obstacles(const Json& scene)
{
    std::vector<ObstaclePlan> plans;
    if (!scene.contains("obstacle")) return plans;
    for (const Json& obstacle : scene["obstacle"]) {
        ObstaclePlan plan;
        plan.name = obstacle["name"].get<std::string>();
        if (!obstacle.contains("keyframes"))
            plan.placement = {to_rotation(obstacle["rotate"]), to_vec3(obstacle["translate"])};
        plan.motion = to_motion(obstacle);
        plan.feature_angle = to_double(obstacle["feature_angle"]);
        plans.push_back(std::move(plan));
    }
    return plans;
}

/// Limits the rotation per step to what `find_motion_parts` can divide into quarter turns: contact search
/// uses an obstacle's placement only at the ends of a part.
void check_turn(const SceneDocument& document, const std::string& path, const Json& json, double step,
                const RigidMotion& motion)
{
    constexpr double kMostTurn = kMostMotionParts * std::numbers::pi / 2.0;
    const double turn = motion.fastest_turn() * step;
    if (!(turn > kMostTurn * (1.0 + 1e-9))) return;
    document.fail(path + (json.contains("keyframes") ? ".keyframes" : ".motion"),
                  fmt::format("rotates by {:.3g} rad in a step of {} s", turn, step),
                  "at most 16 turns (101 rad) per step; a shorter time.step allows faster rotation");
}

void load_obstacles(const SceneDocument& document, const LoadOptions& options,
                    std::vector<ObstaclePlan> plans, RunConfig& config)
{
    std::vector<RigidMotion> motions;
    for (const ObstaclePlan& plan : plans) motions.push_back(plan.motion);
    for (std::size_t i = 0; i < plans.size(); ++i) {
        const Json& json = config.as_run["obstacle"][i];
        const std::string path = fmt::format("obstacle.{}", i);
        const std::string key = fmt::format("{}.{}", path, shape_of(json));
        check_turn(document, path, json, config.settings.step, plans[i].motion);
        ObstacleMesh mesh;
        std::shared_ptr<const Deformation> deformation;
        if (options.obstacles) {
            const ObstacleRecord& stored = stored_record(document, options, i, plans[i]);
            mesh = stored.mesh;
            deformation = stored.deformation;
            if (json.contains("deform") != (deformation != nullptr))
                document.fail(path + ".deform",
                              fmt::format("contradicts {}, in which the run stored its obstacles",
                                          printable(options.obstacles_file)));
        } else {
            ObstacleFile made = make_mesh(document, options, key, json, config);
            scale_mesh(document, path, key, to_double(json["scale"]), made.mesh);
            if (json.contains("deform")) deformation = load_deformation(document, i, made, motions, config);
            mesh = std::move(made.mesh);
        }
        config.obstacle_placements.push_back(plans[i].placement);
        config.scene.obstacles.emplace_back(plans[i].name, std::move(mesh), plans[i].placement,
                                            std::move(plans[i].motion), plans[i].feature_angle,
                                            std::move(deformation));
    }
    if (!plans.empty()) check_sizes(document, config);
}

Box3 bounds_at(const MovingObstacle& obstacle, double time)
{
    const ObstaclePose pose = obstacle.at(time);
    Box3 box;
    for (const Vec3& point : pose->mesh().points) box.extend(pose.placement(point));
    return box;
}

namespace {

/// "the cloth", or the name of the piece that is nearest to a place.
std::string piece_in_words(const RunConfig& config, const ClothMesh& cloth, const Vec3& place)
{
    if (config.pieces.size() == 1) return "the cloth";
    int nearest = 0;
    for (int v = 1; v < cloth.vertex_count(); ++v)
        if ((cloth.world[v] - place).squaredNorm() < (cloth.world[nearest] - place).squaredNorm())
            nearest = v;
    return config.pieces[static_cast<std::size_t>(piece_of(config.scene, cloth, nearest))].name;
}

}  // namespace

std::vector<std::string> find_intersections(const SceneDocument& document, const RunConfig& config)
{
    std::vector<std::string> lines;
    if (config.scene.obstacles.empty() && !config.scene.self_contact) return lines;
    const ClothMesh start = make_state(config.scene, config.cloth, config.cloth_velocity).mesh;
    for (const Audit& audited : find_penetrations(config.scene, start, 0.0)) {
        const auto i = static_cast<std::size_t>(audited.obstacle);
        const auto& [depth, place] = std::pair(audited.found.depth, audited.found.place);
        const std::string how =
            depth > 0.0 ? fmt::format("reaches {:.3g} m deep into", depth) : std::string("intersects");
        lines.push_back(fmt::format(
            "{}: at time 0 {} {} {}, at [{:.6g}, {:.6g}, {:.6g}] (m); allowed: cloth that starts "
            "clear of every obstacle; {}",
            document.describe(fmt::format("obstacle.{}", i)), piece_in_words(config, start, place), how,
            config.scene.obstacles[i].name(), place.x(), place.y(), place.z(),
            remedy(config, i, depth > 0.0 && audited.found.faces == 0)));
    }
    if (const SelfCrossings crossed = find_self_crossings(config.scene, start); crossed.count > 0) {
        const std::string &one = config.pieces[static_cast<std::size_t>(crossed.pieces[0])].name,
                          &other = config.pieces[static_cast<std::size_t>(crossed.pieces[1])].name;
        lines.push_back(
            fmt::format("{}: at time 0 {} of faces of the cloth cross or touch, the first {}at [{:.6g}, "
                        "{:.6g}, {:.6g}] (m); "
                        "allowed: cloth that starts clear of itself{}{}",
                        document.describe("self_contact"), counted(crossed.count, "pair", "pairs"),
                        config.pieces.size() == 1 ? ""
                        : one == other            ? fmt::format("of {} with itself, ", one)
                                                  : fmt::format("of {} with {}, ", one, other),
                        crossed.place.x(), crossed.place.y(), crossed.place.z(),
                        config.as_run["self_contact"]["start"] == "clear" ? ", or start = \"untangle\"" : "",
                        one == other ? " (a fold of 180 degrees lies in itself: 179 is allowed)"
                                     : "; move one of them ('translate')"));
    }
    return lines;
}

void keep_stand_off(const StrainRange& placed, RunConfig& config)
{
    const int moved = clear_stand_off(config.scene, config.cloth);
    if (moved == 0) return;
    const double thickness = config.scene.materials.thickness();
    std::string line = fmt::format(
        "the cloth starts nearer to obstacles than its thickness, {:g} m: {} moved out to that distance",
        thickness, counted(moved, "vertex is", "vertices are"));
    const StrainRange strain = measure_strain(config.cloth);
    if (strain.is_surprising() && !placed.is_surprising())
        line += fmt::format(
            "; the cloth is then strained {} (mean edge {:.3g} m): reduce cloth.material.thickness, or start "
            "the cloth farther away ('translate')",
            in_words(strain),
            measure_edges(config.cloth, make_topology(config.cloth.vertex_count(), config.cloth.faces)).mean);
    config.warnings.push_back(line);
}

}  // namespace arris
