// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/study/run_outcome.h"

namespace arris {

/// An axis key of a study.
struct NumericKey {
    std::string key;
    std::string label;  ///< for an axis
};

/// Runs that differ in one numeric key alone, by ascending number.
struct StudyCurve {
    std::string method;             ///< the settings that are no numbers; empty if there are none
    std::string name;               ///< method and the other numbers
    std::vector<std::size_t> runs;  ///< indices of outcomes, finished or not
    std::optional<double>
        slope;  ///< of log error by log abscissa; of log CPU time a step in a study without error
};

/// The cheapest finished run with at most this error.
struct CheapestRun {
    double share = 0.0;  ///< of the reference's scale
    std::optional<std::size_t> run;
};

/// Where a run stands on a numeric key's axis: at its number; in a study without error, which measures cost,
/// cloth.resolution and cloth.edge_length stand for the cloth's vertices.
double abscissa(const RunOutcome& outcome, const std::string& key, bool has_error);

/// 0 without a step.
double cpu_seconds_a_step(const RunOutcome& outcome);

/// The axis keys of a study: cloth.resolution first, then time.step, then the others in order.
std::vector<NumericKey> list_numeric_keys(const Study& study);

/// Telling settings of a run that are no axes, as words.
std::string name_method(const Study& study, const StudyRun& run);

/// Curves over a numeric key, without further runs.
std::vector<StudyCurve> make_curves(const Study& study, const std::vector<RunOutcome>& outcomes,
                                    const std::string& key);

/// Least-squares slope of log y by log x. Nothing without two positive points of different x.
std::optional<double> fit_slope(const std::vector<double>& x, const std::vector<double>& y);

/// Whether an error can stand in a comparison: of a finished run that is not its own reference.
bool is_compared(const RunOutcome& outcome);

/// Compared runs than which no other of the same problem is both at most as costly (CPU time) and at most as
/// wrong, and better in one; by ascending cost.
std::vector<std::size_t> find_pareto_front(const std::vector<RunOutcome>& outcomes);

/// The different problems of a study's runs (StudyRun::problem), in order.
std::vector<std::string> list_problems(const std::vector<RunOutcome>& outcomes);

/// For 10, 1 and 0.1 per cent, among the runs of one problem. Empty if errors have no scale.
std::vector<CheapestRun> find_cheapest(const std::vector<RunOutcome>& outcomes, const std::string& problem);

/// The study's result in one sentence.
std::string tell_cheapest(const Study& study, const std::vector<RunOutcome>& outcomes);

/// A sentence that names the measured error and its reference.
std::string tell_error(const Study& study, const std::vector<RunOutcome>& outcomes);

}  // namespace arris
