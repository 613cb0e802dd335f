// SPDX-License-Identifier: GPL-3.0-or-later
// Turns a scene file into a RunConfig. Cheap checks come first: each key by itself (scene_values), rules
// between keys (scene_rules), the size of the run (scene_estimate). The cloth, its pins, pulls and probes,
// and the obstacles follow.
#include "app/scene/scene_load.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>

#include "app/scene/keys/scene_document.h"
#include "app/scene/keys/scene_json.h"
#include "app/scene/keys/scene_values.h"
#include "app/scene/material_users.h"
#include "app/scene/parts/assembly.h"
#include "app/scene/parts/merge_events.h"
#include "app/scene/parts/scene_cloth.h"
#include "app/scene/parts/scene_estimate.h"
#include "app/scene/parts/scene_obstacles.h"
#include "app/scene/parts/scene_remeshing.h"
#include "app/scene/parts/start_strain.h"
#include "app/scene/parts/start_untangling.h"
#include "app/scene/scene_rules.h"
#include "app/scene/warnings/scene_warnings.h"
#include "app/text/counted.h"
#include "geometry/cloth/material_locator.h"
#include "geometry/input_error.h"
#include "geometry/sort_unique.h"
#include "geometry/surgery/initial_target.h"

namespace arris {
namespace {

using Json = nlohmann::ordered_json;

// ---- from JSON to the types of the solver

RigidMotion to_pin_motion(const Json& pin)
{
    RigidMotion motion;
    if (pin.contains("follow")) return motion;
    if (pin.contains("keyframes")) {
        motion.keyframes = to_keyframes(pin["keyframes"]);
        return motion;
    }
    motion.velocity = to_vec3(pin["velocity"]);
    motion.angular_velocity = to_vec3(pin["angular_velocity"]);
    motion.pivot = to_vec3(pin["pivot"]);
    motion.start = to_double(pin["start"]);
    return motion;
}

/// Index of the obstacle called `name`, which must exist.
int find_obstacle(const Json& obstacles, const Json& name)
{
    int index = 0;
    while (obstacles[static_cast<std::size_t>(index)]["name"] != name) ++index;
    return index;
}

Pin to_pin(const Json& scene, const Json& json)
{
    Pin pin;
    pin.motion = to_pin_motion(json);
    pin.held = {false, false, false};
    for (const Json& direction : json["directions"]) pin.held[direction.get<std::string>()[0] - 'x'] = true;
    pin.start = to_double(json["start"]);
    pin.release = to_time(json["release"]);
    if (json.contains("follow")) pin.follows = find_obstacle(scene["obstacle"], json["follow"]);
    return pin;
}

Wind to_wind(const Json& json)
{
    Wind wind;
    wind.velocity = to_vec3(json["velocity"]);
    wind.air_density = to_double(json["air_density"]);
    wind.drag = to_double(json["drag"]);
    if (json.contains("gust"))
        wind.gust = Gust{to_double(json["gust"]["amplitude"]), to_double(json["gust"]["frequency"]),
                         json["gust"]["seed"].get<long>()};
    return wind;
}

Material to_material(const Json& json)
{
    return {to_double(json["density"]),
            to_double(json["youngs_modulus"]),
            to_double(json["poisson_ratio"]),
            to_double(json["bending_stiffness"]),
            to_double(json["damping"]),
            to_double(json["thickness"]),
            json["bending_model"] == "plate" ? BendingModel::Plate : BendingModel::Hinge,
            to_double(json["compression_modulus"])};
}

/// Nothing where neither [friction] nor a coefficient of a piece, an obstacle or the layers is given.
std::optional<Friction> to_friction(const RunConfig& config)
{
    const Json& json = config.as_run;
    const bool is_on = json.contains("friction");
    const double common = is_on ? to_double(json["friction"]["coefficient"]) : 0.0;
    Friction friction;
    bool has_own = false;
    for (const ClothPiece& piece : config.pieces) {
        const Json& material = material_of(json, piece);
        const bool is_own = material.contains("friction");
        friction.of_pieces.push_back(is_own ? to_double(material["friction"]) : common);
        has_own = has_own || is_own;
    }
    if (json.contains("self_contact") && json["self_contact"].contains("friction")) {
        friction.between_layers = to_double(json["self_contact"]["friction"]);
        has_own = true;
    }
    for (const Json& obstacle : json.value("obstacle", Json::array())) {
        const bool is_own = obstacle.contains("friction");
        friction.of_obstacles.push_back(is_own ? std::optional(to_double(obstacle["friction"]))
                                               : std::nullopt);
        has_own = has_own || is_own;
    }
    if (!is_on && !has_own) return std::nullopt;
    return friction;
}

Scene to_scene(const Json& json)
{
    Scene scene;
    if (json.contains("gravity")) scene.gravity = Gravity{to_vec3(json["gravity"]["acceleration"])};
    if (json.contains("wind")) scene.wind = to_wind(json["wind"]);
    for (const Json& pull : json.value("pull", Json::array()))
        scene.pulls.push_back({{}, to_vec3(pull["force"]), to_double(pull["start"]), to_time(pull["stop"])});
    for (const Json& pin : json.value("pin", Json::array())) scene.pins.push_back(to_pin(json, pin));
    if (json.contains("self_contact"))
        scene.self_contact = ClothContact{to_double(json["self_contact"]["thickness"])};
    return scene;
}

/// Adds materials, friction and velocities, which need to know the pieces.
void add_materials(RunConfig& config)
{
    const Json& json = config.as_run;
    config.scene.materials = to_material(material_of(json, config.pieces.front()));
    for (std::size_t i = 1; i < config.pieces.size(); ++i)
        config.scene.materials.add(config.pieces[i].begin, to_material(material_of(json, config.pieces[i])));
    config.scene.friction = to_friction(config);
    config.scene.pieces.assign(config.pieces.begin(), config.pieces.end());
    std::vector<Vec3> velocities;
    for (const ClothPiece& piece : config.pieces)
        velocities.push_back(to_vec3(table_of(json, piece)["velocity"]));
    for (int v = 0; v < config.cloth.vertex_count(); ++v)
        config.cloth_velocity.push_back(
            velocities[static_cast<std::size_t>(piece_of(config.scene, config.cloth, v))]);
}

/// How seams that are open close: at the least speed of several cloths, with the longest time to settle.
void add_sewing(const SceneDocument& document, RunConfig& config)
{
    if (config.seams.empty()) return;
    Sewing sewing;
    sewing.seams.assign(config.seams.begin(), config.seams.end());
    sewing.settle = 0.0;
    sewing.speed = std::numeric_limits<double>::infinity();
    for (const Json* cloth : cloth_tables(std::as_const(config.as_run))) {
        if (!cloth->contains("assembly")) continue;
        sewing.speed = std::min(sewing.speed, to_double((*cloth)["assembly"]["speed"]));
        sewing.settle = std::max(sewing.settle, to_double((*cloth)["assembly"]["settle"]));
    }
    if (!std::isfinite(sewing.speed)) {  // of stitches in a file, without a table
        sewing.speed = Sewing().speed;
        sewing.settle = Sewing().settle;
    }
    config.scene.sewing = std::move(sewing);
    if (needs_assembly(config) && !config.scene.self_contact)
        document.fail("self_contact", "is required and missing, as seams are to be closed",
                      "[self_contact], so that no panel passes through another");
}

Settings to_settings(const Json& json)
{
    Settings settings;
    settings.integrator = json["time"]["integrator"] == "bdf2" ? Integrator::Bdf2 : Integrator::ImplicitEuler;
    settings.step = to_double(json["time"]["step"]);
    settings.tolerance = to_double(json["solver"]["tolerance"]);
    return settings;
}

// ---- size of the run

/// Times at which the input jumps, including those of obstacles that are not yet in the scene.
std::vector<double> all_jumps(const Scene& scene, const std::vector<ObstaclePlan>& plans)
{
    std::vector<double> times = input_jumps(scene);
    for (const ObstaclePlan& plan : plans) {
        const std::vector<double> jumps = plan.motion.jumps();
        times.insert(times.end(), jumps.begin(), jumps.end());
    }
    sort_unique(times);
    return times;
}

void check_length(const SceneDocument& document, const RunConfig& config,
                  const std::vector<ObstaclePlan>& plans)
{
    SceneEstimate estimate;
    // Report the key if it is written, since that is what the user would change; else the duration.
    const auto written = [&](const std::string& key) { return document.find(key) ? key : "duration"; };
    const double fps = config.output.frames_per_second, step = config.settings.step;
    estimate.frames = count_frames(config.duration, fps);
    if (estimate.frames > kMaxFrames)
        refuse_estimate(document, written("output.frames_per_second"), estimate.frames, "frames", kMaxFrames);
    estimate.steps = config.duration / step;
    if (estimate.steps <= kMaxSteps)
        estimate.steps = count_steps(config.duration, step, fps, all_jumps(config.scene, plans));
    if (estimate.steps > kMaxSteps)
        refuse_estimate(document, written("time.step"), estimate.steps, "steps", kMaxSteps);
}

/// Checks that the cloth starts clear of the obstacles. Cloth that is made is moved out to its stand-off.
void check_start(const SceneDocument& document, const LoadOptions& options, const StrainRange& placed,
                 RunConfig& config)
{
    const std::string left = options.cloth ? "" : untangle_start(document, config);
    config.intersections = find_intersections(document, config);
    if (!config.intersections.empty() && !left.empty()) config.intersections.front() += "; " + left;
    if (!config.intersections.empty() && !options.tells_intersections)
        throw InputError(config.intersections.front());
    if (!options.cloth && config.intersections.empty()) keep_stand_off(placed, config);
}

}  // namespace

std::vector<ObstacleRecord> record_obstacles(const RunConfig& config)
{
    std::vector<ObstacleRecord> records;
    for (std::size_t i = 0; i < config.scene.obstacles.size(); ++i) {
        const MovingObstacle& obstacle = config.scene.obstacles[i];
        records.push_back({obstacle.name(), obstacle.shape().mesh(), config.obstacle_placements[i],
                           obstacle.motion(), obstacle.deformation()});
    }
    return records;
}

SceneSource read_scene_source(const std::string& path, const std::vector<std::string>& overrides)
{
    return {path, read_scene_text(path), overrides};
}

RunConfig load_scene(const SceneSource& source, const LoadOptions& options)
{
    SceneDocument document(source.path, source.text);
    for (const std::string& assignment : source.overrides) document.set(assignment);

    RunConfig config;
    config.as_run = complete_scene(document);
    apply_scene_rules(document, config.as_run);

    const Json& json = config.as_run;
    config.title = json["title"].get<std::string>();
    config.duration = to_double(json["duration"]);
    config.scene = to_scene(json);
    config.settings = to_settings(json);
    config.output.frames_per_second = to_double(json["output"]["frames_per_second"]);
    config.output.formats = json["output"]["formats"].get<std::vector<std::string>>();
    config.pieces = list_pieces(json);

    std::vector<ObstaclePlan> plans = plan_obstacles(json);
    std::vector<RigidMotion*> motions;
    for (ObstaclePlan& plan : plans) motions.push_back(&plan.motion);
    merge_events(config, motions);
    check_length(document, config, plans);
    options.cloth ? take_scene_cloth(options, config) : make_scene_cloth(document, config);
    add_materials(config);
    place_in_material(document, config);
    add_sewing(document, config);
    check_meetings(document, config);
    load_obstacles(document, options, std::move(plans), config);
    if (json["eol"]["enabled"].get<bool>() && has_features(config.scene))
        config.scene.eol = make_initial_target(config.cloth);
    if (json.contains("remesh")) config.scene.remesh = to_remeshing(document, config);
    if (config.pieces.size() > 1) {
        const std::vector<double> lengths = mean_edges(config);
        if (config.scene.eol) config.scene.eol->mean_lengths = lengths;
        if (config.scene.remesh) config.scene.remesh->initial.mean_lengths = lengths;
    }
    StrainRange placed;
    std::vector<StrainRange> of_pieces;
    for (std::size_t i = 0; i < config.pieces.size(); ++i) {
        of_pieces.push_back(measure_strain(extract_piece(config, i)));
        placed.extend(of_pieces.back());
    }
    if (!options.cloth || options.is_start) check_start(document, options, placed, config);
    warn_of_first_keyframes(document, config);

    const std::vector<std::string> ineffective = find_ineffective_keys(document, config, of_pieces);
    config.warnings.insert(config.warnings.end(), ineffective.begin(), ineffective.end());
    return config;
}

}  // namespace arris
