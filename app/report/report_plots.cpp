// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/report/report_plots.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "app/files/csv_table.h"
#include "app/report/peak_sampler.h"

namespace arris {
namespace {

/// When a plot is shown.
enum class Shown { Always, IfChanging, IfPositive };

/// A line of a plot: the sum of its columns, empty cells omitted.
struct Series {
    const char* name;
    std::vector<const char*> columns;
    bool is_dashed = false;
};

struct PlotSpec {
    const char* title;
    const char* unit;
    PlotKind kind;
    Shown shown;
    double scale;  ///< factor from the column's unit to the plot's
    const char* note;
    std::vector<Series> series;
};

const std::vector<PlotSpec>& step_plots()
{
    constexpr auto kLines = PlotKind::Lines;
    static const std::vector<PlotSpec> kSpecs = {
        {"Energy",
         "J",
         kLines,
         Shown::Always,
         1.0,
         "Energies of the whole cloth. The total rises only where wind, pulls, pins or obstacles do work on "
         "the cloth.",
         {{"kinetic", {"kinetic_energy"}},
          {"gravity", {"gravity_energy"}},
          {"stretch", {"stretch_energy"}},
          {"bending", {"bending_energy"}},
          {"total", {"kinetic_energy", "gravity_energy", "stretch_energy", "bending_energy"}, true}}},
        {"Kinetic and elastic energy",
         "J",
         kLines,
         Shown::Always,
         1.0,
         "Energies without gravity, which is usually far larger.",
         {{"kinetic", {"kinetic_energy"}}, {"stretch", {"stretch_energy"}}, {"bending", {"bending_energy"}}}},
        {"Wall time of a step by phase",
         "ms",
         PlotKind::Stacked,
         Shown::Always,
         1e3,
         "Phases are explained under \"Wall time by phase\".",
         {{"move", {"move_s"}},
          {"contacts", {"contacts_s"}},
          {"conform", {"conform_s"}},
          {"transfer", {"transfer_s"}},
          {"assemble", {"assemble_s"}},
          {"factorise", {"factorise_s"}},
          {"solve", {"solve_s"}},
          {"check", {"check_s"}},
          {"advance", {"advance_s"}},
          {"output", {"output_s"}}}},
        {"Contacts",
         "",
         kLines,
         Shown::IfPositive,
         1.0,
         "Constraints that press; EOL vertices, which lie on sharp features of obstacles; pressing contacts "
         "on features that are rows of the velocity solve; and pressing contacts of the cloth with itself.",
         {{"pressing constraints", {"contacts"}},
          {"EOL vertices", {"eol_vertices"}},
          {"feature rows", {"feature_rows"}},
          {"between layers", {"self_contacts"}}}},
        {"KKT residual of the velocity solve",
         "relative",
         PlotKind::LogLines,
         Shown::Always,
         1.0,
         "Relative error in balance of forces and contact conditions; 1e-15 is rounding. A step above the "
         "tolerance is not accepted.",
         {{"residual", {"kkt_residual"}}}},
        {"Length of a step",
         "ms",
         kLines,
         Shown::Always,
         1e3,
         "A halved step is shorter than planned: the whole step was not accepted, or too much material would "
         "have flowed in it.",
         {{"dt", {"dt"}}}},
        {"Factorisations of the velocity solve",
         "per step",
         kLines,
         Shown::Always,
         1.0,
         "Factorisations of the matrix, the largest cost of a step; one or two where little changes.",
         {{"factorisations", {"factorisations"}}}},
        {"NLopt evaluations of the velocity solve",
         "per step",
         kLines,
         Shown::IfPositive,
         1.0,
         "Evaluations in the search for the active contacts; each is cheap.",
         {{"NLopt evaluations", {"nlopt_evaluations"}}}},
        {"Mesh",
         "",
         kLines,
         Shown::IfChanging,
         1.0,
         "Vertices are added and removed where the cloth slides over sharp features.",
         {{"vertices", {"vertices"}}, {"faces", {"faces"}}}},
        {"Least angle of the mesh",
         "degrees",
         kLines,
         Shown::IfChanging,
         1.0,
         "Least angle of a face in the material. Thin faces come and go beside features that cloth slides "
         "over. If the initial mesh has less than 5 degrees, use more even cells or faces.",
         {{"least angle", {"min_angle"}}}},
        {"Penetration",
         "m",
         kLines,
         Shown::IfPositive,
         1.0,
         "Depth of the cloth in an obstacle; a value above 0 ends the run.",
         {{"greatest depth", {"max_penetration"}}}},
        {"Crossings so far",
         "",
         kLines,
         Shown::IfPositive,
         1.0,
         "Number of times the cloth has passed through an obstacle or itself; a value above 0 is an error of "
         "the program.",
         {{"crossings", {"crossings"}}}},
    };
    return kSpecs;
}

/// Builds a plot from rows. Lines are thinned one by one; stacked areas are thinned together, so that they
/// still add up.
class PlotBuilder {
  public:
    PlotBuilder(const PlotSpec& spec, const CsvReader& reader) : spec_(spec)
    {
        for (const Series& series : spec.series) {
            auto& columns = columns_.emplace_back();
            for (const char* name : series.columns) columns.push_back(reader.column(name));
        }
        samplers_.resize(spec.kind == PlotKind::Stacked ? 1 : spec.series.size());
    }

    void add(double time, const std::vector<double>& row)
    {
        std::vector<double> values;
        std::transform(columns_.begin(), columns_.end(), std::back_inserter(values),
                       [&](const auto& columns) { return spec_.scale * sum(columns, row); });
        if (spec_.kind == PlotKind::Stacked) return samplers_[0].add({time, values});
        for (std::size_t i = 0; i < values.size(); ++i) {
            const bool has_no_logarithm = spec_.kind == PlotKind::LogLines && !(values[i] > 0.0);
            if (!has_no_logarithm) samplers_[i].add({time, {values[i]}});
        }
    }

    Plot finish() const
    {
        Plot plot{spec_.title, spec_.unit, spec_.kind, {}, spec_.note};
        for (std::size_t i = 0; i < spec_.series.size(); ++i) {
            PlotLine line{spec_.series[i].name, {}, spec_.series[i].is_dashed};
            const bool is_stacked = spec_.kind == PlotKind::Stacked;
            for (const Sample& sample : samplers_[is_stacked ? 0 : i].samples())
                line.points.push_back({sample.x, sample.values[is_stacked ? i : 0]});
            if (!line.points.empty()) plot.lines.push_back(line);
        }
        return plot;
    }

    bool is_shown(const Plot& plot) const
    {
        if (spec_.shown == Shown::Always) return true;
        return std::any_of(plot.lines.begin(), plot.lines.end(), [this](const PlotLine& line) {
            const double first = spec_.shown == Shown::IfPositive ? 0.0 : line.points.front()[1];
            return std::any_of(line.points.begin(), line.points.end(),
                               [first](const auto& point) { return std::abs(point[1] - first) > 0.0; });
        });
    }

  private:
    static double sum(const std::vector<std::size_t>& columns, const std::vector<double>& row)
    {
        double total = std::nan("");
        for (const std::size_t column : columns)
            if (!std::isnan(row[column])) total = std::isnan(total) ? row[column] : total + row[column];
        return total;
    }

    const PlotSpec& spec_;
    std::vector<std::vector<std::size_t>> columns_;
    std::vector<PeakSampler> samplers_;
};

// Row 0 is the initial state: it has energies and counts, but no values of a step.
bool concerns_steps_only(const PlotSpec& spec)
{
    return std::string_view(spec.unit) == "ms" || spec.kind == PlotKind::LogLines ||
           std::string_view(spec.unit) == "per step";
}

void add_tolerance(double tolerance, Plot& plot)
{
    if (plot.lines.empty() || !(tolerance > 0.0)) return;
    const auto& points = plot.lines.front().points;
    const double begin = points.front()[0], end = points.back()[0];
    plot.lines.push_back({"tolerance", {{begin, tolerance}, {end, tolerance}}, /*is_dashed=*/true});
}

// Without gravity the second energy plot repeats the first one.
bool repeats_energy_plot(const Plot& plot, const std::vector<Plot>& plots)
{
    return plot.title == "Kinetic and elastic energy" &&
           std::none_of(plots.front().lines.begin(), plots.front().lines.end(),
                        [](const PlotLine& line) { return line.name == "gravity"; });
}

constexpr const char* kDirections[] = {"x", "y", "z"};

// Names of the probes, from the first column of each.
std::vector<std::string> probe_names(const CsvReader& reader)
{
    std::vector<std::string> names;
    constexpr std::size_t kColumnsAProbe = 6;
    for (std::size_t i = 1; i + kColumnsAProbe <= reader.names().size(); i += kColumnsAProbe) {
        const std::string& name = reader.names()[i];
        names.push_back(name.substr(0, name.rfind("_x")));
    }
    return names;
}

Plot make_probe_plot(const std::string& name, const PeakSampler* samplers)
{
    Plot plot{"Probe " + name, "m", PlotKind::Lines, {}, "World position of this material point."};
    for (std::size_t k = 0; k < 3; ++k) {
        PlotLine line{kDirections[k], {}};
        for (const Sample& sample : samplers[k].samples())
            line.points.push_back({sample.x, sample.values[0]});
        plot.lines.push_back(line);
    }
    return plot;
}

}  // namespace

std::vector<Plot> plot_steps(const std::string& steps_csv, std::optional<double> tolerance)
{
    CsvReader reader(steps_csv);
    const std::size_t step = reader.column("step"), time = reader.column("time");
    std::vector<PlotBuilder> builders;
    for (const PlotSpec& spec : step_plots()) builders.emplace_back(spec, reader);

    std::vector<double> row;
    while (reader.next(row))
        for (std::size_t i = 0; i < builders.size(); ++i)
            if (row[step] > 0.5 || !concerns_steps_only(step_plots()[i])) builders[i].add(row[time], row);

    std::vector<Plot> plots;
    for (const PlotBuilder& builder : builders) {
        Plot plot = builder.finish();
        if (!builder.is_shown(plot) || repeats_energy_plot(plot, plots)) continue;
        if (plot.kind == PlotKind::LogLines && tolerance) add_tolerance(*tolerance, plot);
        plots.push_back(std::move(plot));
    }
    return plots;
}

ProbePlots plot_probes(const std::string& probes_csv, std::size_t max_probes)
{
    CsvReader reader(probes_csv);
    const std::vector<std::string> names = probe_names(reader);
    const std::size_t shown = std::min(names.size(), max_probes);
    std::vector<PeakSampler> samplers(3 * shown);

    std::vector<double> row;
    while (reader.next(row))
        for (std::size_t i = 0; i < samplers.size(); ++i)
            samplers[i].add({row[0], {row[1 + 6 * (i / 3) + i % 3]}});

    ProbePlots result;
    for (std::size_t i = 0; i < shown; ++i)
        result.plots.push_back(make_probe_plot(names[i], &samplers[3 * i]));
    result.left_out = names.size() - shown;
    return result;
}

}  // namespace arris
