// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/scene/parts/scene_effects.h"
#include "solver/model/step_report.h"

namespace arris {

enum class RunStatus {
    Finished,
    Interrupted,
    Infeasible,
    NotConverged,
    Penetration,
    NotFinite,
    IoError,
    Unsewn
};

/// The name in report.json: finished, interrupted, infeasible, not_converged, penetration, not_finite,
/// io_error, unsewn.
std::string to_string(RunStatus status);

/// Numbers of contacts that pressed on sharp features, summed over all steps of a run with EOL vertices.
struct FeatureTotals {
    std::int64_t eol = 0;                                    ///< as EOL vertices
    std::array<std::int64_t, kConstraintCauses> by_cause{};  ///< as rows

    /// Share of EOL vertices among EOL vertices and the rows whose cause counts (`counts_in_share`). Nothing
    /// if there are none.
    std::optional<double> eol_share() const;
};

/// Totals of a run's steps.csv; for a resumed run from time 0.
struct StepTotals {
    std::int64_t steps = 0;          ///< accepted
    double simulated_seconds = 0.0;  ///< time of the last row
    double wall_seconds = 0.0;       ///< sum of all phases
    double cpu_seconds = 0.0;
    PhaseSeconds phases;
    double max_penetration = 0.0;  ///< m
    std::int64_t crossings = 0;
    double max_kkt_residual = 0.0;
    std::int64_t halved_steps = 0;
    std::optional<FeatureTotals> features;
};

/// Reads steps.csv in constant memory, without an incomplete last line. Throws InputError if the file is
/// invalid.
StepTotals sum_steps(const std::string& steps_csv);

/// The phases in the order of a step, with their names in report.json and a description.
struct NamedSeconds {
    const char* name;
    double seconds;
    const char* what;
};
std::vector<NamedSeconds> list_phases(const PhaseSeconds& phases);

/// The report of a run, whatever its ending.
struct RunReport {
    RunStatus status = RunStatus::Finished;
    std::string message;  ///< why it stopped; empty if finished
    StepTotals totals;
    std::int64_t peak_memory_bytes = 0;
    std::vector<SceneEffect> effects;  ///< all; report.json names those that are on
    std::vector<std::string> warnings;
    nlohmann::ordered_json scene = nlohmann::ordered_json::object();  ///< with every default filled in
    std::string version;
    int threads = 1;
    std::string kernel;     ///< BLAS kernel of the last step
    std::string processor;  ///< empty where it is not known
};

nlohmann::ordered_json to_json(const RunReport& report);

/// Writes report.json atomically. Throws std::system_error naming the path if writing fails.
void write_report_json(const std::string& path, const RunReport& report);

/// The status in a report.json. Throws InputError naming the file if there is none.
std::string read_status(const std::string& path);

/// Peak resident memory of this process, and CPU time of all its threads, so far.
std::int64_t peak_memory_bytes();
double process_cpu_seconds();

/// The processor's model, such as "AMD EPYC 9R14"; empty where Linux does not tell.
std::string processor_name();

}  // namespace arris
