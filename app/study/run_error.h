// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "app/study/study_file.h"

namespace arris {

/// The size of which an error is a share.
enum class ErrorScale {
    Range,    ///< of the reference over the run's times
    Size,     ///< of a reference that does not change
    Diagonal  ///< of the box around the reference's cloth
};

/// The error of one run.
struct RunError {
    double value = 0.0;           ///< in the quantity's unit
    std::optional<double> scale;  ///< absent without a reference
    ErrorScale scale_kind = ErrorScale::Range;
    std::optional<double> mean, greatest;  ///< of a shape, m

    /// `value` as a share of `scale`; nothing without a reference, or if the reference never changes.
    std::optional<double> relative() const;
};

/// Measures the error of a finished run. `reference_run`: folder of the run to compare with, for references
/// that are runs. The scale of a shape is that of the reference's last frame. Throws InputError if files do
/// not fit together.
RunError measure_error(const ErrorRule& rule, const std::string& run, const std::string& reference_run);

/// Words for the scale in a sentence.
std::string describe_scale(ErrorScale kind);

}  // namespace arris
