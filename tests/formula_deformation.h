// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "geometry/obstacle/deformation.h"

namespace arris {

/// A mesh whose points move by a formula, in place of a file: of a point's place at rest and the time.
class FormulaDeformation : public Deformation {
  public:
    using Formula = std::function<Vec3(const Vec3& rest, double time)>;

    FormulaDeformation(std::vector<Vec3> rest, Formula place, Formula velocity,
                       std::vector<double> sample_times = {0.0})
        : rest_(std::move(rest)),
          place_(std::move(place)),
          velocity_(std::move(velocity)),
          sample_times_(std::move(sample_times))
    {
    }

    void find(double time, std::vector<Vec3>& points, std::vector<Vec3>& velocities) const override
    {
        points.clear();
        velocities.clear();
        for (const Vec3& rest : rest_) {
            points.push_back(place_(rest, time));
            velocities.push_back(velocity_(rest, time));
        }
    }

    const std::vector<double>& sample_times() const override { return sample_times_; }
    std::vector<double> jumps() const override { return {}; }

  private:
    std::vector<Vec3> rest_;
    Formula place_, velocity_;
    std::vector<double> sample_times_;
};

}  // namespace arris
