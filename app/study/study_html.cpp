// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "app/report/page_template.h"
#include "app/study/study_files.h"
#include "app/text/html_escape.h"
#include "embedded/study_template.h"

namespace arris {
namespace {

std::string number_cell(const std::optional<double>& value, double scale = 1.0)
{
    return fmt::format("<td class=\"number\">{}</td>", value ? fmt::format("{:.3g}", scale * *value) : "");
}

std::string text_cell(const std::string& text)
{
    return "<td>" + escape_html(text) + "</td>";
}

std::string columns_html(const Study& study)
{
    std::string html;
    for (const std::string& key : study.keys) html += "<th>" + escape_html(key) + "</th>";
    const bool has_reference = study.error && study.error->reference != ErrorRule::Reference::None;
    if (study.error)
        html += fmt::format("<th>{}</th><th>error, %</th>",
                            has_reference ? "error" : escape_html(study.error->column));
    html += "<th>CPU s</th><th>least</th><th>greatest</th><th>ms a step</th><th>steps</th><th>vertices</th>";
    return html + "<th>memory, MiB</th><th>outcome</th>";
}

std::string outcome_cell(const RunOutcome& outcome)
{
    const std::string link =
        fmt::format("<a href=\"runs/{}/report.html\">{}</a>", escape_html(outcome.run.name),
                    outcome.run.is_further ? "reference run"
                    : outcome.is_reference ? "finest run"
                                           : "finished");
    if (outcome.is_finished()) return "<td>" + link + "</td>";
    return text_cell(outcome.status + (outcome.message.empty() ? "" : ": " + outcome.message));
}

std::string row_html(const Study& study, const RunOutcome& outcome, bool is_on_front)
{
    std::string html = fmt::format("<tr class=\"{}\">", !outcome.is_finished() ? "failed"
                                                        : outcome.is_reference ? "reference"
                                                        : is_on_front          ? "front"
                                                                               : "");
    for (const std::string& key : study.keys) {
        const Setting* setting = find_setting(outcome.run.settings, key);
        html += text_cell(setting ? setting->text : "");
    }
    const std::vector<double>& cpu = outcome.cpu_seconds;
    if (study.error) {
        html += number_cell(outcome.error ? std::optional(outcome.error->value) : std::nullopt);
        html += number_cell(outcome.error ? outcome.error->relative() : std::nullopt, 100.0);
    }
    using Maybe = std::optional<double>;
    const bool has_steps = outcome.steps > 0 && !cpu.empty();
    html += number_cell(outcome.cpu_median());
    html += number_cell(cpu.empty() ? Maybe() : *std::min_element(cpu.begin(), cpu.end()));
    html += number_cell(cpu.empty() ? Maybe() : *std::max_element(cpu.begin(), cpu.end()));
    html += number_cell(has_steps ? Maybe(1e3 * *outcome.cpu_median() / static_cast<double>(outcome.steps))
                                  : Maybe());
    html += fmt::format("<td class=\"number\">{}</td><td class=\"number\">{}</td>",
                        has_steps ? fmt::format("{}", outcome.steps) : "",
                        has_steps ? fmt::format("{}", outcome.vertices) : "");
    html += number_cell(cpu.empty() ? Maybe()
                                    : static_cast<double>(outcome.peak_memory_bytes) / (1024.0 * 1024.0));
    return html + outcome_cell(outcome) + "</tr>\n";
}

std::string rows_html(const Study& study, const std::vector<RunOutcome>& outcomes)
{
    std::set<std::size_t> front;
    for (const std::size_t i : find_pareto_front(outcomes)) front.insert(i);
    std::string html;
    for (std::size_t i = 0; i < outcomes.size(); ++i) html += row_html(study, outcomes[i], front.contains(i));
    return html;
}

std::string slopes_html(const Study& study, const std::vector<RunOutcome>& outcomes)
{
    std::string rows;
    for (const NumericKey& key : list_numeric_keys(study))
        for (const StudyCurve& curve : make_curves(study, outcomes, key.key))
            if (curve.slope)
                rows += "<tr>" + text_cell(key.key) + text_cell(curve.name) + number_cell(curve.slope) +
                        "</tr>\n";
    if (rows.empty()) return "";
    return fmt::format(
        "<section><h2>Fitted orders</h2>\n<p class=\"soft\">Slope of the logarithm of the {} by the "
        "logarithm of the "
        "varied number (least squares over all finished runs of a curve). Time steps: 2 is second order. "
        "Resolution: "
        "-2 is second "
        "order.</p>\n<table><thead><tr><th>by</th><th>curve</th><th>slope</th></tr></thead><tbody>\n{}"
        "</tbody></table></section>",
        study.error ? "error" : "CPU time of a step", rows);
}

std::string counts_text(const Study& study, const std::vector<RunOutcome>& outcomes)
{
    const auto finished = std::count_if(outcomes.begin(), outcomes.end(),
                                        [](const RunOutcome& outcome) { return outcome.is_finished(); });
    std::string text = fmt::format("{} of {} runs finished.", finished, outcomes.size());
    if (study.repeats > 1) text += fmt::format(" CPU times are medians of {} repetitions.", study.repeats);
    if (study.is_quick) text += " A quick, coarse variant of the study.";
    return text;
}

std::string facts_html(const Study& study, const StudyProvenance& provenance)
{
    const std::vector<std::pair<const char*, std::string>> facts = {
        {"study", study.path},
        {"scene", study.scene},
        {"settings of all runs", list_settings(study.common)},
        {"machine", fmt::format("{}", fmt::join(provenance.machines, "; "))},
        {"processes", provenance.engine + "; one thread a run"},
        {"compiler and flags", provenance.build},
        {"version", provenance.version}};
    std::string html;
    for (const auto& [name, value] : facts)
        if (!value.empty())
            html += fmt::format("<tr><th scope=\"row\">{}</th>{}</tr>\n", name, text_cell(value));
    return html;
}

}  // namespace

std::string study_html(const Study& study, const std::vector<RunOutcome>& outcomes,
                       const StudyProvenance& provenance, const std::string& svg)
{
    return fill_template(embedded::study_template(),
                         {{"title", escape_html(study.title)},
                          {"sentence", escape_html(tell_cheapest(study, outcomes))},
                          {"error", escape_html(tell_error(study, outcomes))},
                          {"counts", escape_html(counts_text(study, outcomes))},
                          {"svg", svg},
                          {"slopes", slopes_html(study, outcomes)},
                          {"columns", columns_html(study)},
                          {"rows", rows_html(study, outcomes)},
                          {"facts", facts_html(study, provenance)}});
}

}  // namespace arris
