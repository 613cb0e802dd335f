// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/scene/keys/scene_document.h"
#include "app/scene/parts/run_config.h"
#include "app/scene/parts/start_strain.h"

namespace arris {

/// An obstacle without its mesh: what the scene file alone determines.
struct ObstaclePlan {
    std::string name;
    Placement placement;  ///< of the obstacle's frame, before `motion`
    RigidMotion motion;
    double feature_angle = 0.0;  ///< degrees
};

/// The obstacles of a scene after apply_scene_rules, in their order.
std::vector<ObstaclePlan> plan_obstacles(const nlohmann::ordered_json& scene);

/// Reads or makes the meshes of the obstacles in `config.as_run`, or takes them from `options.obstacles` if
/// given. Fills `config.scene.obstacles` and `config.obstacle_placements`, and adds repairs to
/// `config.warnings`. Throws InputError naming the key.
void load_obstacles(const SceneDocument& document, const LoadOptions& options,
                    std::vector<ObstaclePlan> plans, RunConfig& config);

/// The box in the world, with sides along its axes, that an obstacle fills at `time` (s).
Box3 bounds_at(const MovingObstacle& obstacle, double time);

/// One line for each obstacle that the cloth intersects at time 0, with pins applied: its name, the depth and
/// the place.
std::vector<std::string> find_intersections(const SceneDocument& document, const RunConfig& config);

/// Moves vertices that are nearer to an obstacle than the thickness out to that distance. Adds a warning with
/// their number, and with the resulting strain if that is large and the strain as `placed` is not.
void keep_stand_off(const StrainRange& placed, RunConfig& config);

}  // namespace arris
