// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/report/report.h"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <fstream>

#include "app/files/atomic_file.h"
#include "app/files/csv_table.h"
#include "app/text/printable.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

struct Phase {
    const char* name;
    double PhaseSeconds::*seconds;
    const char* what;
};

constexpr Phase kPhases[] = {
    {"move", &PhaseSeconds::move, "moves obstacles and pins to the end of the step"},
    {"contacts", &PhaseSeconds::contacts, "finds contacts between cloth and obstacles"},
    {"conform", &PhaseSeconds::conform,
     "places vertices on sharp features and cleans up the mesh around them"},
    {"transfer", &PhaseSeconds::transfer, "carries velocities over to the changed mesh"},
    {"assemble", &PhaseSeconds::assemble, "assembles forces and the matrix"},
    {"factorise", &PhaseSeconds::factorise, "factorises the matrix"},
    {"solve", &PhaseSeconds::solve, "finds the velocity that meets the contact conditions"},
    {"check", &PhaseSeconds::check, "proves that the motion passes through no obstacle"},
    {"advance", &PhaseSeconds::advance,
     "commits the step; includes loading the scene, and a last step that was cut off or failed"},
    {"output", &PhaseSeconds::output, "writes frames, tables, viewer and other formats"},
};

// Not std::max, so that NaN is kept: every comparison with NaN is false.
double greatest(double so_far, double value)
{
    return value <= so_far ? so_far : value;
}

std::int64_t to_count(double cell, const std::string& path)
{
    constexpr double kGreatestExact = 9007199254740992.0;  // 2^53: larger integers are not all doubles
    if (!(cell >= 0.0 && cell <= kGreatestExact))
        throw InputError(path + ": a count is not a number from 0 to 2^53");
    return static_cast<std::int64_t>(cell);
}

}  // namespace

std::string to_string(RunStatus status)
{
    switch (status) {
        case RunStatus::Finished:
            return "finished";
        case RunStatus::Interrupted:
            return "interrupted";
        case RunStatus::Infeasible:
            return "infeasible";
        case RunStatus::NotConverged:
            return "not_converged";
        case RunStatus::Penetration:
            return "penetration";
        case RunStatus::NotFinite:
            return "not_finite";
        case RunStatus::IoError:
            return "io_error";
        case RunStatus::Unsewn:
            return "unsewn";
    }
    return "";
}

std::optional<double> FeatureTotals::eol_share() const
{
    std::int64_t rows = 0;
    for (std::size_t k = 0; k < kConstraintCauses; ++k)
        if (counts_in_share(static_cast<ConstraintCause>(k))) rows += by_cause[k];
    if (eol + rows == 0) return std::nullopt;
    return static_cast<double>(eol) / static_cast<double>(eol + rows);
}

StepTotals sum_steps(const std::string& steps_csv)
{
    CsvReader reader(steps_csv);
    const std::size_t time = reader.column("time"), cpu = reader.column("cpu_s"),
                      halved = reader.column("halved");
    const std::size_t penetration = reader.column("max_penetration"), crossings = reader.column("crossings");
    const std::size_t residual = reader.column("kkt_residual"), step = reader.column("step");
    std::vector<std::size_t> phase_columns;
    for (const Phase& phase : kPhases) phase_columns.push_back(reader.column(std::string(phase.name) + "_s"));
    const std::size_t eol = reader.column("eol_pressing");
    std::vector<std::size_t> cause_columns;
    for (std::size_t k = 0; k < kConstraintCauses; ++k)
        cause_columns.push_back(reader.column(rows_column(static_cast<ConstraintCause>(k))));

    StepTotals totals;
    std::vector<double> row;
    while (reader.next(row)) {
        totals.steps = to_count(row[step], steps_csv);
        totals.simulated_seconds = row[time];
        totals.cpu_seconds += row[cpu];
        for (std::size_t i = 0; i < phase_columns.size(); ++i) {
            totals.phases.*kPhases[i].seconds += row[phase_columns[i]];
            totals.wall_seconds += row[phase_columns[i]];
        }
        totals.max_penetration = greatest(totals.max_penetration, row[penetration]);
        totals.crossings = std::max(totals.crossings, to_count(row[crossings], steps_csv));
        totals.max_kkt_residual = greatest(totals.max_kkt_residual, row[residual]);
        totals.halved_steps += to_count(row[halved], steps_csv);
        if (std::isnan(row[eol])) continue;
        if (!totals.features) totals.features.emplace();
        totals.features->eol += to_count(row[eol], steps_csv);
        for (std::size_t k = 0; k < kConstraintCauses; ++k)
            totals.features->by_cause[k] += to_count(row[cause_columns[k]], steps_csv);
    }
    return totals;
}

std::vector<NamedSeconds> list_phases(const PhaseSeconds& phases)
{
    std::vector<NamedSeconds> list;
    for (const Phase& phase : kPhases) list.push_back({phase.name, phases.*phase.seconds, phase.what});
    return list;
}

namespace {

nlohmann::ordered_json to_json(const FeatureTotals& features)
{
    nlohmann::ordered_json rows = nlohmann::ordered_json::object();
    for (std::size_t k = 0; k < kConstraintCauses; ++k)
        rows[to_string(static_cast<ConstraintCause>(k))] = features.by_cause[k];
    nlohmann::ordered_json json = {{"eol", features.eol}, {"rows", rows}, {"eol_share", nullptr}};
    if (const std::optional<double> share = features.eol_share()) json["eol_share"] = *share;
    return json;
}

}  // namespace

nlohmann::ordered_json to_json(const RunReport& report)
{
    nlohmann::ordered_json phases = nlohmann::ordered_json::object();
    for (const NamedSeconds& phase : list_phases(report.totals.phases)) phases[phase.name] = phase.seconds;
    std::vector<std::string> effects;
    for (const SceneEffect& effect : report.effects)
        if (effect.is_on) effects.push_back(effect.name);
    const StepTotals& totals = report.totals;
    nlohmann::ordered_json json = {
        {"status", to_string(report.status)},
        {"message", report.message},
        {"steps", totals.steps},
        {"simulated_seconds", totals.simulated_seconds},
        {"wall_seconds", totals.wall_seconds},
        {"cpu_seconds", totals.cpu_seconds},
        {"peak_memory_bytes", report.peak_memory_bytes},
        {"max_penetration", totals.max_penetration},
        {"crossings", totals.crossings},
        {"max_kkt_residual", totals.max_kkt_residual},
        {"halved_steps", totals.halved_steps},
        {"effects", effects},
        {"phases", phases},
        {"warnings", report.warnings},
        {"scene", report.scene},
        {"version", report.version},
        {"threads", report.threads},
        {"blas_kernel", report.kernel},
        {"processor", report.processor},
    };
    if (totals.features) json["feature_contacts"] = to_json(*totals.features);
    return json;
}

void write_report_json(const std::string& path, const RunReport& report)
{
    constexpr int kIndent = 2;
    constexpr bool kEscapeNonAscii = false;
    // Text that is not UTF-8, such as a file name in a message, must not prevent the report.
    const auto replace = nlohmann::ordered_json::error_handler_t::replace;
    write_atomically(path, to_json(report).dump(kIndent, ' ', kEscapeNonAscii, replace) + "\n");
}

std::string read_status(const std::string& path)
{
    std::ifstream in(path);
    const nlohmann::json report = nlohmann::json::parse(in, nullptr, /*allow_exceptions=*/false);
    if (!report.is_object() || !report.contains("status") || !report["status"].is_string())
        throw InputError(printable(path) + ": is not the report of a run: it has no status");
    return report["status"];
}

std::string processor_name()
{
    std::ifstream in("/proc/cpuinfo");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("model name"))
            if (const std::size_t colon = line.find(": "); colon != std::string::npos)
                return line.substr(colon + 2);
    return {};
}

std::int64_t peak_memory_bytes()
{
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    return std::int64_t{1024} * usage.ru_maxrss;  // Linux counts in KiB
}

double process_cpu_seconds()
{
    timespec time = {};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace arris
