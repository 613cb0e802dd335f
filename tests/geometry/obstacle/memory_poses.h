// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "geometry/obstacle/point_cache.h"

namespace arris {

/// Poses in memory, which count how often they are read.
class MemoryPoses : public PoseSource {
  public:
    MemoryPoses(std::vector<double> times, std::vector<std::vector<Vec3>> samples)
        : times_(std::move(times)), samples_(std::move(samples))
    {
    }

    const std::vector<double>& times() const override { return times_; }
    std::size_t point_count() const override { return samples_.front().size(); }
    void read(std::size_t sample, std::vector<Vec3>& points) const override
    {
        ++reads;
        points = samples_.at(sample);
    }

    mutable int reads = 0;

  private:
    std::vector<double> times_;
    std::vector<std::vector<Vec3>> samples_;
};

}  // namespace arris
