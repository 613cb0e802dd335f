// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene_rules.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "app/printable.h"
#include "app/scene_keys.h"
#include "physics/material.h"

namespace arris {
namespace {

using Json = nlohmann::ordered_json;

void fill_title(const SceneDocument& document, Json& scene)
{
    if (scene["title"].is_null())
        scene["title"] = printable(std::filesystem::path(document.path()).stem().string(), 199);
}

void fill_material(Json& material)
{
    const auto fill = [&](const char* key, double value) {
        if (material[key].is_null()) material[key] = value;
    };
    const Material preset = find_material_preset(material["preset"].get<std::string>()).value();
    fill("density", preset.density);
    fill("youngs_modulus", preset.youngs_modulus);
    fill("poisson_ratio", preset.poisson_ratio);
    fill("bending_stiffness", preset.bending_stiffness);
}

/// A cloth is a rectangle or a file.
void settle_cloth_source(const SceneDocument& document, Json& cloth)
{
    if (!cloth.contains("file")) {
        for (const std::string key : {"cloth.size", "cloth.resolution"})
            if (!document.find(key))
                document.fail(key, "is required and missing (or else cloth.file)",
                              allowed_values(*find_scene_key(key)));
        cloth.erase("units");
        cloth.erase("up");
        return;
    }
    for (const std::string key : {"size", "resolution", "pattern", "pattern_angle", "folds"}) {
        if (document.find("cloth." + key))
            document.fail("cloth." + key, "contradicts cloth.file",
                          "either a rectangle's keys or cloth.file");
        cloth.erase(key);
    }
}

/// A pin moves by velocities or by keyframes.
void settle_pin_motion(const SceneDocument& document, const std::string& path, Json& pin)
{
    if (!pin.contains("keyframes")) return;
    for (const std::string key : {"velocity", "angular_velocity", "pivot"}) {
        if (document.find(fmt::format("{}.{}", path, key)))
            document.fail(fmt::format("{}.{}", path, key), fmt::format("contradicts {}.keyframes", path),
                          "either velocity, angular_velocity and pivot, or keyframes");
        pin.erase(key);
    }
    const Json& keyframes = pin["keyframes"];
    if (keyframes.empty()) document.fail(path + ".keyframes", "is empty", "one or more keyframes");
    for (std::size_t i = 1; i < keyframes.size(); ++i) {
        const double before = keyframes[i - 1]["time"].get<double>();
        if (!(keyframes[i]["time"].get<double>() > before))
            document.fail(fmt::format("{}.keyframes.{}.time", path, i),
                          "is not later than the keyframe before", fmt::format("a number > {} (s)", before));
    }
}

void check_pull_times(const SceneDocument& document, const std::string& path, const Json& pull)
{
    const double start = pull["start"].get<double>();
    if (pull["stop"].is_null() || pull["stop"].get<double>() > start) return;
    document.fail(path + ".stop", "is not later than the pull's start",
                  fmt::format("a number > {} (s)", start));
}

/// Names are unique, and none is the cloth's.
void check_names(const SceneDocument& document, const Json& scene)
{
    std::map<std::string, std::string> seen = {{"cloth", "the cloth"}};
    const Json probes = scene.value("probe", Json::array());
    for (std::size_t i = 0; i < probes.size(); ++i) {
        const std::string path = fmt::format("probe.{}", i);
        const auto [other, is_new] = seen.emplace(probes[i]["name"].get<std::string>(), path);
        if (!is_new)
            document.fail(path + ".name", fmt::format("is the name of {} already", other->second),
                          "a name of its own, not cloth");
    }
}

}  // namespace

void apply_scene_rules(const SceneDocument& document, Json& scene)
{
    fill_title(document, scene);
    fill_material(scene["cloth"]["material"]);
    settle_cloth_source(document, scene["cloth"]);
    if (scene.contains("pin"))
        for (std::size_t i = 0; i < scene["pin"].size(); ++i)
            settle_pin_motion(document, fmt::format("pin.{}", i), scene["pin"][i]);
    if (scene.contains("pull"))
        for (std::size_t i = 0; i < scene["pull"].size(); ++i)
            check_pull_times(document, fmt::format("pull.{}", i), scene["pull"][i]);
    check_names(document, scene);
}

}  // namespace arris
