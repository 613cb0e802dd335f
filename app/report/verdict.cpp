// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/report/verdict.h"

#include <fmt/format.h>

#include "app/text/counted.h"

namespace arris {
namespace {

std::string ending_words(const RunReport& report)
{
    if (report.status == RunStatus::Finished) return "Finished.";
    const auto duration = report.scene.find("duration");
    std::string words = report.status == RunStatus::Interrupted ? "Interrupted" : "Stopped";
    words += fmt::format(" at {:.4g} s", report.totals.simulated_seconds);
    if (duration != report.scene.end() && duration->is_number())
        words += fmt::format(" of {:.4g} s", duration->get<double>());
    if (report.status == RunStatus::Interrupted) return words + "; arris resume continues the run.";
    if (!report.message.empty()) words += ": " + report.message;
    return words.ends_with('.') ? words : words + ".";
}

std::string passing_words(const RunReport& report)
{
    const StepTotals& totals = report.totals;
    if (totals.crossings > 0)
        return fmt::format("Something passed through the cloth or an obstacle {}.",
                           counted(totals.crossings, "time", "times"));
    if (totals.max_penetration > 0.0)
        return fmt::format("The cloth was inside an obstacle, {:.3g} m deep.", totals.max_penetration);
    if (report.status == RunStatus::Penetration)
        return "The step that would have passed through is not kept.";
    const bool has_obstacles = is_on(report.effects, "obstacle"),
               has_layers = is_on(report.effects, "self_contact");
    if (has_obstacles && has_layers) return "Nothing passed through anything.";
    if (has_obstacles) return "The cloth passed through no obstacle; whether through itself was not checked.";
    if (has_layers) return "The cloth did not pass through itself.";
    return "There was no obstacle; whether the cloth passed through itself was not checked.";
}

}  // namespace

std::string verdict(const RunReport& report)
{
    const std::string warnings =
        report.warnings.empty() ? "No warnings" : counted(report.warnings.size(), "warning", "warnings");
    return fmt::format("{} {} {}.", ending_words(report), passing_words(report), warnings);
}

bool has_passed_through(const StepTotals& totals)
{
    return totals.crossings > 0 || totals.max_penetration > 0.0;
}

}  // namespace arris
