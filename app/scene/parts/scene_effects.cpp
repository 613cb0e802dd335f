// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/scene_effects.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace arris {
namespace {

SceneEffect obstacle_effect(const RunConfig& config)
{
    constexpr std::size_t kMostNames = 5;
    const std::vector<MovingObstacle>& obstacles = config.scene.obstacles;
    if (obstacles.empty()) return {"obstacle", false, "no [[obstacle]]"};
    std::string names;
    for (std::size_t i = 0; i < std::min(obstacles.size(), kMostNames); ++i)
        names += (i > 0 ? ", " : "") + obstacles[i].name();
    if (obstacles.size() > kMostNames) names += fmt::format(" and {} more", obstacles.size() - kMostNames);
    return {"obstacle", true, fmt::format("{} [[obstacle]]: {}", obstacles.size(), names)};
}

SceneEffect eol_effect(const RunConfig& config)
{
    if (config.scene.eol) return {"eol", true, "eol.enabled is true, and an obstacle has sharp features"};
    return {"eol", false,
            has_features(config.scene) ? "eol.enabled is false: contacts keep the cloth off sharp features"
                                       : "no obstacle has sharp features"};
}

SceneEffect remesh_effect(const RunConfig& config)
{
    if (!config.scene.remesh)
        return {"remesh", false, "no [remesh]: the mesh changes only near sharp features, with EOL vertices"};
    const Remeshing& remesh = *config.scene.remesh;
    return {"remesh", true,
            fmt::format("edges of {:g} to {:g} m, about {} vertices at most", remesh.shortest, remesh.longest,
                        remesh.most_vertices)};
}

SceneEffect friction_effect(const RunConfig& config)
{
    const std::optional<Friction>& friction = config.scene.friction;
    if (!friction) return {"friction", false, "no [friction]: the cloth slides freely over obstacles"};
    std::set<double> coefficients, of_layers;
    const int pieces = config.scene.materials.count();
    for (int p = 0; p < pieces; ++p) {
        for (int o = 0; o < static_cast<int>(config.scene.obstacles.size()); ++o)
            coefficients.insert(friction->with_obstacle(o, p));
        for (int q = 0; q <= p; ++q) of_layers.insert(friction->between(p, q));
    }
    const bool do_layers_slip = config.scene.self_contact && *of_layers.rbegin() > 0.0;
    if (config.scene.obstacles.empty() && !do_layers_slip)
        return {"friction", false, "no [[obstacle]] that could rub"};
    std::vector<std::string> parts;
    for (const double coefficient : coefficients) parts.push_back(fmt::format("{:g}", coefficient));
    if (do_layers_slip)
        parts.push_back(of_layers.size() == 1 ? fmt::format("{:g} between layers", *of_layers.begin())
                                              : fmt::format("{:g} to {:g} between layers", *of_layers.begin(),
                                                            *of_layers.rbegin()));
    return {"friction", true, fmt::format("coefficient {}", fmt::join(parts, ", "))};
}

SceneEffect self_contact_effect(const RunConfig& config)
{
    const std::optional<ClothContact>& contact = config.scene.self_contact;
    if (!contact) return {"self_contact", false, "no [self_contact]: the cloth may pass through itself"};
    return {"self_contact", true, fmt::format("layers keep {:g} m apart", contact->thickness)};
}

SceneEffect by_table(const RunConfig& config, const std::string& table, bool is_list)
{
    const bool is_on = config.as_run.contains(table) && !config.as_run[table].empty();
    const std::string name = is_list ? fmt::format("[[{}]]", table) : fmt::format("[{}]", table);
    if (!is_on) return {table, false, "no " + name};
    if (!is_list) return {table, true, name + " is given"};
    return {table, true, fmt::format("{} {}", config.as_run[table].size(), name)};
}

/// An effect that a value of a material switches on; the piece with the greatest one tells.
SceneEffect by_material(const RunConfig& config, const std::string& name, const char* key,
                        double Material::*property, std::string_view unit)
{
    std::size_t greatest = 0;
    for (std::size_t p = 1; p < config.pieces.size(); ++p)
        if (config.scene.materials[static_cast<int>(p)].*property >
            config.scene.materials[static_cast<int>(greatest)].*property)
            greatest = p;
    const double value = config.scene.materials[static_cast<int>(greatest)].*property;
    return {name, value > 0.0,
            fmt::format("{}.{} is {:g} {}", config.pieces[greatest].material_key, key, value, unit)};
}

}  // namespace

std::vector<SceneEffect> list_effects(const RunConfig& config)
{
    return {
        by_material(config, "bending", "bending_stiffness", &Material::bending_stiffness, "J"),
        by_material(config, "damping", "damping", &Material::damping, "s"),
        by_table(config, "gravity", false),
        by_table(config, "wind", false),
        by_table(config, "pull", true),
        by_table(config, "pin", true),
        obstacle_effect(config),
        eol_effect(config),
        remesh_effect(config),
        friction_effect(config),
        self_contact_effect(config),
    };
}

bool is_on(const std::vector<SceneEffect>& effects, std::string_view name)
{
    return std::any_of(effects.begin(), effects.end(),
                       [&](const SceneEffect& effect) { return effect.is_on && effect.name == name; });
}

}  // namespace arris
