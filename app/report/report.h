// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "solver/model/step_report.h"

namespace arris {

enum class RunStatus { Finished, Interrupted, Infeasible, NotConverged, Penetration, NotFinite, IoError };

/// As written in report.json: finished, interrupted, infeasible, not_converged, penetration, not_finite,
/// io_error.
std::string to_string(RunStatus status);

/// Contacts that pressed on sharp features, over all steps of a run with EOL vertices.
struct FeatureTotals {
    std::int64_t eol = 0;                             ///< as EOL vertices
    std::array<std::int64_t, kRowCauses> by_cause{};  ///< as rows

    /// Of the contacts that pressed on two steps in a row and are not excluded (`is_excluded`): how many were
    /// EOL. Nothing where there were none.
    std::optional<double> eol_share() const;
};

/// What a run's steps.csv adds up to, a resumed run's from its beginning.
struct StepTotals {
    std::int64_t steps = 0;          ///< accepted
    double simulated_seconds = 0.0;  ///< time of the last row
    double wall_seconds = 0.0;       ///< all phases
    double cpu_seconds = 0.0;
    PhaseSeconds phases;
    double max_penetration = 0.0;  ///< m
    std::int64_t crossings = 0;
    double max_kkt_residual = 0.0;
    std::int64_t halved_steps = 0;
    std::optional<FeatureTotals> features;
};

/// Reads steps.csv in constant memory; a torn last line is left out. InputError if it is not one.
StepTotals sum_steps(const std::string& steps_csv);

/// The phases in the order of a step, with the names that report.json gives them, and what is done in them.
struct NamedSeconds {
    const char* name;
    double seconds;
    const char* what;
};
std::vector<NamedSeconds> list_phases(const PhaseSeconds& phases);

/// What a run says about itself at its end, however it ended.
struct RunReport {
    RunStatus status = RunStatus::Finished;
    std::string message;  ///< why it stopped; empty if finished
    StepTotals totals;
    std::int64_t peak_memory_bytes = 0;
    std::vector<std::string>
        effects;  ///< of: bending damping gravity wind pull pin obstacle eol remesh friction
    std::vector<std::string> warnings;
    nlohmann::ordered_json scene = nlohmann::ordered_json::object();  ///< as run, every default written out
    std::string version;
    int threads = 1;
};

nlohmann::ordered_json to_json(const RunReport& report);

/// report.json, replaced atomically. Throws std::system_error naming the path where the disk refuses.
void write_report_json(const std::string& path, const RunReport& report);

/// Of this process so far: greatest resident memory, and CPU seconds of all threads.
std::int64_t peak_memory_bytes();
double process_cpu_seconds();

}  // namespace arris
