// SPDX-License-Identifier: GPL-3.0-or-later
// Turns a scene file into a RunConfig. Cheap checks come first: each key by itself (scene_values), rules
// between keys (scene_rules), the size of the run (scene_estimate). The cloth, its pins, pulls and probes,
// and the obstacles follow.
#include "app/scene/scene_load.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include "app/scene/keys/scene_document.h"
#include "app/scene/keys/scene_json.h"
#include "app/scene/keys/scene_values.h"
#include "app/scene/parts/merge_events.h"
#include "app/scene/parts/scene_cloth.h"
#include "app/scene/parts/scene_estimate.h"
#include "app/scene/parts/scene_obstacles.h"
#include "app/scene/parts/scene_remeshing.h"
#include "app/scene/parts/start_strain.h"
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

/// The piece that a pin, pull or probe names; the only one where it names none.
const ClothPiece& piece_of(const RunConfig& config, const Json& user)
{
    if (!user.contains("piece")) return config.pieces.front();
    return *std::find_if(config.pieces.begin(), config.pieces.end(),
                         [&](const ClothPiece& piece) { return piece.name == user["piece"]; });
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
std::optional<Friction> to_friction(const Json& json)
{
    const bool is_on = json.contains("friction");
    const double common = is_on ? to_double(json["friction"]["coefficient"]) : 0.0;
    Friction friction;
    bool has_own = false;
    for (const Json* piece : piece_tables(json)) {
        const Json& material = (*piece)["material"];
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
    scene.materials = to_material((*piece_tables(json).front())["material"]);
    if (json.contains("gravity")) scene.gravity = Gravity{to_vec3(json["gravity"]["acceleration"])};
    if (json.contains("wind")) scene.wind = to_wind(json["wind"]);
    for (const Json& pull : json.value("pull", Json::array()))
        scene.pulls.push_back({{}, to_vec3(pull["force"]), to_double(pull["start"]), to_time(pull["stop"])});
    for (const Json& pin : json.value("pin", Json::array())) scene.pins.push_back(to_pin(json, pin));
    scene.friction = to_friction(json);
    if (json.contains("self_contact"))
        scene.self_contact = ClothContact{to_double(json["self_contact"]["thickness"])};
    return scene;
}

/// The vertices of the first mesh that pin i names by their numbers in a piece's file or mesh.
std::vector<int> find_pinned(const SceneDocument& document, std::size_t i, const RunConfig& config)
{
    const Json& pin = config.as_run["pin"][i];
    const ClothPiece& piece = piece_of(config, pin);
    std::int64_t before = 0;  // vertices of the pieces before it
    for (const ClothPiece* other = config.pieces.data(); other != &piece; ++other) before += other->vertices;
    const std::vector<int>& of_file = piece.file_vertices;
    const int count = of_file.empty() ? piece.vertices : static_cast<int>(of_file.size());
    std::vector<int> vertices;
    for (std::size_t k = 0; k < pin["vertices"].size(); ++k) {
        const int number = pin["vertices"][k].get<int>();
        const std::string key = fmt::format("pin.{}.vertices.{}", i, k);
        if (number >= count)
            document.fail(key, "is not a vertex of the cloth",
                          fmt::format("an integer from 0 to {}", count - 1));
        const int vertex = of_file.empty() ? number : of_file[static_cast<std::size_t>(number)];
        if (vertex < 0)
            document.fail(key, "is a vertex that no face of the cloth's file uses", "vertices of its faces");
        if (before + vertex >= config.cloth.vertex_count())  // of a resumed run, whose counts are untrusted
            document.fail(key, "is not a vertex of the run's first mesh", "vertices of the cloth");
        vertices.push_back(static_cast<int>(before + vertex));
    }
    sort_unique(vertices);
    return vertices;
}

/// Adds materials, velocities, pins, pulls and probes, which need to know where pieces are in the plane.
void place_in_material(const SceneDocument& document, RunConfig& config)
{
    const Json& json = config.as_run;
    const std::vector<const Json*> tables = piece_tables(json);
    for (std::size_t i = 1; i < tables.size(); ++i)
        config.scene.materials.add(config.pieces[i].begin, to_material((*tables[i])["material"]));
    config.scene.pieces.assign(config.pieces.begin(), config.pieces.end());
    for (int v = 0; v < config.cloth.vertex_count(); ++v)
        config.cloth_velocity.push_back(to_vec3(
            (*tables[static_cast<std::size_t>(piece_of(config.scene, config.cloth, v))])["velocity"]));
    for (std::size_t i = 0; i < config.scene.pins.size(); ++i) {
        const Json& pin = json["pin"][i];
        config.scene.pins[i].material =
            pin.contains("vertices")
                ? MaterialRegion::between(config.cloth, find_pinned(document, i, config))
                : MaterialRegion(piece_of(config, pin).to_plane(to_material_box(pin["material"])));
    }
    for (std::size_t i = 0; i < config.scene.pulls.size(); ++i) {
        const Json& pull = json["pull"][i];
        config.scene.pulls[i].material = piece_of(config, pull).to_plane(to_material_box(pull["material"]));
    }
    for (const Json& probe : json.value("probe", Json::array()))
        config.probes.push_back(
            {probe["name"].get<std::string>(), piece_of(config, probe).to_plane(to_vec2(probe["material"]))});
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

// ---- pins, pulls, probes and obstacles against the cloth

/// The material points of a piece, in its own coordinates.
std::vector<Vec2> material_of(const RunConfig& config, const ClothPiece& piece)
{
    std::vector<Vec2> material;
    for (const Vec2& X : config.cloth.material)
        if (X.x() >= piece.begin && X.x() < piece.end) material.push_back(piece.from_plane(X));
    return material;
}

[[noreturn]] void refuse_miss(const SceneDocument& document, const std::string& key, const RunConfig& config,
                              const ClothPiece& piece, std::string_view wrong)
{
    const std::vector<Vec2> material = material_of(config, piece);
    Vec2 least = material.front(), greatest = least;
    for (const Vec2& X : material) {
        least = least.cwiseMin(X);
        greatest = greatest.cwiseMax(X);
    }
    document.fail(
        key, wrong,
        fmt::format("material coordinates of the cloth, within [[{:.6g}, {:.6g}], [{:.6g}, {:.6g}]] (m)",
                    least.x(), least.y(), greatest.x(), greatest.y()));
}

/// Warns of keyframes that move the cloth from its placement at time 0.
void warn_of_first_keyframes(const SceneDocument& document, RunConfig& config)
{
    const double tolerance = 1e-12 * (1.0 + material_size(config.cloth.material));
    for (std::size_t i = 0; i < config.scene.pins.size(); ++i) {
        const Pin& pin = config.scene.pins[i];
        if (pin.motion.keyframes.empty() || !pin.holds(0.0, 0.0)) continue;
        const Placement first = pin.motion.at(0.0);
        int moved = 0;
        for (const int v : vertices_inside(config.cloth, pin.material)) {
            Vec3 way = first(config.cloth.world[v]) - config.cloth.world[v];
            for (int d = 0; d < 3; ++d)
                if (!pin.held[d]) way[d] = 0.0;
            if (way.norm() > tolerance) ++moved;
        }
        if (moved > 0)
            config.warnings.push_back(fmt::format("{}: moves {} from the initial placement at time 0",
                                                  document.describe(fmt::format("pin.{}.keyframes", i)),
                                                  counted(moved, "vertex", "vertices")));
    }
}

void check_meetings(const SceneDocument& document, const RunConfig& config)
{
    const ClothMesh& cloth = config.cloth;
    for (std::size_t i = 0; i < config.scene.pins.size(); ++i) {
        if (!vertices_inside(cloth, config.scene.pins[i].material).empty()) continue;
        const Json& pin = config.as_run["pin"][i];
        const MaterialBox box = to_material_box(pin["material"]);
        const Vec2 middle = 0.5 * (box.min + box.max);
        const ClothPiece& piece = piece_of(config, pin);
        const std::vector<Vec2> material = material_of(config, piece);
        const Vec2 nearest =
            *std::min_element(material.begin(), material.end(), [&](const Vec2& a, const Vec2& b) {
                return (a - middle).squaredNorm() < (b - middle).squaredNorm();
            });
        refuse_miss(document, fmt::format("pin.{}.material", i), config, piece,
                    fmt::format("holds no vertex of the cloth; the nearest is at [{:.6g}, {:.6g}]",
                                nearest.x(), nearest.y()));
    }
    for (std::size_t i = 0; i < config.scene.pulls.size(); ++i)
        if (spread_over_box(cloth, config.scene.pulls[i].material).empty())
            refuse_miss(document, fmt::format("pull.{}.material", i), config,
                        piece_of(config, config.as_run["pull"][i]), "contains no cloth");
    for (std::size_t i = 0; i < config.probes.size(); ++i)
        if (const ClothPiece& piece = piece_of(config, config.as_run["probe"][i]);
            locate(cloth, config.probes[i].material).face < 0 ||
            !(config.probes[i].material.x() >= piece.begin && config.probes[i].material.x() < piece.end))
            refuse_miss(document, fmt::format("probe.{}.material", i), config, piece, "is not on the cloth");
}

/// Checks that the cloth starts clear of the obstacles, and moves it out to its stand-off.
void check_start(const SceneDocument& document, const LoadOptions& options, const StrainRange& placed,
                 RunConfig& config)
{
    config.intersections = find_intersections(document, config);
    if (config.intersections.empty())
        keep_stand_off(placed, config);
    else if (!options.tells_intersections)
        throw InputError(config.intersections.front());
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
    place_in_material(document, config);
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
    if (!options.cloth) check_start(document, options, placed, config);
    warn_of_first_keyframes(document, config);

    const std::vector<std::string> ineffective = find_ineffective_keys(document, config, of_pieces);
    config.warnings.insert(config.warnings.end(), ineffective.begin(), ineffective.end());
    return config;
}

}  // namespace arris
