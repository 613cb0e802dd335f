// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/scene_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <set>
#include <utility>

#include "app/scene/cloth_rules.h"
#include "app/scene/keys/scene_keys.h"
#include "app/scene/parts/cloth_pieces.h"
#include "app/scene/parts/cloth_shapes.h"
#include "app/text/printable.h"
#include "geometry/obstacle_input/deform/vertex_cache.h"
#include "physics/elements/material.h"

namespace arris {
namespace {

using Json = nlohmann::ordered_json;

void fill_title(const SceneDocument& document, Json& scene)
{
    if (scene["title"].is_null())
        scene["title"] = printable(std::filesystem::path(document.path()).stem().string(), 199);
}

/// Requires that a pin, pull or probe names one of several pieces, or the only one if that has a name.
void check_piece(const SceneDocument& document, const std::string& path, const Json& scene, const Json& user)
{
    const std::vector<const Json*> tables = cloth_tables(scene);
    if (user.contains("label") && !user.contains("piece")) return;  // of all pieces
    std::string names;
    for (const Json* piece : tables) {
        if (!piece->contains("name")) continue;
        if (user.contains("piece") && user["piece"] == (*piece)["name"]) return;
        names += (names.empty() ? "" : ", ") + (*piece)["name"].get<std::string>();
    }
    const std::string key = path + ".piece";
    if (user.contains("piece"))
        document.fail(key, "is not a piece of cloth",
                      names.empty() ? "none, as [cloth] has no name" : "the name of a piece: " + names);
    if (tables.size() > 1)
        document.fail(key, "is required and missing, as there are several pieces of cloth",
                      "the name of a piece: " + names);
}

/// `chosen` excludes `others`: refuses them where written, else removes their defaults.
void settle_choice(const SceneDocument& document, const std::string& path, const std::string& chosen,
                   std::initializer_list<const char*> others, std::string_view allowed, Json& table)
{
    for (const char* other : others) {
        const std::string key = fmt::format("{}.{}", path, other);
        if (document.find(key)) document.fail(key, fmt::format("contradicts {}.{}", path, chosen), allowed);
        table.erase(other);
    }
}

void check_keyframes(const SceneDocument& document, const std::string& path, const Json& keyframes)
{
    if (keyframes.empty()) document.fail(path, "is empty", "one or more keyframes");
    for (std::size_t i = 1; i < keyframes.size(); ++i) {
        const double before = keyframes[i - 1]["time"].get<double>();
        if (!(keyframes[i]["time"].get<double>() > before))
            document.fail(fmt::format("{}.{}.time", path, i), "is not later than the previous keyframe",
                          fmt::format("a number > {} (s)", before));
    }
}

/// Requires one way of saying what a pin holds: a box, vertices, or a label.
void settle_pin_region(const SceneDocument& document, const std::string& path, Json& pin)
{
    constexpr std::string_view kAllowed = "one of material, vertices, label";
    if (pin.contains("label"))
        settle_choice(document, path, "label", {"material", "vertices", "panel"}, kAllowed, pin);
    else if (pin.contains("vertices"))
        settle_choice(document, path, "vertices", {"material", "panel"}, kAllowed, pin);
    else if (!pin.contains("material"))
        document.fail(path + ".material", "is required and missing",
                      "[[u, v], [u, v]] (m), or pin.vertices, or pin.label");
}

/// Refuses a pin that follows an unknown obstacle.
void check_followed(const SceneDocument& document, const std::string& key, const Json& pin, const Json& scene)
{
    std::string names;
    if (scene.contains("obstacle")) {
        for (const Json& obstacle : scene["obstacle"]) {
            if (obstacle["name"] == pin["follow"]) return;
            names += (names.empty() ? "" : ", ") + obstacle["name"].get<std::string>();
        }
    }
    document.fail(key, "is not an obstacle",
                  names.empty() ? "the name of an [[obstacle]]; this scene has none"
                                : "the name of an obstacle: " + names);
}

/// Requires one way of moving a pin: velocities, keyframes, or an obstacle to follow.
void settle_pin_motion(const SceneDocument& document, const std::string& path, const Json& scene, Json& pin)
{
    if (pin.contains("follow")) {
        settle_choice(document, path, "follow", {"velocity", "angular_velocity", "pivot", "keyframes"},
                      "either follow, or velocity, angular_velocity and pivot, or keyframes", pin);
        check_followed(document, path + ".follow", pin, scene);
    }
    if (pin.contains("keyframes")) {
        settle_choice(document, path, "keyframes", {"velocity", "angular_velocity", "pivot"},
                      "either velocity, angular_velocity and pivot, or keyframes", pin);
        check_keyframes(document, path + ".keyframes", pin["keyframes"]);
    }
}

/// Requires that a pin with a later start is released after it. Without one, `release = 0` switches it off.
void check_pin_times(const SceneDocument& document, const std::string& path, const Json& pin)
{
    const double start = pin["start"].get<double>();
    if (!(start > 0.0) || pin["release"].is_null() || pin["release"].get<double>() > start) return;
    document.fail(path + ".release", "is not later than the pin's start",
                  fmt::format("a number > {} (s)", start));
}

/// Requires a file of positions in time; glTF moves itself, and nothing else.
void settle_deform(const SceneDocument& document, const std::string& path, const Json& mesh, Json& deform)
{
    const bool is_gltf = is_gltf_file(mesh.get<std::string>());
    const std::string key = path + ".file";
    if (deform["file"].is_null() && !is_gltf)
        document.fail(key, "is required and missing", "a file of positions in time, or a glTF obstacle");
    if (deform["file"].is_null()) deform["file"] = mesh;
    const std::string file = deform["file"].get<std::string>();
    if ((is_gltf || is_gltf_file(file)) && deform["file"] != mesh)
        document.fail(key, "contradicts the obstacle's file",
                      "a glTF file that moves itself, or another format for both");
    if (!deform["prim"].is_null() && !is_usd_file(file))
        document.fail(path + ".prim", fmt::format("contradicts {}", key), "no prim, or a USD file");
    if (!deform["animation"].is_null() && !is_gltf)
        document.fail(path + ".animation", fmt::format("contradicts {}", key),
                      "no animation, or a glTF file");
}

/// Requires exactly one shape, and removes the keys that only other shapes have.
void settle_shape(const SceneDocument& document, const std::string& path, Json& obstacle)
{
    constexpr std::string_view kAllowed = "one of file, box, points, wire, teeth";
    std::string shape;
    for (const char* key : {"file", "box", "points", "wire", "teeth"}) {
        if (!obstacle.contains(key)) continue;
        if (!shape.empty())
            document.fail(fmt::format("{}.{}", path, key), fmt::format("contradicts {}.{}", path, shape),
                          kAllowed);
        shape = key;
    }
    if (shape.empty()) document.fail(path, "has no shape", kAllowed);
    if (shape != "file") {
        obstacle.erase("units");
        obstacle.erase("up");
    }
    if (shape != "wire") obstacle.erase("closed");
    if (shape != "file" && obstacle.contains("deform"))
        document.fail(fmt::format("{}.deform", path), fmt::format("contradicts {}.{}", path, shape),
                      "a deforming obstacle whose shape is a file");
    if (obstacle.contains("deform"))
        settle_deform(document, path + ".deform", obstacle["file"], obstacle["deform"]);
    // The limbs of a body have sides that turn by more than 14 degrees, and are not sharp.
    if (obstacle["feature_angle"].is_null())
        obstacle["feature_angle"] = obstacle.contains("deform") ? 45.0 : 14.0;
}

void settle_obstacle_motion(const SceneDocument& document, const std::string& path, Json& obstacle)
{
    if (obstacle.contains("keyframes")) {
        settle_choice(document, path, "keyframes", {"motion", "translate", "rotate"},
                      "either motion, translate and rotate, or keyframes", obstacle);
        check_keyframes(document, path + ".keyframes", obstacle["keyframes"]);
    }
    if (!obstacle.contains("motion")) return;
    const Json& motion = obstacle["motion"];
    const double start = motion["start"].get<double>();
    if (!motion["stop"].is_null() && !(motion["stop"].get<double>() > start))
        document.fail(path + ".motion.stop", "is not later than the motion's start",
                      fmt::format("a number > {} (s)", start));
}

void settle_obstacles(const SceneDocument& document, Json& obstacles)
{
    // Each obstacle costs one pass over the cloth per step.
    constexpr std::size_t kMostObstacles = 1000;
    if (obstacles.size() > kMostObstacles)
        document.fail(
            fmt::format("obstacle.{}", kMostObstacles),
            fmt::format("is one of {} obstacles", obstacles.size()),
            fmt::format("at most {}; one file or one list of points may hold many objects", kMostObstacles));
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
        const std::string path = fmt::format("obstacle.{}", i);
        if (obstacles[i]["name"].is_null()) obstacles[i]["name"] = fmt::format("obstacle{}", i);
        settle_shape(document, path, obstacles[i]);
        settle_obstacle_motion(document, path, obstacles[i]);
    }
}

void check_pull_times(const SceneDocument& document, const std::string& path, const Json& pull)
{
    const double start = pull["start"].get<double>();
    if (pull["stop"].is_null() || pull["stop"].get<double>() > start) return;
    document.fail(path + ".stop", "is not later than the pull's start",
                  fmt::format("a number > {} (s)", start));
}

void check_edge_lengths(const SceneDocument& document, const Json& remesh)
{
    const double least = remesh["edge_length"][0].get<double>();
    if (remesh["edge_length"][1].get<double>() > least) return;
    document.fail("remesh.edge_length", "has a largest edge length that is not above the smallest",
                  fmt::format("two lengths, the second > {} (m)", least));
}

double greatest_thickness(const Json& scene)
{
    double greatest = 0.0;
    for (const Json* material : material_tables(scene))
        greatest = std::max(greatest, (*material)["thickness"].get<double>());
    return greatest;
}

/// Contact between layers takes from other tables what its own does not name.
void fill_self_contact(Json& scene)
{
    Json& layers = scene["self_contact"];
    if (!layers.contains("thickness")) layers["thickness"] = greatest_thickness(scene);
    const std::vector<const Json*> materials = material_tables(std::as_const(scene));
    const bool has_own = std::any_of(materials.begin(), materials.end(),
                                     [](const Json* material) { return material->contains("friction"); });
    if (!layers.contains("friction") && scene.contains("friction") && !has_own)
        layers["friction"] = scene["friction"]["coefficient"];
}

/// Requires unique names of pieces, obstacles and probes, none of them "cloth".
void check_names(const SceneDocument& document, const Json& scene)
{
    std::map<std::string, std::string> seen = {{"cloth", "the cloth"}};
    const auto check = [&](const std::string& path, const Json& element) {
        if (!element.contains("name")) return;
        const std::string name = element["name"].get<std::string>();
        const auto [other, is_new] = seen.emplace(name, path);
        if (is_new) return;
        const bool is_default = document.find(path + ".name") == nullptr;
        document.fail(path + ".name",
                      fmt::format("{}is already the name of {}",
                                  is_default ? fmt::format("the default {} ", name) : "", other->second),
                      "a unique name other than cloth");
    };
    const std::vector<const Json*> pieces = cloth_tables(scene);
    for (std::size_t i = 0; i < pieces.size(); ++i) check(cloth_key(scene, i), *pieces[i]);
    for (const char* table : {"obstacle", "probe"}) {
        const Json elements = scene.value(table, Json::array());
        for (std::size_t i = 0; i < elements.size(); ++i) check(fmt::format("{}.{}", table, i), elements[i]);
    }
}

}  // namespace

void apply_scene_rules(const SceneDocument& document, Json& scene)
{
    fill_title(document, scene);
    settle_pieces(document, scene);
    if (scene.contains("self_contact")) fill_self_contact(scene);
    if (scene.contains("obstacle")) settle_obstacles(document, scene["obstacle"]);
    if (scene.contains("pin"))
        for (std::size_t i = 0; i < scene["pin"].size(); ++i) {
            settle_pin_region(document, fmt::format("pin.{}", i), scene["pin"][i]);
            settle_pin_motion(document, fmt::format("pin.{}", i), scene, scene["pin"][i]);
            check_pin_times(document, fmt::format("pin.{}", i), scene["pin"][i]);
        }
    if (scene.contains("pull"))
        for (std::size_t i = 0; i < scene["pull"].size(); ++i)
            check_pull_times(document, fmt::format("pull.{}", i), scene["pull"][i]);
    check_names(document, scene);
    for (const char* table : {"pin", "pull", "probe"}) {
        const Json users = scene.value(table, Json::array());
        for (std::size_t i = 0; i < users.size(); ++i)
            check_piece(document, fmt::format("{}.{}", table, i), scene, users[i]);
    }
    if (scene.contains("remesh")) check_edge_lengths(document, scene["remesh"]);
}

}  // namespace arris
