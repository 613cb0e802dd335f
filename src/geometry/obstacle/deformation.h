// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// Motion of the points of an obstacle's mesh in the obstacle's frame, while its faces and edges stay the
/// same. Queries are thread-safe, and depend on their arguments alone.
class Deformation {
  public:
    virtual ~Deformation() = default;

    /// Writes the place (m) of each point of the mesh at `time` (s), and its velocity (m/s) just after it.
    virtual void find(double time, std::vector<Vec3>& points, std::vector<Vec3>& velocities) const = 0;

    /// s, ascending, at least one: the times of the poses from which the motion is interpolated. It rests
    /// before the first and after the last.
    virtual const std::vector<double>& sample_times() const = 0;

    /// Times (s) after 0 at which a velocity jumps, ascending.
    virtual std::vector<double> jumps() const = 0;
};

}  // namespace arris
