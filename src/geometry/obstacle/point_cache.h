// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "geometry/obstacle/deformation.h"

namespace arris {

/// Places of a mesh's points at given times, stored somewhere and read one sample at a time.
class PoseSource {
  public:
    virtual ~PoseSource() = default;
    virtual const std::vector<double>& times() const = 0;  ///< s, ascending, at least one
    virtual std::size_t point_count() const = 0;           ///< in each sample

    /// Writes the places (m) of one sample. Throws where they cannot be read. Calls are not concurrent.
    virtual void read(std::size_t sample, std::vector<Vec3>& points) const = 0;
};

enum class PoseInterpolation { Cubic, Linear };

/// A motion through the poses of a source. Cubic: Hermite polynomials whose velocities at the samples are
/// those of the parabola through three of them (Catmull and Rom's for even times), and zero at the first and
/// the last. So no velocity jumps; the error is of order 3 in the time between samples.
/// Linear: the velocity jumps at each sample.
///
/// Keeps the samples of two neighbouring intervals in memory. `find` throws what the source's `read` throws.
class PointCache : public Deformation {
  public:
    PointCache(std::shared_ptr<const PoseSource> source, PoseInterpolation interpolation);

    void find(double time, std::vector<Vec3>& points, std::vector<Vec3>& velocities) const override;
    const std::vector<double>& sample_times() const override { return source_->times(); }
    std::vector<double> jumps() const override;

    const std::shared_ptr<const PoseSource>& source() const { return source_; }
    PoseInterpolation interpolation() const { return interpolation_; }

  private:
    using Sample = std::shared_ptr<const std::vector<Vec3>>;
    struct Kept {
        std::size_t index;
        Sample points;
    };

    Sample sample(std::size_t index) const;

    std::shared_ptr<const PoseSource> source_;
    PoseInterpolation interpolation_;
    mutable std::mutex mutex_;
    mutable std::deque<Kept> kept_;  // the latest used last
};

}  // namespace arris
