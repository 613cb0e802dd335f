// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/study/run_error.h"
#include "app/study/study_runs.h"
#include "app/study/task.h"

namespace arris {

/// Results of one run of a study. Times are those of all repetitions.
struct RunOutcome {
    StudyRun run;
    std::string status;   ///< finished, another status of report.json, bad_input, killed, crashed, no_error
    std::string message;  ///< why it did not finish
    std::vector<double> cpu_seconds, wall_seconds;
    std::vector<std::string> machines;  ///< without repetitions of one name
    std::int64_t peak_memory_bytes = 0;
    std::int64_t steps = 0;
    double max_penetration = 0.0;  ///< m
    std::int64_t crossings = 0;
    double vertices = 0.0;  ///< of the cloth, at the end
    std::vector<double>
        phase_seconds;  ///< wall time of each phase without loading, in the order of `phase_names`
    std::optional<RunError> error;  ///< of a finished run
    bool is_reference = false;      ///< others are measured against it

    bool is_finished() const { return status == "finished"; }
    /// CPU seconds, the median of all repetitions; nothing without a report.
    std::optional<double> cpu_median() const;
};

double median(std::vector<double> values);

/// Names of phases as in steps.csv, without "_s".
std::vector<std::string> phase_names();

/// Names of a run's tasks: the run, then its repetitions.
std::vector<std::string> task_names(const std::string& run, int repeats);

/// Reads what the tasks of each run left.
std::vector<RunOutcome> collect_outcomes(const std::vector<StudyRun>& runs, int repeats,
                                         const TaskFolder& folder);

/// Measures the errors of finished runs. A run whose error cannot be measured gets the status "no_error",
/// with the reason.
void measure_errors(const ErrorRule& rule, const TaskFolder& folder, std::vector<RunOutcome>& outcomes);

}  // namespace arris
