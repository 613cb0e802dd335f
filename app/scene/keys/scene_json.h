// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "geometry/cloth/material_box.h"
#include "geometry/rigid_motion.h"
#include "geometry/vectors.h"

namespace arris {

// Conversions of values that complete_scene has checked.

double to_double(const nlohmann::ordered_json& value);
Vec2 to_vec2(const nlohmann::ordered_json& value);
Vec3 to_vec3(const nlohmann::ordered_json& value);
MaterialBox to_material_box(const nlohmann::ordered_json& value);

/// Seconds; infinity for null, which means never.
double to_time(const nlohmann::ordered_json& value);

/// From a table with `axis` and `degrees`.
Mat3 to_rotation(const nlohmann::ordered_json& rotate);

/// From an array of tables with `time`, `translate` and `rotate`.
std::vector<Keyframe> to_keyframes(const nlohmann::ordered_json& keyframes);

/// Metres per unit "m", "cm", "mm" or "in".
double metres_of(const std::string& unit);

}  // namespace arris
