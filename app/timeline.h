// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "app/run_config.h"

namespace arris {

/// Moves times of the scene that all but fall on a frame, on the end of the run or on each other (nearer than
/// 1e-9 of the longest step) onto them, so that what wrote 0.30000000000000004 for 0.3 does not make a step
/// of 5e-17 s. All that asks whether something acts at a time must see the moved ones, so this comes first.
/// `motions`: of obstacles that are not in the scene yet.
void merge_events(RunConfig& config, const std::vector<RigidMotion*>& motions = {});

/// Where a run stands in its plan: `done` steps of the interval that starts at `begin` (s).
struct TimelinePosition {
    double begin = 0.0;
    std::int64_t done = 0;
};

/// The plan of a run's steps. Frame times, jumps of the input and the duration cut it into intervals, and
/// each interval into ceil(length / step - 1e-9) equal steps, so that steps end exactly on all of these.
class Timeline {
  public:
    explicit Timeline(const RunConfig& config);

    bool is_over(const TimelinePosition& at) const { return !(at.begin < duration_); }

    /// End of the next step, s.
    double next_end(const TimelinePosition& at) const;
    TimelinePosition advance(const TimelinePosition& at) const;

    /// Whether the input jumps at `time`.
    bool jumps_at(double time) const;

    /// Index of the frame that is taken at `time`; -1 if none is.
    std::int64_t frame_at(double time) const;

    /// Frames over the whole run, the one at time 0 included.
    std::int64_t frame_count() const;

    /// End of the interval that starts at `begin`: the next frame, jump or the duration.
    double interval_end(double begin) const;

  private:
    std::int64_t interval_steps(double begin, double end) const;

    double duration_, step_, frames_per_second_;
    std::vector<double> jumps_;  ///< ascending
};

}  // namespace arris
