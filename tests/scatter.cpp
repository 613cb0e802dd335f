// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/scatter.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace arris {
namespace {

/// Positive where the median is `margin` above zero.
testing::AssertionResult judge(const Scatter& scatter, double margin, const std::string& claim)
{
    const double needed = kErrorsAway * scatter.error();
    // Not `margin < needed`, so that NaN fails.
    auto result = margin > needed ? testing::AssertionSuccess() : testing::AssertionFailure();
    return result << fmt::format(
               "the median {:.6g} is not {} by {} standard errors of {:.2g}; samples: {:.6g}",
               scatter.median(), claim, kErrorsAway, scatter.error(), fmt::join(scatter.values(), ", "));
}

}  // namespace

Scatter::Scatter(std::vector<double> values) : values_(std::move(values))
{
    std::sort(values_.begin(), values_.end());
}

double Scatter::quantile(double share) const
{
    const double place = share * static_cast<double>(values_.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values_.size() - 1);
    return values_[below] + (place - static_cast<double>(below)) * (values_[above] - values_[below]);
}

double Scatter::deviation() const
{
    constexpr double kBetweenQuartiles = 1.349;  // of a normal distribution, in standard deviations
    return (quantile(0.75) - quantile(0.25)) / kBetweenQuartiles;
}

double Scatter::error() const
{
    constexpr double kOfMedian = 1.2533;  // sqrt(pi / 2): of the median over that of the mean
    return kOfMedian * deviation() / std::sqrt(static_cast<double>(values_.size()));
}

Scatter measure_scatter(int starts, const std::function<double(double shift)>& measure)
{
    constexpr double kShift =
        1e-12;  // m: above the round-off of positions, far below all that a test tells apart
    std::vector<double> values;
    for (int k = 0; k < starts; ++k) values.push_back(measure(kShift * k));
    return Scatter(std::move(values));
}

testing::AssertionResult median_is_below(const Scatter& scatter, double bound)
{
    return judge(scatter, bound - scatter.median(), fmt::format("below {:.6g}", bound));
}

testing::AssertionResult median_is_above(const Scatter& scatter, double bound)
{
    return judge(scatter, scatter.median() - bound, fmt::format("above {:.6g}", bound));
}

testing::AssertionResult median_is_near(const Scatter& scatter, double expected, double allowed)
{
    return judge(scatter, allowed - std::abs(scatter.median() - expected),
                 fmt::format("within {:.6g} of {:.6g}", allowed, expected));
}

}  // namespace arris
