// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/keys/scene_json.h"

#include <limits>

namespace arris {

using Json = nlohmann::ordered_json;

double to_double(const Json& value)
{
    return value.get<double>();
}

Vec2 to_vec2(const Json& value)
{
    return {to_double(value[0]), to_double(value[1])};
}

Vec3 to_vec3(const Json& value)
{
    return {to_double(value[0]), to_double(value[1]), to_double(value[2])};
}

MaterialBox to_material_box(const Json& value)
{
    return {to_vec2(value[0]), to_vec2(value[1])};
}

double to_time(const Json& value)
{
    return value.is_null() ? std::numeric_limits<double>::infinity() : to_double(value);
}

Mat3 to_rotation(const Json& rotate)
{
    return rotation_about(to_vec3(rotate["axis"]).stableNormalized(), to_double(rotate["degrees"]));
}

std::vector<Keyframe> to_keyframes(const Json& keyframes)
{
    std::vector<Keyframe> result;
    for (const Json& keyframe : keyframes)
        result.push_back({to_double(keyframe["time"]), to_vec3(keyframe["translate"]),
                          Eigen::Quaterniond(to_rotation(keyframe["rotate"]))});
    return result;
}

double metres_of(const std::string& unit)
{
    return unit == "m" ? 1.0 : unit == "cm" ? 0.01 : unit == "mm" ? 0.001 : 0.0254;
}

}  // namespace arris
