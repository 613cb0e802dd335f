// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/merge_events.h"

#include <algorithm>
#include <cmath>

namespace arris {

namespace {

void add_times(RigidMotion& motion, std::vector<double*>& times)
{
    times.insert(times.end(), {&motion.start, &motion.stop});
    for (Keyframe& keyframe : motion.keyframes) times.push_back(&keyframe.time);
}

/// Every time at which the input may jump.
std::vector<double*> event_times(Scene& scene, const std::vector<RigidMotion*>& motions)
{
    std::vector<double*> times;
    for (Pin& pin : scene.pins) {
        times.insert(times.end(), {&pin.start, &pin.release});
        add_times(pin.motion, times);
    }
    for (RigidMotion* motion : motions) add_times(*motion, times);
    for (Pull& pull : scene.pulls) times.insert(times.end(), {&pull.start, &pull.stop});
    std::erase_if(times, [](const double* t) { return !std::isfinite(*t); });
    return times;
}

}  // namespace

void merge_events(RunConfig& config, const std::vector<RigidMotion*>& motions)
{
    const double tolerance = 1e-9 * config.settings.step;
    const double fps = config.output.frames_per_second;
    const auto snap = [&](double& time, double to) {
        if (std::abs(time - to) <= tolerance) time = to;
    };
    const auto snap_to_frame = [&](double& time) {
        if (fps > 0.0) snap(time, std::round(time * fps) / fps);
    };

    snap_to_frame(config.duration);
    std::vector<double*> times = event_times(config.scene, motions);
    for (double* time : times) {
        snap_to_frame(*time);
        snap(*time, config.duration);
    }
    std::sort(times.begin(), times.end(), [](const double* a, const double* b) { return *a < *b; });
    for (std::size_t k = 1; k < times.size(); ++k) snap(*times[k], *times[k - 1]);
}

}  // namespace arris
