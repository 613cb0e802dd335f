// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/run/timeline.h"

#include <algorithm>
#include <cmath>

namespace arris {

Timeline::Timeline(const RunConfig& config)
    : duration_(config.duration),
      step_(config.settings.step),
      frames_per_second_(config.output.frames_per_second),
      jumps_(input_jumps(config.scene))
{
}

double Timeline::interval_end(double begin) const
{
    double end = duration_;
    const auto jump = std::upper_bound(jumps_.begin(), jumps_.end(), begin);
    if (jump != jumps_.end()) end = std::min(end, *jump);
    if (frames_per_second_ > 0.0) {
        // Find the first k / fps after `begin`. Rounding may make the floor one too small.
        double k = std::floor(begin * frames_per_second_);
        while (!(k / frames_per_second_ > begin)) k += 1.0;
        end = std::min(end, k / frames_per_second_);
    }
    return end;
}

std::int64_t Timeline::interval_steps(double begin, double end) const
{
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil((end - begin) / step_ - 1e-9)));
}

double Timeline::next_end(const TimelinePosition& at) const
{
    const double end = interval_end(at.begin);
    const std::int64_t steps = interval_steps(at.begin, end);
    if (at.done + 1 >= steps) return end;
    return at.begin + (end - at.begin) * (static_cast<double>(at.done + 1) / static_cast<double>(steps));
}

TimelinePosition Timeline::next(const TimelinePosition& at) const
{
    const double end = interval_end(at.begin);
    if (at.done + 1 >= interval_steps(at.begin, end)) return {end, 0};
    return {at.begin, at.done + 1};
}

bool Timeline::jumps_at(double time) const
{
    return std::binary_search(jumps_.begin(), jumps_.end(), time);
}

std::int64_t Timeline::frame_at(double time) const
{
    if (!(frames_per_second_ > 0.0)) return -1;
    const double k = std::round(time * frames_per_second_);
    return k / frames_per_second_ == time ? static_cast<std::int64_t>(k) : -1;
}

std::int64_t Timeline::frame_count() const
{
    if (!(frames_per_second_ > 0.0)) return 0;
    double last = std::floor(duration_ * frames_per_second_);
    if ((last + 1.0) / frames_per_second_ <= duration_) last += 1.0;
    if (last / frames_per_second_ > duration_) last -= 1.0;
    return static_cast<std::int64_t>(last) + 1;
}

}  // namespace arris
