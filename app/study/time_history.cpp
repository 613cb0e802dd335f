// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/time_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "app/files/csv_table.h"
#include "app/text/printable.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

constexpr double kSameTime = 1e-9;  // of the history's length

TimeHistory make_history(const CsvTable& table, const std::string& name, bool is_from_zero)
{
    const std::vector<double>&times = table.column("time"), &values = table.column(name);
    TimeHistory history;
    for (std::size_t i = 0; i < times.size(); ++i) {
        if (std::isnan(values[i])) continue;
        if (!std::isfinite(times[i]) || !std::isfinite(values[i]))
            throw InputError(fmt::format("{}: row {} is not finite; allowed: finite numbers",
                                         printable(table.path), i + 1));
        if (!history.times.empty() && !(times[i] > history.times.back()))
            throw InputError(
                fmt::format("{}: row {} is not later than the row before; allowed: ascending times",
                            printable(table.path), i + 1));
        history.times.push_back(times[i]);
        history.values.push_back(values[i]);
    }
    if (history.times.empty())
        throw InputError(fmt::format("{}: column {} has no value", printable(table.path), printable(name)));
    if (is_from_zero) {
        const double start = history.values.front();
        for (double& value : history.values) value -= start;
    }
    return history;
}

std::string quantity_column(const ErrorRule& rule)
{
    constexpr const char* kAxes[] = {"_x", "_y", "_z"};
    return rule.quantity == ErrorRule::Quantity::Probe ? rule.probe + kAxes[rule.axis] : rule.column;
}

bool is_probe(const ErrorRule& rule)
{
    return rule.quantity == ErrorRule::Quantity::Probe;
}

/// Lagrange's polynomial through the samples [first, last) at `time`.
double lagrange(const TimeHistory& history, std::size_t first, std::size_t last, double time)
{
    double sum = 0.0;
    for (std::size_t i = first; i < last; ++i) {
        double weight = 1.0;
        for (std::size_t k = first; k < last; ++k)
            if (k != i) weight *= (time - history.times[k]) / (history.times[i] - history.times[k]);
        sum += weight * history.values[i];
    }
    return sum;
}

}  // namespace

TimeHistory read_history(const std::string& run_directory, const ErrorRule& rule)
{
    const CsvTable table = read_csv(run_directory + (is_probe(rule) ? "/probes.csv" : "/steps.csv"));
    return make_history(table, quantity_column(rule), is_probe(rule));
}

TimeHistory read_reference_file(const std::string& path, const ErrorRule& rule)
{
    const CsvTable table = read_csv(path);
    const auto has = [&](const std::string& name) {
        return std::find(table.names.begin(), table.names.end(), name) != table.names.end();
    };
    const std::string column = quantity_column(rule);
    if (!has("time") || (!has("value") && !has(column)))
        throw InputError(fmt::format("{}: has not the columns time and value; allowed: these, or {} of a run",
                                     printable(path), column));
    return has("value") ? make_history(table, "value", false) : make_history(table, column, is_probe(rule));
}

std::vector<double> interpolate(const TimeHistory& history, const std::vector<double>& times,
                                Interpolation interpolation, const std::string& source)
{
    const std::size_t count = history.times.size();
    const double same = kSameTime * std::max(1.0, std::abs(history.times.back()));
    const std::size_t samples = std::min<std::size_t>(interpolation == Interpolation::Cubic ? 4 : 2, count);
    std::vector<double> values;
    for (const double time : times) {
        if (time < history.times.front() - same || time > history.times.back() + same)
            throw InputError(fmt::format("{}: has no value at {} s; it covers {} to {} s", printable(source),
                                         time, history.times.front(), history.times.back()));
        const auto after = std::lower_bound(history.times.begin(), history.times.end(), time - same);
        const auto index =
            std::min(static_cast<std::size_t>(std::distance(history.times.begin(), after)), count - 1);
        if (std::abs(history.times[index] - time) <= same) {
            values.push_back(history.values[index]);
            continue;
        }
        const std::size_t half = samples / 2,
                          first = std::min(index < half ? 0 : index - half, count - samples);
        values.push_back(lagrange(history, first, first + samples, time));
    }
    return values;
}

}  // namespace arris
