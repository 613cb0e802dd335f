// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/report/report_html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>

#include "app/export/viewer_block.h"
#include "app/files/atomic_file.h"
#include "app/files/frame_files.h"
#include "app/report/page_template.h"
#include "app/report/report_features.h"
#include "app/report/report_plots.h"
#include "app/report/scene_picture.h"
#include "app/report/svg_plot.h"
#include "app/report/verdict.h"
#include "app/text/html_escape.h"
#include "embedded/report_template.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMaxProbePlots = 24;
constexpr std::size_t kMaxSceneValue = 400;  // bytes shown of one key's value

std::string format_seconds(double seconds)
{
    if (seconds < 1.0) return fmt::format("{:.3g} ms", 1e3 * seconds);
    if (seconds < 120.0) return fmt::format("{:.3g} s", seconds);
    const double whole = std::floor(seconds);
    const double hours = std::floor(whole / 3600.0), minutes = std::floor((whole - 3600.0 * hours) / 60.0);
    if (hours < 1.0) return fmt::format("{} min {} s", minutes, whole - 60.0 * minutes);
    return fmt::format("{} h {} min", hours, minutes);
}

std::string format_bytes(std::int64_t bytes)
{
    const double mebibytes = static_cast<double>(bytes) / (1024.0 * 1024.0);
    return mebibytes < 1024.0 ? fmt::format("{:.1f} MiB", mebibytes)
                              : fmt::format("{:.2f} GiB", mebibytes / 1024.0);
}

std::string status_words(RunStatus status)
{
    std::string words = to_string(status);
    std::replace(words.begin(), words.end(), '_', ' ');
    return words;
}

std::string verdict_html(const RunReport& report)
{
    const bool is_bad = has_passed_through(report.totals) ||
                        (report.status != RunStatus::Finished && report.status != RunStatus::Interrupted);
    const char* tone = is_bad ? "bad" : report.status == RunStatus::Finished ? "good" : "warn";
    return fmt::format("<p class=\"verdict {}\">{}</p>\n<p class=\"why\">Status: {}</p>", tone,
                       escape_html(verdict(report)), status_words(report.status));
}

/// The time (s) of the run's frame with this number.
double frame_time(const RunReport& report, std::int64_t frame)
{
    const ordered_json::json_pointer key("/output/frames_per_second");
    const bool is_known = report.scene.contains(key) && report.scene[key].is_number();
    return is_known ? static_cast<double>(frame) / report.scene[key].get<double>() : 0.0;
}

/// A picture of the last frame, or the reason that there is none. Nothing for a run without frames.
std::string picture_html(const std::string& run_dir, const RunReport& report)
{
    try {
        const std::int64_t frames = count_frames(run_dir);
        if (frames == 0) return "";
        const double time = frame_time(report, frames - 1);
        const std::string png =
            draw_scene(read_frame(frame_file(run_dir, frames - 1, "ply")), read_obstacles(run_dir), time);
        return fmt::format(
            "<figure class=\"picture\"><img width=\"720\" height=\"450\" alt=\"The cloth and the obstacles "
            "at "
            "the last frame, seen obliquely from above\" src=\"data:image/png;base64,{}\">"
            "<figcaption>The last frame, at {:.4g} s</figcaption></figure>\n",
            base64(Bytes(png.begin(), png.end())), time);
    } catch (const InputError& error) {  // a damaged file of the run must not cost the report
        return "<p>There is no picture: " + escape_html(error.what()) + "</p>\n";
    }
}

std::string viewer_html(const std::string& run_dir)
{
    if (!std::filesystem::exists(run_dir + "/viewer.html")) return "";
    return "<p class=\"viewer\"><a href=\"viewer.html\">Play all frames in the viewer</a></p>\n";
}

/// A figure of the report: its name, its value, a short note, and a one-line explanation.
struct Fact {
    std::string_view name;
    std::string value, note;
    std::string_view what;
    bool is_bad = false;
};

std::string fact_html(const Fact& fact)
{
    std::string html = fmt::format("<div class=\"fact{}\"><dt>{}</dt><dd>{}", fact.is_bad ? " bad" : "",
                                   fact.name, fact.value);
    if (!fact.note.empty()) html += fmt::format("<small>{}</small>", fact.note);
    return html + fmt::format("</dd><dd class=\"why\">{}</dd></div>\n", fact.what);
}

std::vector<Fact> work_facts(const RunReport& report)
{
    const StepTotals& totals = report.totals;
    const std::string halved =
        totals.halved_steps > 0 ? fmt::format("{} of them halved", totals.halved_steps) : "";
    const std::string a_step =
        totals.steps > 0
            ? format_seconds(totals.wall_seconds / static_cast<double>(totals.steps)) + " per step"
            : "";
    const std::string threads = fmt::format("{} thread{}", report.threads, report.threads == 1 ? "" : "s");
    return {
        {"Simulated", fmt::format("{:.6g} s", totals.simulated_seconds), "",
         "Simulated time since the start of the scene."},
        {"Steps", fmt::format("{}", totals.steps), halved,
         totals.halved_steps > 0 ? "Accepted steps. A halved step is shorter than planned: the whole step "
                                   "was not accepted, or too much material would have flowed in it."
                                 : "Accepted steps, each as long as planned."},
        {"Wall time", format_seconds(totals.wall_seconds), a_step,
         "Elapsed time, writing of files included."},
        {"CPU time", format_seconds(totals.cpu_seconds), threads, "Sum over all threads."},
        {"BLAS kernel", report.kernel, report.processor,
         "Every processor gives the same result with the same kernel and the same build."},
        {"Peak memory", format_bytes(report.peak_memory_bytes), "", "Largest memory in use at one time."},
    };
}

std::vector<Fact> quality_facts(const RunReport& report, std::optional<double> tolerance)
{
    const StepTotals& totals = report.totals;
    std::vector<Fact> facts;
    // Figures of an effect that is off have no meaning.
    const bool has_obstacles = is_on(report.effects, "obstacle"),
               has_layers = is_on(report.effects, "self_contact");
    if (has_obstacles)
        facts.push_back({"Greatest penetration", fmt::format("{:.3g} m", totals.max_penetration), "",
                         "Largest depth of the cloth in an obstacle, measured at each frame; must be 0.",
                         totals.max_penetration > 0});
    if (has_obstacles || has_layers)
        facts.push_back(
            {"Crossings", fmt::format("{}", totals.crossings), "",
             !has_layers ? "Number of times the cloth has passed through an obstacle; must be 0."
             : !has_obstacles
                 ? "Number of times the cloth has passed through itself; must be 0."
                 : "Number of times the cloth has passed through an obstacle or itself; must be 0.",
             totals.crossings > 0});
    if (totals.features)
        facts.push_back({"EOL share", format_share(totals.features->eol_share()), "",
                         "Share of EOL vertices among the contacts that press on sharp features for at least "
                         "two steps. Cloth slides over a feature through an EOL vertex; at the other "
                         "contacts coarse cloth may snag."});
    facts.push_back({"Greatest KKT residual", fmt::format("{:.2e}", totals.max_kkt_residual),
                     tolerance ? fmt::format("{:.3g} allowed", *tolerance) : "",
                     "Largest relative error of a velocity solve in balance of forces and contact "
                     "conditions; 1e-15 is rounding.",
                     tolerance && !(totals.max_kkt_residual <= *tolerance)});
    return facts;
}

std::string facts_html(const RunReport& report, std::optional<double> tolerance)
{
    std::string html;
    for (const Fact& fact : work_facts(report)) html += fact_html(fact);
    for (const Fact& fact : quality_facts(report, tolerance)) html += fact_html(fact);
    return html;
}

std::string features_html(const StepTotals& totals)
{
    if (!totals.features) return "";
    return "<section><h2>Contacts on sharp features</h2>\n<p class=\"why\">Contacts that press on sharp "
           "edges, corners, wires and nails of obstacles, counted once per step. An EOL vertex lets material "
           "flow over the feature. A row of the velocity solve only keeps the cloth off the feature; the "
           "table gives the reason for each row.</p>\n"
           "<table class=\"causes\"><tbody>\n" +
           feature_rows_html(*totals.features) + "</tbody></table></section>";
}

std::string effects_html(const RunReport& report)
{
    std::string html = "<table class=\"effects\"><tbody>\n";
    for (const bool is_on : {true, false})
        for (const SceneEffect& effect : report.effects)
            if (effect.is_on == is_on)
                html +=
                    fmt::format("<tr class=\"{0}\"><th scope=\"row\">{1}</th><td>{0}</td><td>{2}</td></tr>\n",
                                is_on ? "on" : "off", escape_html(effect.name), escape_html(effect.reason));
    return report.effects.empty() ? "<p class=\"nothing\">none</p>" : html + "</tbody></table>";
}

std::string warnings_html(const RunReport& report)
{
    if (report.warnings.empty()) return "";
    std::string html = "<section class=\"warnings\"><h2>Warnings</h2><ul>";
    for (const std::string& warning : report.warnings) html += "<li>" + escape_html(warning) + "</li>";
    return html + "</ul></section>";
}

std::string phases_html(const StepTotals& totals)
{
    std::string html;
    std::size_t colour = 0;
    for (const NamedSeconds& phase : list_phases(totals.phases)) {
        const double share = totals.wall_seconds > 0.0 ? 100.0 * phase.seconds / totals.wall_seconds : 0.0;
        html += fmt::format(
            "<tr><th scope=\"row\">{}<small class=\"why\">{}</small></th><td class=\"bar\"><span "
            "class=\"fill c{}\" style=\"width:{:.1f}%\"></span></td><td>{}</td><td>{:.1f} %</td></tr>\n",
            phase.name, phase.what, colour++, share, format_seconds(phase.seconds), share);
    }
    return html;
}

std::string plots_html(const std::vector<Plot>& plots)
{
    std::string html;
    for (const Plot& plot : plots) html += draw_plot(plot);
    return html;
}

std::string probes_html(const std::string& probes_csv)
{
    if (!std::filesystem::exists(probes_csv)) return "";
    const ProbePlots probes = plot_probes(probes_csv, kMaxProbePlots);
    if (probes.plots.empty()) return "";
    std::string html = "<section><h2>Probes</h2><div class=\"plots\">" + plots_html(probes.plots) + "</div>";
    if (probes.left_out > 0) html += fmt::format("<p>{} more probes are in probes.csv.</p>", probes.left_out);
    return html + "</section>";
}

std::string scene_value(const ordered_json& value)
{
    std::string text = value.is_string() ? value.get<std::string>()
                                         : value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
    if (text.size() <= kMaxSceneValue) return escape_html(text);
    // Do not cut inside a UTF-8 character.
    std::size_t end = kMaxSceneValue;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
    return escape_html(text.substr(0, end)) +
           fmt::format(" … <i>({} characters; complete in report.json)</i>", text.size());
}

// Lists tables and arrays of tables row by row, with dotted keys as in --set. Recursion is only a few levels
// deep.
void append_scene_rows(const std::string& key, const ordered_json& value, std::string& html)
{
    const bool is_tables = value.is_array() && !value.empty() && value.front().is_object();
    if (!value.is_object() && !is_tables) {
        html +=
            "<tr><th scope=\"row\">" + escape_html(key) + "</th><td>" + scene_value(value) + "</td></tr>\n";
        return;
    }
    const std::string prefix = key.empty() ? "" : key + ".";
    std::size_t index = 0;
    for (const auto& [name, child] : value.items())
        append_scene_rows(prefix + (is_tables ? std::to_string(index++) : name), child, html);
}

std::string scene_html(const ordered_json& scene)
{
    std::string html;
    append_scene_rows("", scene, html);
    return html;
}

std::string title_of(const RunReport& report)
{
    const auto title = report.scene.find("title");
    const bool has_title =
        title != report.scene.end() && title->is_string() && !title->get<std::string>().empty();
    return has_title ? title->get<std::string>() : "Untitled scene";
}

std::optional<double> tolerance_of(const RunReport& report)
{
    const ordered_json::json_pointer key("/solver/tolerance");
    if (!report.scene.contains(key) || !report.scene[key].is_number()) return std::nullopt;
    return report.scene[key].get<double>();
}

}  // namespace

void write_report_html(const std::string& run_dir, const RunReport& report)
{
    const std::optional<double> tolerance = tolerance_of(report);
    const std::string page = fill_template(
        embedded::report_template(), {{"title", escape_html(title_of(report))},
                                      {"verdict", verdict_html(report)},
                                      {"picture", picture_html(run_dir, report)},
                                      {"viewer", viewer_html(run_dir)},
                                      {"facts", facts_html(report, tolerance)},
                                      {"effects", effects_html(report)},
                                      {"warnings", warnings_html(report)},
                                      {"features", features_html(report.totals)},
                                      {"phases", phases_html(report.totals)},
                                      {"plots", plots_html(plot_steps(run_dir + "/steps.csv", tolerance))},
                                      {"probes", probes_html(run_dir + "/probes.csv")},
                                      {"scene", scene_html(report.scene)},
                                      {"version", escape_html(report.version)}});
    write_atomically(run_dir + "/report.html", page);
}

}  // namespace arris
