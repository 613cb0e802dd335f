// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "app/study/study_file.h"

namespace arris {

/// The error of one run.
struct RunError {
    double value = 0.0;                    ///< in the quantity's unit
    std::optional<double> scale;           ///< size of the reference; absent without a reference
    std::optional<double> mean, greatest;  ///< of a shape, m

    /// `value` as a share of `scale`; nothing without a reference, or if the reference never changes.
    std::optional<double> relative() const;
};

/// Measures the error of a finished run. `reference_run`: folder of the run to compare with, for references
/// that are runs. The scale is the reference's range over the run's times; of a formula or file that does not
/// change, its size; of a shape, the diagonal of the box around the reference's last frame. Throws InputError
/// if files do not fit together.
RunError measure_error(const ErrorRule& rule, const std::string& run, const std::string& reference_run);

/// Words for the scale in a sentence.
std::string describe_scale(const ErrorRule& rule);

}  // namespace arris
