// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/study/study_file.h"

namespace arris {

/// A quantity over time. Times ascend.
struct TimeHistory {
    std::vector<double> times;   ///< s
    std::vector<double> values;  ///< one a time
};

/// The quantity of a rule (a probe's displacement or a column) in a run's files. Rows where a column is empty
/// are left out. Throws InputError if a file is invalid or holds no value.
TimeHistory read_history(const std::string& run_directory, const ErrorRule& rule);

/// A reference from a CSV file with the columns `time` and `value`; or from probes.csv or steps.csv of a run.
/// Throws InputError.
TimeHistory read_reference_file(const std::string& path, const ErrorRule& rule);

enum class Interpolation { Linear, Cubic };

/// Values at other times. Cubic: Lagrange's polynomial of the four nearest samples, so that the error is far
/// below that of a time integrator of second order. A time within 1e-9 of the range of a sample's takes that
/// sample. Throws InputError naming `source` if a time lies outside.
std::vector<double> interpolate(const TimeHistory& history, const std::vector<double>& times,
                                Interpolation interpolation, const std::string& source);

}  // namespace arris
