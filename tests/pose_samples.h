// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "geometry/obstacle/point_cache.h"

namespace arris {

/// Samples of a mesh's points in memory, in place of a file: the first at 0 s, `interval` (s) apart.
class PoseSamples : public PoseSource {
  public:
    PoseSamples(std::vector<std::vector<Vec3>> samples, double interval) : samples_(std::move(samples))
    {
        for (std::size_t k = 0; k < samples_.size(); ++k) times_.push_back(interval * static_cast<double>(k));
    }
    const std::vector<double>& times() const override { return times_; }
    std::size_t point_count() const override { return samples_.front().size(); }
    void read(std::size_t sample, std::vector<Vec3>& points) const override { points = samples_[sample]; }

  private:
    std::vector<std::vector<Vec3>> samples_;
    std::vector<double> times_;
};

}  // namespace arris
