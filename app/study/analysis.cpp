// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace arris {
namespace {

bool is_mesh_size(const std::string& key)
{
    return without_piece(key) == "cloth.resolution" || without_piece(key) == "cloth.edge_length";
}

std::string axis_label(const std::string& key, bool has_error)
{
    if (is_mesh_size(key) && !has_error) return "vertices of the cloth";
    if (without_piece(key) == "cloth.resolution") return "cells along the cloth's longer side";
    if (without_piece(key) == "cloth.edge_length") return "edge length (m)";
    if (key == "time.step") return "time step (s)";
    return key;
}

std::string join_words(const std::vector<std::string>& words)
{
    return fmt::format("{}", fmt::join(words, ", "));
}

bool is_axis(const Study& study, const std::string& key)
{
    return std::find(study.axis_keys.begin(), study.axis_keys.end(), key) != study.axis_keys.end();
}

/// Words for the telling settings of a run that `take` accepts.
template <class Take>
std::string name_settings(const Study& study, const StudyRun& run, const Take& take)
{
    std::vector<std::string> words;
    for (const std::string& key : study.telling_keys) {
        const Setting* setting = find_setting(run.settings, key);
        if (setting && take(key)) words.push_back(label_setting(*setting));
    }
    return join_words(words);
}

double number_of(const RunOutcome& outcome, const std::string& key)
{
    return *find_setting(outcome.run.settings, key)->number;
}

std::optional<double> slope_of(const std::vector<RunOutcome>& outcomes, const StudyCurve& curve,
                               const std::string& key, bool has_error)
{
    std::vector<double> x, y;
    for (const std::size_t i : curve.runs) {
        const RunOutcome& outcome = outcomes[i];
        if (has_error ? !is_compared(outcome) : !outcome.is_finished()) continue;
        x.push_back(abscissa(outcome, key, has_error));
        y.push_back(has_error ? outcome.error->value : cpu_seconds_a_step(outcome));
    }
    return fit_slope(x, y);
}

/// Whether an error can be judged. Without a reference a small value is not better than a large one.
bool has_reference(const RunOutcome& outcome)
{
    return is_compared(outcome) && outcome.error->scale.has_value();
}

bool dominates(const RunOutcome& a, const RunOutcome& b)
{
    const double cost_a = *a.cpu_median(), cost_b = *b.cpu_median();
    return a.run.problem == b.run.problem && cost_a <= cost_b && a.error->value <= b.error->value &&
           (cost_a < cost_b || a.error->value < b.error->value);
}

std::string tell_run(const Study& study, const RunOutcome& outcome)
{
    std::vector<Setting> telling;
    for (const std::string& key : study.telling_keys)
        if (const Setting* setting = find_setting(outcome.run.settings, key)) telling.push_back(*setting);
    return fmt::format("{} (error {:.2g} %, {:.3g} CPU s)",
                       telling.empty() ? "the scene as it is" : list_settings(telling),
                       100.0 * *outcome.error->relative(), *outcome.cpu_median());
}

/// "10 and 1 %: SETTINGS", one part for each run.
std::vector<std::string> tell_thresholds(const Study& study, const std::vector<RunOutcome>& outcomes,
                                         const std::vector<CheapestRun>& found)
{
    std::vector<std::string> parts;
    for (std::size_t first = 0, next = 0; first < found.size(); first = next) {
        std::vector<std::string> shares;
        while (next < found.size() && found[next].run == found[first].run)
            shares.push_back(fmt::format("{:g}", 100.0 * found[next++].share));
        std::string listed = shares.front();
        for (std::size_t i = 1; i < shares.size(); ++i)
            listed.append(i + 1 < shares.size() ? ", " : " and ").append(shares[i]);
        parts.push_back(fmt::format(
            "{} %: {}", listed,
            found[first].run ? tell_run(study, outcomes[*found[first].run]) : "no run of the study"));
    }
    return parts;
}

std::string tell_reference(const Study& study, const std::vector<RunOutcome>& outcomes)
{
    const ErrorRule& rule = *study.error;
    std::vector<std::string> references;
    for (const RunOutcome& outcome : outcomes)
        if (outcome.is_reference) references.push_back(list_settings(outcome.run.settings));
    const std::string runs =
        references.empty() ? "no run: it has not finished" : fmt::format("{}", fmt::join(references, "; "));
    switch (rule.reference) {
        case ErrorRule::Reference::None:
            return "";
        case ErrorRule::Reference::Formula:
            return "against " + rule.formula;
        case ErrorRule::Reference::File:
            return "against the file " + rule.formula;
        case ErrorRule::Reference::Finest:
            return "against the finest finished run of the same problem (most cells, then the least step, "
                   "then "
                   "the first): " +
                   runs;
        case ErrorRule::Reference::Run:
            return "against a further run: " + runs;
    }
    return "";
}

std::string tell_quantity(const ErrorRule& rule)
{
    using Norm = ErrorRule::Norm;
    if (rule.quantity == ErrorRule::Quantity::Shape)
        return fmt::format("{} distance (m) at equal material points in {}",
                           rule.norm == Norm::Max ? "greatest" : "mean",
                           rule.is_over_all_frames ? "all frames" : "the last frame");
    const std::string quantity =
        rule.quantity == ErrorRule::Quantity::Column
            ? rule.column
            : fmt::format("the displacement (m) of probe {} along {}", rule.probe, "xyz"[rule.axis]);
    if (rule.reference == ErrorRule::Reference::None)
        return (rule.norm == Norm::Max   ? "greatest size over time of "
                : rule.norm == Norm::Rms ? "root mean square over time of "
                                         : "size at the end of ") +
               quantity;
    return (rule.norm == Norm::Max   ? "greatest error over time of "
            : rule.norm == Norm::Rms ? "root-mean-square error over time of "
                                     : "error at the end of ") +
           quantity;
}

}  // namespace

double abscissa(const RunOutcome& outcome, const std::string& key, bool has_error)
{
    return !has_error && is_mesh_size(key) ? outcome.vertices : number_of(outcome, key);
}

double cpu_seconds_a_step(const RunOutcome& outcome)
{
    return outcome.steps > 0 ? *outcome.cpu_median() / static_cast<double>(outcome.steps) : 0.0;
}

std::vector<NumericKey> list_numeric_keys(const Study& study)
{
    std::vector<NumericKey> keys;
    for (const std::string& key : study.axis_keys)
        keys.push_back({key, axis_label(key, study.error.has_value())});
    return keys;
}

std::string name_method(const Study& study, const StudyRun& run)
{
    return name_settings(study, run, [&](const std::string& key) { return !is_axis(study, key); });
}

std::vector<StudyCurve> make_curves(const Study& study, const std::vector<RunOutcome>& outcomes,
                                    const std::string& key)
{
    std::vector<StudyCurve> curves;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        const StudyRun& run = outcomes[i].run;
        if (run.is_further) continue;
        const std::string name =
            name_settings(study, run, [&](const std::string& other) { return other != key; });
        auto curve =
            std::find_if(curves.begin(), curves.end(), [&](const auto& c) { return c.name == name; });
        if (curve == curves.end()) curve = curves.insert(curve, {name_method(study, run), name, {}, {}});
        curve->runs.push_back(i);
    }
    for (StudyCurve& curve : curves) {
        std::stable_sort(curve.runs.begin(), curve.runs.end(), [&](std::size_t a, std::size_t b) {
            return number_of(outcomes[a], key) < number_of(outcomes[b], key);
        });
        if (!study.error || study.error->reference != ErrorRule::Reference::None)
            curve.slope = slope_of(outcomes, curve, key, study.error.has_value());
    }
    return curves;
}

std::optional<double> fit_slope(const std::vector<double>& x, const std::vector<double>& y)
{
    std::vector<double> u, v;
    for (std::size_t i = 0; i < x.size(); ++i)
        if (x[i] > 0.0 && y[i] > 0.0) {
            u.push_back(std::log(x[i]));
            v.push_back(std::log(y[i]));
        }
    if (u.empty()) return std::nullopt;
    const double count = static_cast<double>(u.size());
    const double mean_u = std::accumulate(u.begin(), u.end(), 0.0) / count;
    const double mean_v = std::accumulate(v.begin(), v.end(), 0.0) / count;
    double squares = 0.0, products = 0.0;
    for (std::size_t i = 0; i < u.size(); ++i) {
        squares += (u[i] - mean_u) * (u[i] - mean_u);
        products += (u[i] - mean_u) * (v[i] - mean_v);
    }
    constexpr double kLeastSpread = 1e-12;  // of squared logarithms: below it all x are the same
    if (!(squares > kLeastSpread)) return std::nullopt;
    return products / squares;
}

bool is_compared(const RunOutcome& outcome)
{
    return outcome.is_finished() && outcome.error && !outcome.is_reference && !outcome.cpu_seconds.empty();
}

std::vector<std::size_t> find_pareto_front(const std::vector<RunOutcome>& outcomes)
{
    std::vector<std::size_t> front;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        if (!has_reference(outcomes[i])) continue;
        const bool is_beaten = std::any_of(outcomes.begin(), outcomes.end(), [&](const RunOutcome& other) {
            return has_reference(other) && dominates(other, outcomes[i]);
        });
        if (!is_beaten) front.push_back(i);
    }
    std::sort(front.begin(), front.end(), [&](std::size_t a, std::size_t b) {
        return *outcomes[a].cpu_median() < *outcomes[b].cpu_median();
    });
    return front;
}

std::vector<std::string> list_problems(const std::vector<RunOutcome>& outcomes)
{
    std::vector<std::string> problems;
    for (const RunOutcome& outcome : outcomes)
        if (std::find(problems.begin(), problems.end(), outcome.run.problem) == problems.end())
            problems.push_back(outcome.run.problem);
    return problems;
}

std::vector<CheapestRun> find_cheapest(const std::vector<RunOutcome>& outcomes, const std::string& problem)
{
    const auto has_share = [&](const RunOutcome& outcome) {
        return is_compared(outcome) && outcome.run.problem == problem && outcome.error->relative();
    };
    if (std::none_of(outcomes.begin(), outcomes.end(), has_share)) return {};
    std::vector<CheapestRun> found = {{0.1, {}}, {0.01, {}}, {0.001, {}}};
    for (CheapestRun& cheapest : found)
        for (std::size_t i = 0; i < outcomes.size(); ++i) {
            if (!has_share(outcomes[i]) || *outcomes[i].error->relative() > cheapest.share) continue;
            if (!cheapest.run || *outcomes[i].cpu_median() < *outcomes[*cheapest.run].cpu_median())
                cheapest.run = i;
        }
    return found;
}

std::string tell_cheapest(const Study& study, const std::vector<RunOutcome>& outcomes)
{
    if (!study.error) return "The study measures times alone: it names no error.";
    const std::vector<std::string> problems = list_problems(outcomes);
    std::vector<std::string> parts;
    for (const std::string& problem : problems)
        for (const std::string& part : tell_thresholds(study, outcomes, find_cheapest(outcomes, problem)))
            parts.push_back(problems.size() > 1 ? fmt::format("with {} {}", problem, part) : part);
    if (parts.empty())
        return study.error->reference == ErrorRule::Reference::None
                   ? "The error has no reference, so no share of it can be given: see the table."
                   : "No run could be compared with the reference.";
    const auto compared = std::find_if(outcomes.begin(), outcomes.end(), is_compared);
    const ErrorScale kind = compared == outcomes.end() ? ErrorScale::Range : compared->error->scale_kind;
    return fmt::format("The cheapest setting with an error of at most {}. Per cent are of {}.",
                       fmt::join(parts, "; "), describe_scale(kind));
}

std::string tell_error(const Study& study, const std::vector<RunOutcome>& outcomes)
{
    if (!study.error) return "";
    if (study.error->reference == ErrorRule::Reference::None)
        return fmt::format("Value in the column error: {}; there is no reference.",
                           tell_quantity(*study.error));
    return fmt::format("Error: {}, {}.", tell_quantity(*study.error), tell_reference(study, outcomes));
}

}  // namespace arris
