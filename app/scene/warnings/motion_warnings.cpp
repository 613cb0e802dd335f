// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/warnings/motion_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "app/text/counted.h"

namespace arris {
namespace {

/// Warns of keyframes that a motion from `begin` to `end` does not reach.
void check_keyframes(const RunConfig& config, const RigidMotion& motion, double begin, double end,
                     const std::string& path, Warnings& warnings)
{
    for (std::size_t k = 1; k < motion.keyframes.size(); ++k) {
        const std::string key = fmt::format("{}.keyframes.{}.time", path, k);
        if (motion.keyframes[k].time <= begin)
            warnings.add(fmt::format("{}.keyframes.{}.time", path, k - 1),
                         "the next keyframe is not after the start of the pin");
        // A keyframe has an effect if the previous one precedes the end: the body then moves towards it.
        if (motion.keyframes[k - 1].time >= end)
            warnings.add(key, end < config.duration
                                  ? "the previous keyframe is not before the release"
                                  : "the previous keyframe is not before the end of the run");
        else if (motion.keyframes[k].time > config.duration)
            warnings.note(key, fmt::format("is not reached: the run ends at {:g} s, on the way to this "
                                           "keyframe (times are in seconds, not frames)",
                                           config.duration));
    }
}

void check_pin_motion(const RunConfig& config, const Pin& pin, const std::string& path, Warnings& warnings)
{
    for (int d = 0; d < 3; ++d)
        if (!pin.held[d] && !is_zero(pin.motion.velocity[d]))
            warnings.add(path + ".velocity", fmt::format("the pin does not hold {}", "xyz"[d]));
    if (is_zero(pin.motion.angular_velocity)) warnings.add(path + ".pivot", "there is no angular_velocity");
    check_keyframes(config, pin.motion, pin.start, std::min(config.duration, pin.release), path, warnings);
}

bool is_moving(const Scene& scene, const Pin& pin)
{
    if (pin.follows) return scene.obstacles[static_cast<std::size_t>(*pin.follows)].is_moving();
    return pin.motion.is_moving();
}

/// Whether both pins hold at some time.
bool do_overlap(const Pin& a, const Pin& b)
{
    return std::max(a.start, b.start) < std::min(a.release, b.release);
}

void check_pin_times(const RunConfig& config, const Pin& pin, const std::string& path, Warnings& warnings)
{
    if (pin.start >= config.duration)
        warnings.add(path + ".start", "the pin starts after the end of the run");
    else if (!(pin.release > pin.start))
        warnings.add(path + ".release", "the pin is released before it holds anything");
    else if (pin.release >= config.duration)
        warnings.add(path + ".release", "the run ends before that time");
}

/// Warns of neighbouring keyframes more than 180 degrees apart: slerp takes the shorter arc instead.
void check_turns(const std::string& key, const nlohmann::ordered_json& keyframes, Warnings& warnings)
{
    for (std::size_t k = 1; k < keyframes.size(); ++k) {
        const auto &from = keyframes[k - 1]["rotate"], &to = keyframes[k]["rotate"];
        const double turn = to["degrees"].get<double>() - from["degrees"].get<double>();
        if (from["axis"] != to["axis"] || !(std::abs(turn) > 180.0)) continue;
        warnings.note(key, fmt::format("rotates by {:.6g} degrees from keyframe {} to {}, but rotations take "
                                       "the shorter arc; write keyframes at most 180 degrees apart",
                                       turn, k - 1, k));
    }
}

}  // namespace

void check_pins(const RunConfig& config, Warnings& warnings)
{
    // The pins so far that hold a component of a vertex. Where pins overlap, the last one moves it.
    std::map<std::pair<int, int>, std::vector<std::size_t>> holders;
    for (std::size_t i = 0; i < config.scene.pins.size(); ++i) {
        const Pin& pin = config.scene.pins[i];
        const std::string path = fmt::format("pin.{}", i);
        check_pin_motion(config, pin, path, warnings);
        check_pin_times(config, pin, path, warnings);

        std::map<std::size_t, int> shared;
        for (const int v : vertices_inside(config.cloth, pin.material))
            for (int d = 0; d < 3; ++d) {
                if (!pin.held[d]) continue;
                std::vector<std::size_t>& others = holders[{v, d}];
                const auto other = std::find_if(others.rbegin(), others.rend(), [&](std::size_t o) {
                    return do_overlap(config.scene.pins[o], pin);
                });
                if (other != others.rend()) ++shared[*other];
                others.push_back(i);
            }
        for (const auto& [other, count] : shared)
            if (is_moving(config.scene, config.scene.pins[other]) || is_moving(config.scene, pin))
                warnings.note(path + ".material",
                              fmt::format("holds {} that pin.{} also holds; pin.{} alone moves {}",
                                          counted(count, "position component", "position components"), other,
                                          i, count == 1 ? "it" : "them"));
    }
}

void check_obstacle_motion(const RunConfig& config, const RigidMotion& motion, const std::string& path,
                           Warnings& warnings)
{
    if (is_zero(motion.velocity) && is_zero(motion.angular_velocity))
        warnings.add(path + ".motion", "the motion has no velocity");
    else if (is_zero(motion.angular_velocity))
        warnings.add(path + ".motion.pivot", "there is no angular_velocity");
    if (motion.start >= config.duration)
        warnings.add(path + ".motion.start", "the motion starts after the end of the run");
    else if (motion.stop >= config.duration)
        warnings.add(path + ".motion.stop", "the run ends before that time");
    check_keyframes(config, motion, 0.0, config.duration, path, warnings);
}

void check_turns(const RunConfig& config, Warnings& warnings)
{
    for (const char* table : {"pin", "obstacle"}) {
        if (!config.as_run.contains(table)) continue;
        const auto& elements = config.as_run[table];
        for (std::size_t i = 0; i < elements.size(); ++i)
            if (elements[i].contains("keyframes"))
                check_turns(fmt::format("{}.{}.keyframes", table, i), elements[i]["keyframes"], warnings);
    }
}

}  // namespace arris
