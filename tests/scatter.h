// SPDX-License-Identifier: GPL-3.0-or-later
// Quantities that scatter with round-off.
//
// Cloth that crumples, or that leaves a corner last, follows another path after a difference in the last bit,
// as another processor makes one. What such a run ends with is a sample of a distribution. A test may bound
// its median, measured from starts that differ by round-off, and only by a bound that is several standard
// errors away.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <vector>

namespace arris {

/// Samples of one quantity, from starts that differ by round-off.
class Scatter {
  public:
    explicit Scatter(std::vector<double> values);

    double quantile(
        double share) const;  ///< linear between samples; share 0 is the least sample, 1 the greatest
    double median() const { return quantile(0.5); }

    /// Standard deviation of the normal distribution that has these quartiles: a few outliers do not change
    /// it.
    double deviation() const;

    /// Standard error of the median.
    double error() const;

    const std::vector<double>& values() const { return values_; }

  private:
    std::vector<double> values_;  ///< ascending
};

/// `measure(shift)` from `starts` starts. A test adds `shift`, a multiple of 1e-12 m, to where its cloth
/// starts.
Scatter measure_scatter(int starts, const std::function<double(double shift)>& measure);

/// How many standard errors a bound is away from a median, at the least. At 4, a machine in ten thousand
/// fails by chance.
inline constexpr double kErrorsAway = 4.0;

/// Whether the median is on the right side of a bound, by kErrorsAway standard errors. The message lists the
/// samples.
testing::AssertionResult median_is_below(const Scatter& scatter, double bound);
testing::AssertionResult median_is_above(const Scatter& scatter, double bound);
testing::AssertionResult median_is_near(const Scatter& scatter, double expected, double allowed);

}  // namespace arris
