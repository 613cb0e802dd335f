// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "app/study/study_files.h"

namespace arris {
namespace {

// A cell with a comma, quote or line end is quoted (RFC 4180). Control characters become spaces, so that a
// row is a line.
std::string cell(std::string text)
{
    std::replace_if(
        text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
    if (text.find_first_of(",\"") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

std::string cell(const std::optional<double>& value)
{
    return value ? fmt::format("{}", *value) : "";
}

std::string join(const std::vector<std::string>& cells)
{
    return fmt::format("{}\n", fmt::join(cells, ","));
}

void add_times(const RunOutcome& outcome, std::vector<std::string>& cells)
{
    const std::vector<double>& cpu = outcome.cpu_seconds;
    cells.push_back(cell(outcome.cpu_median()));
    cells.push_back(cpu.empty() ? "" : cell(*std::min_element(cpu.begin(), cpu.end())));
    cells.push_back(cpu.empty() ? "" : cell(*std::max_element(cpu.begin(), cpu.end())));
    cells.push_back(cpu.empty() ? "" : cell(median(outcome.wall_seconds)));
    cells.push_back(cpu.empty() ? "" : fmt::format("{}", outcome.peak_memory_bytes));
}

std::vector<std::string> make_row(const Study& study, const RunOutcome& outcome)
{
    std::vector<std::string> cells;
    for (const std::string& key : study.keys) {
        const Setting* setting = find_setting(outcome.run.settings, key);
        cells.push_back(setting ? cell(setting->text) : "");
    }
    const std::optional<RunError>& error = outcome.error;
    cells.push_back(error ? cell(error->value) : "");
    add_times(outcome, cells);
    cells.push_back(outcome.status);
    cells.push_back(cell(name_method(study, outcome.run)));
    cells.push_back(outcome.run.is_further ? "reference" : outcome.is_reference ? "finest" : "");
    cells.push_back(error ? cell(error->relative()) : "");
    cells.push_back(error ? cell(error->scale) : "");
    cells.push_back(error ? cell(error->mean) : "");
    cells.push_back(error ? cell(error->greatest) : "");
    const bool has_steps = !outcome.phase_seconds.empty();
    cells.push_back(has_steps ? fmt::format("{}", outcome.steps) : "");
    cells.push_back(has_steps ? fmt::format("{}", outcome.vertices) : "");
    cells.push_back(has_steps ? fmt::format("{}", outcome.max_penetration) : "");
    cells.push_back(has_steps ? fmt::format("{}", outcome.crossings) : "");
    for (std::size_t k = 0; k < phase_names().size(); ++k)
        cells.push_back(has_steps ? fmt::format("{}", outcome.phase_seconds[k]) : "");
    cells.push_back(cell(outcome.run.name));
    cells.push_back(cell(outcome.message));
    return cells;
}

}  // namespace

std::string study_csv(const Study& study, const std::vector<RunOutcome>& outcomes)
{
    std::vector<std::string> names;
    for (const std::string& key : study.keys) names.push_back(cell(key));
    for (const char* name :
         {"error", "cpu_s_median", "cpu_s_min", "cpu_s_max", "wall_s_median", "peak_memory_bytes", "status",
          "method", "role", "relative_error", "error_scale", "mean_distance", "greatest_distance", "steps",
          "vertices", "max_penetration", "crossings"})
        names.emplace_back(name);
    for (const std::string& phase : phase_names()) names.push_back(phase + "_s");
    names.insert(names.end(), {"run", "message"});
    std::string text = join(names);
    for (const RunOutcome& outcome : outcomes) text += join(make_row(study, outcome));
    return text;
}

}  // namespace arris
