// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/study_panels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "app/study/log_panel.h"

namespace arris {
namespace {

constexpr std::size_t kMostSharePanels = 4;

/// Colours curves by method, and dashes those of one method by their order.
class CurveStyles {
  public:
    void apply(const std::string& method, PanelCurve& curve)
    {
        const auto [entry, is_new] = dashes_.try_emplace(method, 0);
        if (is_new) colours_[method] = static_cast<int>(colours_.size());
        curve.colour = colours_[method];
        curve.dash = entry->second++;
    }

  private:
    std::map<std::string, int> dashes_, colours_;
};

std::string curve_name(const StudyCurve& curve)
{
    return curve.name.empty() ? "all runs" : curve.name;
}

// An order is positive where the error falls with refinement: with the cells, or with the step.
std::string slope_text(const StudyCurve& curve, const std::string& key, bool has_error)
{
    if (!curve.slope) return "";
    const double sign = has_error && without_piece(key) == "cloth.resolution" ? -1.0 : 1.0;
    const double rounded = 0.01 * std::round(100.0 * sign * *curve.slope) + 0.0;  // no minus before a zero
    return fmt::format(" ({} {:.2f})", has_error ? "order" : "exponent", rounded);
}

std::vector<double> different_numbers(const std::vector<RunOutcome>& outcomes, const std::string& key,
                                      bool has_error)
{
    std::vector<double> numbers;
    for (const RunOutcome& outcome : outcomes)
        if (!outcome.run.is_further) numbers.push_back(abscissa(outcome, key, has_error));
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    return numbers;
}

/// "Error", or without a reference the column that takes its place.
std::string error_name(const ErrorRule& rule)
{
    return rule.reference == ErrorRule::Reference::None ? rule.column : "Error";
}

std::string error_unit(const ErrorRule& rule)
{
    if (rule.reference == ErrorRule::Reference::None) return rule.column;
    return rule.quantity == ErrorRule::Quantity::Column ? "error of " + rule.column : "error (m)";
}

void add_front(const std::vector<RunOutcome>& outcomes, LogPanel& panel)
{
    for (const std::size_t i : find_pareto_front(outcomes)) {
        panel.front_x.push_back(*outcomes[i].cpu_median());
        panel.front_y.push_back(outcomes[i].error->value);
    }
    panel.is_front_joined = list_problems(outcomes).size() == 1;
}

void add_notes(const std::vector<RunOutcome>& outcomes, LogPanel& panel)
{
    const auto exact = std::count_if(outcomes.begin(), outcomes.end(), [](const RunOutcome& outcome) {
        return is_compared(outcome) && !(outcome.error->value > 0.0);
    });
    if (exact > 0)
        panel.notes.push_back(fmt::format("triangles at the lower border: exactly 0 ({} runs)", exact));
    const auto references = std::count_if(outcomes.begin(), outcomes.end(),
                                          [](const RunOutcome& outcome) { return outcome.is_reference; });
    if (references > 0)
        panel.notes.push_back(fmt::format("not drawn: {} taken as reference",
                                          references == 1 ? "the run" : fmt::format("{} runs", references)));
}

void add_point(double x, double y, PanelCurve& curve)
{
    if (!(y > 0.0)) {
        curve.zero_x.push_back(x);
        return;
    }
    curve.x.push_back(x);
    curve.y.push_back(y);
}

std::vector<StudyCurve> curves_or_one(const Study& study, const std::vector<RunOutcome>& outcomes,
                                      const std::vector<NumericKey>& keys)
{
    if (!keys.empty()) return make_curves(study, outcomes, keys.front().key);
    std::vector<StudyCurve> curves;  // no number is varied: each run is a method
    for (std::size_t i = 0; i < outcomes.size(); ++i)
        if (!outcomes[i].run.is_further) curves.push_back({name_method(study, outcomes[i].run), "", {i}, {}});
    for (StudyCurve& curve : curves) curve.name = curve.method;
    return curves;
}

LogPanel cost_panel(const Study& study, const std::vector<RunOutcome>& outcomes,
                    const std::vector<NumericKey>& keys)
{
    LogPanel panel;
    panel.title = error_name(*study.error) + " against CPU time";
    panel.x_label = fmt::format("CPU time of a run (s{})",
                                study.repeats > 1 ? fmt::format(", median of {}", study.repeats) : "");
    panel.y_label = error_unit(*study.error);
    CurveStyles styles;
    for (const StudyCurve& curve : curves_or_one(study, outcomes, keys)) {
        PanelCurve drawn;
        drawn.name = curve_name(curve);
        styles.apply(curve.method, drawn);
        for (const std::size_t i : curve.runs) {
            if (!is_compared(outcomes[i])) continue;
            add_point(*outcomes[i].cpu_median(), outcomes[i].error->value, drawn);
        }
        panel.curves.push_back(std::move(drawn));
    }
    for (const RunOutcome& outcome : outcomes)
        if (!outcome.is_finished() && outcome.cpu_median()) panel.failed_x.push_back(*outcome.cpu_median());
    add_front(outcomes, panel);
    add_notes(outcomes, panel);
    return panel;
}

/// Error, or in a study without one CPU time a step, against a varied number.
LogPanel number_panel(const Study& study, const std::vector<RunOutcome>& outcomes, const NumericKey& key)
{
    const bool has_error = study.error.has_value();
    LogPanel panel;
    panel.title = (has_error ? error_name(*study.error) : "CPU time of a step") + " against " + key.label;
    panel.x_label = key.label;
    panel.y_label = has_error ? error_unit(*study.error) : "CPU time of a step (ms)";
    panel.named_x = different_numbers(outcomes, key.key, has_error);
    CurveStyles styles;
    for (const StudyCurve& curve : make_curves(study, outcomes, key.key)) {
        PanelCurve drawn;
        drawn.name = curve_name(curve) + slope_text(curve, key.key, has_error);
        styles.apply(curve.method, drawn);
        for (const std::size_t i : curve.runs) {
            const RunOutcome& outcome = outcomes[i];
            if (!outcome.is_finished()) panel.failed_x.push_back(abscissa(outcome, key.key, has_error));
            if (has_error ? !is_compared(outcome) : !outcome.is_finished()) continue;
            add_point(abscissa(outcome, key.key, has_error),
                      has_error ? outcome.error->value : 1e3 * cpu_seconds_a_step(outcome), drawn);
        }
        panel.curves.push_back(std::move(drawn));
    }
    if (has_error) add_notes(outcomes, panel);
    return panel;
}

SharePanel share_panel(const std::vector<RunOutcome>& outcomes, const StudyCurve& curve)
{
    SharePanel panel;
    panel.title = "Phases of a step" + (curve.name.empty() ? "" : ", " + curve.name);
    panel.x_label = "vertices of the cloth";
    panel.names = phase_names();
    for (const std::size_t i : curve.runs) {
        const std::vector<double>& seconds = outcomes[i].phase_seconds;
        const double sum = std::accumulate(seconds.begin(), seconds.end(), 0.0);
        const bool ascends = panel.x.empty() || outcomes[i].vertices > panel.x.back();
        if (!outcomes[i].is_finished() || !(sum > 0.0) || !ascends) continue;
        panel.x.push_back(outcomes[i].vertices);
        panel.shares.emplace_back();
        for (const double phase : seconds) panel.shares.back().push_back(phase / sum);
    }
    const std::vector<PhaseExponent> exponents = fit_phases(outcomes, curve);
    for (std::size_t k = 0; k < exponents.size(); ++k)
        if (exponents[k].exponent)
            panel.names[k] += fmt::format(" (exponent {:.2f})", *exponents[k].exponent);
    panel.named_x = panel.x;
    return panel;
}

}  // namespace

std::vector<PhaseExponent> fit_phases(const std::vector<RunOutcome>& outcomes, const StudyCurve& curve)
{
    std::vector<PhaseExponent> exponents;
    const std::vector<std::string> names = phase_names();
    for (std::size_t k = 0; k < names.size(); ++k) {
        std::vector<double> x, y;
        for (const std::size_t i : curve.runs) {
            const RunOutcome& outcome = outcomes[i];
            if (!outcome.is_finished() || outcome.steps == 0 || outcome.phase_seconds.empty()) continue;
            x.push_back(outcome.vertices);
            y.push_back(outcome.phase_seconds[k] / static_cast<double>(outcome.steps));
        }
        exponents.push_back({names[k], fit_slope(x, y)});
    }
    return exponents;
}

std::string draw_study(const Study& study, const std::vector<RunOutcome>& outcomes)
{
    const std::vector<NumericKey> keys = list_numeric_keys(study);
    std::vector<PanelDrawing> panels;
    if (study.error) panels.push_back(draw_panel(cost_panel(study, outcomes, keys)));
    for (const NumericKey& key : keys) panels.push_back(draw_panel(number_panel(study, outcomes, key)));
    if (!study.error && !keys.empty()) {
        const std::vector<StudyCurve> curves = make_curves(study, outcomes, keys.front().key);
        for (std::size_t i = 0; i < std::min(curves.size(), kMostSharePanels); ++i)
            if (const SharePanel panel = share_panel(outcomes, curves[i]); panel.x.size() > 1)
                panels.push_back(draw_panel(panel));
    }
    return draw_page(study.title, panels);
}

}  // namespace arris
