// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/scene/run_config.h"
#include "app/scene/scene_document.h"
#include "app/scene/start_strain.h"

namespace arris {

/// An obstacle but for its mesh: what is known before any file is read.
struct ObstaclePlan {
    std::string name;
    Placement placement;  ///< of its frame, before `motion`
    RigidMotion motion;
    double feature_angle = 0.0;  ///< degrees
};

/// The obstacles of a scene that apply_scene_rules has settled, in their order.
std::vector<ObstaclePlan> plan_obstacles(const nlohmann::ordered_json& scene);

/// Reads or makes the meshes of `config.as_run` (those of `options.obstacles` where these are given) and
/// fills `config.scene.obstacles`, `config.obstacle_placements` and, with what was repaired,
/// `config.warnings`. Throws InputError naming the key.
void load_obstacles(const SceneDocument& document, const LoadOptions& options,
                    std::vector<ObstaclePlan> plans, RunConfig& config);

/// One line for each obstacle that the cloth, as pins have it at time 0, intersects: which, how deep and
/// where.
std::vector<std::string> find_intersections(const SceneDocument& document, const RunConfig& config);

/// Moves cloth that is clear of the obstacles but nearer than its thickness out to it, with a warning that
/// counts, and that says what it strains a cloth by which is not so strained where it is `placed`.
void keep_stand_off(const StrainRange& placed, RunConfig& config);

}  // namespace arris
