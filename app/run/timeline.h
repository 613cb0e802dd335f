// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "app/scene/parts/run_config.h"

namespace arris {

/// Position in the plan of a run: `done` steps of the interval that starts at `begin` (s).
struct TimelinePosition {
    double begin = 0.0;
    std::int64_t done = 0;
};

/// The plan of a run's steps. Frame times, jumps of the input and the duration delimit intervals, so that
/// steps end exactly at them. Each interval is divided into ceil(length / step - 1e-9) equal steps.
class Timeline {
  public:
    explicit Timeline(const RunConfig& config);

    bool is_over(const TimelinePosition& at) const { return !(at.begin < duration_); }

    /// End of the next step, s.
    double next_end(const TimelinePosition& at) const;
    TimelinePosition next(const TimelinePosition& at) const;

    /// Whether the input jumps at `time`.
    bool jumps_at(double time) const;

    /// Index of the frame at `time`; -1 if there is none.
    std::int64_t frame_at(double time) const;

    /// Number of frames of the whole run, including that at time 0.
    std::int64_t frame_count() const;

    /// End of the interval that starts at `begin`: the next frame or jump, or the duration.
    double interval_end(double begin) const;

  private:
    std::int64_t interval_steps(double begin, double end) const;

    double duration_, step_, frames_per_second_;
    std::vector<double> jumps_;  ///< ascending
};

}  // namespace arris
