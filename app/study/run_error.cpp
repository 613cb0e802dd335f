// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/run_error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/files/frame_files.h"
#include "app/study/reference_formula.h"
#include "app/study/shape_distance.h"
#include "app/study/time_history.h"
#include "app/text/printable.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

using Reference = ErrorRule::Reference;
using Norm = ErrorRule::Norm;

std::vector<double> reference_values(const ErrorRule& rule, const std::vector<double>& times,
                                     const std::string& reference_run)
{
    switch (rule.reference) {
        case Reference::None:
            return std::vector<double>(times.size(), 0.0);
        case Reference::Formula:
            return evaluate_formula(rule.formula, times);
        case Reference::File:
            return interpolate(read_reference_file(rule.formula, rule), times, Interpolation::Linear,
                               rule.formula);
        case Reference::Finest:
        case Reference::Run:
            return interpolate(read_history(reference_run, rule), times, Interpolation::Cubic, reference_run);
    }
    return {};
}

/// Norm of differences. Rms weighs each by the time since the one before.
double norm_of(const std::vector<double>& differences, const std::vector<double>& times, Norm norm)
{
    if (norm == Norm::Final) return std::abs(differences.back());
    double most = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < differences.size(); ++i) {
        most = std::max(most, std::abs(differences[i]));
        if (i > 0) squares += differences[i] * differences[i] * (times[i] - times[i - 1]);
    }
    if (norm == Norm::Max) return most;
    const double duration = times.back() - times.front();
    return duration > 0.0 ? std::sqrt(squares / duration) : most;
}

void set_scale(const std::vector<double>& reference, RunError& error)
{
    const auto [least, greatest] = std::minmax_element(reference.begin(), reference.end());
    const double range = *greatest - *least, size = std::max(std::abs(*least), std::abs(*greatest));
    constexpr double kRounding = 1e-12;  // of the size
    error.scale_kind = range > kRounding * size ? ErrorScale::Range : ErrorScale::Size;
    error.scale = error.scale_kind == ErrorScale::Range ? range : size;
}

RunError history_error(const ErrorRule& rule, const std::string& run, const std::string& reference_run)
{
    const TimeHistory history = read_history(run, rule);
    const std::vector<double> reference = reference_values(rule, history.times, reference_run);
    std::vector<double> differences;
    for (std::size_t i = 0; i < reference.size(); ++i)
        differences.push_back(history.values[i] - reference[i]);
    RunError error;
    error.value = norm_of(differences, history.times, rule.norm);
    if (rule.reference != Reference::None) set_scale(reference, error);
    return error;
}

RunError shape_error(const ErrorRule& rule, const std::string& run, const std::string& reference_run)
{
    const std::int64_t frames = count_frames(run);
    if (frames == 0 || frames != count_frames(reference_run))
        throw InputError(
            fmt::format("{}: has {} frames, but the reference has {}; allowed: as many, at least 1",
                        printable(run), frames, count_frames(reference_run)));
    RunError error;
    error.scale_kind = ErrorScale::Diagonal;
    double mean = 0.0, greatest = 0.0;
    const std::int64_t first = rule.is_over_all_frames ? 0 : frames - 1;
    for (std::int64_t i = first; i < frames; ++i) {
        const Frame reference = read_frame(frame_file(reference_run, i, "ply"));
        const ShapeDistance distance =
            measure_shape_distance(read_frame(frame_file(run, i, "ply")), reference);
        mean += distance.mean / static_cast<double>(frames - first);
        greatest = std::max(greatest, distance.greatest);
        error.scale = world_diagonal(reference);
    }
    error.mean = mean;
    error.greatest = greatest;
    error.value = rule.norm == Norm::Max ? greatest : mean;
    return error;
}

}  // namespace

std::optional<double> RunError::relative() const
{
    if (!scale || !(*scale > 0.0)) return std::nullopt;
    return value / *scale;
}

RunError measure_error(const ErrorRule& rule, const std::string& run, const std::string& reference_run)
{
    return rule.quantity == ErrorRule::Quantity::Shape ? shape_error(rule, run, reference_run)
                                                       : history_error(rule, run, reference_run);
}

std::string describe_scale(ErrorScale kind)
{
    switch (kind) {
        case ErrorScale::Range:
            return "the reference's range over the run";
        case ErrorScale::Size:
            return "the reference, which does not change";
        case ErrorScale::Diagonal:
            return "the diagonal of the reference cloth's box";
    }
    return "";
}

}  // namespace arris
