// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/assembly.h"

#include <algorithm>
#include <map>

#include "app/scene/keys/scene_json.h"
#include "solver/sewing/closing.h"

namespace arris {
namespace {

// Damping of the elastic stiffness, s.
constexpr double kDamping = 0.01;

/// Bending stiffness while seams close, in membrane stiffness: that of card as thick as seven times its root,
/// 4 mm. Soft panels fold, and slip off a shoulder before its seam is closed; stiff ones swing aside as
/// plates, and close beside an arm. A third or the threefold fails with one of five garments.
constexpr double kCard = 4e-7;  // m^2

/// Share of a cell by which two sides may come together in a step.
constexpr double kMostWay = 0.5;

/// Times that seams may take of what they would if nothing held them back.
constexpr double kPatience = 3.0;

/// Steps of which seams have the time, however short their way.
constexpr double kLeastSteps = 20.0;

/// Time, s, after which a scene counts as unsewn. Seams of an order may part seams of the next ones by as
/// much as they themselves close.
double find_duration(const RunConfig& config)
{
    std::map<int, double> widest;  // by order
    for (const SceneSeam& seam : config.seams)
        for (const auto& pair : seam.pairs)
            widest[seam.order] = std::max(widest[seam.order], distance_of(config, pair));
    double time = 0.0, parted = 0.0;
    for (const auto& [order, gap] : widest) {
        time += closing_time(gap + parted, config.scene.sewing->speed);
        parted += gap;
    }
    return kPatience * time + config.scene.sewing->settle + kLeastSteps * config.settings.step;
}

Scene make_scene(const RunConfig& config)
{
    const Scene& of = config.scene;
    Scene scene;
    scene.materials = of.materials;
    for (int i = 0; i < scene.materials.count(); ++i) {
        Material& material = scene.materials[i];
        material.damping = std::max(material.damping, kDamping);
        material.bending_stiffness = std::max(material.bending_stiffness, kCard * material.youngs_modulus);
    }
    scene.pieces = of.pieces;
    for (std::size_t i = 0; i < of.pins.size(); ++i) {
        const Pin& pin = of.pins[i];
        if (!config.as_run["pin"][i].contains("label") || !pin.holds(0.0, 0.0)) continue;
        Pin still;
        still.material = pin.material;
        still.held = pin.held;
        scene.pins.push_back(std::move(still));
    }
    for (const MovingObstacle& obstacle : of.obstacles) scene.obstacles.push_back(obstacle.at_rest(0.0));
    scene.self_contact = of.self_contact;
    scene.sewing = of.sewing;
    return scene;
}

}  // namespace

bool needs_assembly(const RunConfig& config)
{
    if (!config.scene.sewing) return false;
    const double closed = closed_gap(config.scene);
    return std::any_of(config.seams.begin(), config.seams.end(), [&](const SceneSeam& seam) {
        return !seam.is_tie || std::any_of(seam.pairs.begin(), seam.pairs.end(), [&](const auto& pair) {
            return distance_of(config, pair) > closed;
        });
    });
}

bool keeps_unsewn(const RunConfig& config)
{
    const auto tables = cloth_tables(config.as_run);
    return std::any_of(tables.begin(), tables.end(), [](const auto* cloth) {
        return cloth->contains("assembly") && (*cloth)["assembly"]["unsewn"] == "keep";
    });
}

RunConfig make_assembly(const RunConfig& config, double duration)
{
    RunConfig assembly;
    assembly.title = config.title;
    assembly.is_assembly = true;
    assembly.duration = duration > 0.0 ? duration : find_duration(config);
    assembly.scene = make_scene(config);
    assembly.settings = config.settings;
    assembly.settings.integrator = Integrator::ImplicitEuler;  // which damps, too
    assembly.output.frames_per_second = 0.0;
    assembly.output.formats.clear();
    for (const auto* cloth : cloth_tables(config.as_run))
        if (cloth->contains("assembly")) {
            if ((*cloth)["assembly"]["frames"].get<bool>()) assembly.output = config.output;
            if (!cloth->contains("edge_length")) continue;
            assembly.settings.step =
                std::min(assembly.settings.step,
                         kMostWay * to_double((*cloth)["edge_length"]) / config.scene.sewing->speed);
        }
    assembly.pieces = config.pieces;
    assembly.seams = config.seams;
    assembly.labels = config.labels;
    assembly.cloth = config.cloth;
    assembly.cloth_velocity.assign(config.cloth.world.size(), Vec3::Zero());
    for (const MovingObstacle& obstacle : assembly.scene.obstacles)
        assembly.obstacle_placements.push_back(obstacle.at(0.0).placement);
    assembly.as_run = config.as_run;
    for (const char* effect : {"gravity", "wind", "pull", "friction", "remesh", "probe", "pin"})
        assembly.as_run.erase(effect);
    assembly.as_run["eol"]["enabled"] = false;
    assembly.as_run["duration"] = assembly.duration;
    return assembly;
}

}  // namespace arris
