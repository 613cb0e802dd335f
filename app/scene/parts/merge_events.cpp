// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/scene/parts/merge_events.h"

#include <algorithm>
#include <cmath>
#include <iterator>

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

/// Moves a time to another one that it nearly coincides with.
class Snap {
  public:
    explicit Snap(const RunConfig& config)
        : tolerance_(1e-9 * config.settings.step), fps_(config.output.frames_per_second)
    {
    }

    void to(double other, double& time) const
    {
        if (std::abs(time - other) <= tolerance_) time = other;
    }
    void to_frame(double& time) const
    {
        if (fps_ > 0.0) to(std::round(time * fps_) / fps_, time);
    }

  private:
    double tolerance_;
    double fps_;
};

}  // namespace

void merge_events(RunConfig& config, const std::vector<RigidMotion*>& motions)
{
    const Snap snap(config);
    snap.to_frame(config.duration);
    std::vector<double*> times = event_times(config.scene, motions);
    for (double* time : times) {
        snap.to_frame(*time);
        snap.to(config.duration, *time);
    }
    std::sort(times.begin(), times.end(), [](const double* a, const double* b) { return *a < *b; });
    for (std::size_t k = 1; k < times.size(); ++k) snap.to(*times[k - 1], *times[k]);
}

void merge_with_events(const RunConfig& config, const std::vector<RigidMotion>& plans,
                       std::vector<double>& times)
{
    const Snap snap(config);
    std::vector<double> events = input_jumps(config.scene);
    events.push_back(config.duration);
    for (const RigidMotion& motion : plans) {
        const std::vector<double> jumps = motion.jumps();
        events.insert(events.end(), jumps.begin(), jumps.end());
    }
    std::sort(events.begin(), events.end());
    for (std::size_t k = 0; k < times.size(); ++k) {
        double time = times[k];
        snap.to_frame(time);
        const auto next = std::lower_bound(events.begin(), events.end(), time);
        if (next != events.end()) snap.to(*next, time);
        if (next != events.begin()) snap.to(*std::prev(next), time);
        // Samples stay apart.
        if (k == 0 || time > times[k - 1]) times[k] = time;
    }
}

}  // namespace arris
