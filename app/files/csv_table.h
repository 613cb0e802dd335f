// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/vectors.h"
#include "solver/model/step_report.h"

namespace arris {

/// One row of steps.csv. An absent value (std::nullopt) becomes an empty cell.
struct StepRow {
    std::int64_t step = 0;  ///< 0 is the initial state
    double time = 0.0;      ///< s, at the step's end
    double dt = 0.0;        ///< s
    std::int64_t vertices = 0, faces = 0;
    std::optional<std::int64_t> eol_vertices, feature_rows;
    std::int64_t contacts = 0;    ///< constraints with a positive multiplier
    double kinetic_energy = 0.0;  ///< J, as the other energies
    std::optional<double> gravity_energy, stretch_energy, bending_energy;
    double material_area = 0.0;    ///< m^2
    double max_penetration = 0.0;  ///< m
    std::int64_t crossings = 0;    ///< since the start
    double min_angle = 0.0;        ///< degrees, material space
    double kkt_residual = 0.0;
    std::int64_t factorisations = 0, nlopt_evaluations = 0;
    PhaseSeconds seconds;                 ///< wall time
    double cpu_seconds = 0.0;             ///< CPU time of the process in this step, output included
    bool is_halved = false;               ///< shorter than planned
    std::int64_t solves = 0;              ///< velocity solves: more than one where the check found violations
    std::optional<std::int64_t> rewound;  ///< vertices rewound so that no obstacle is crossed
    std::optional<std::int64_t> yielded;  ///< contacts that could not keep their stand-off
    std::optional<double> energy_rise;    ///< J, energy rise of a step that no retry could remove; else 0
    std::optional<std::int64_t> eol_pressing;
    std::optional<std::int64_t> friction_sweeps;  ///< moves of its budgets
    std::optional<double> friction_residual;      ///< by how much it does not, relative to the largest budget
    std::optional<double> friction_work;          ///< J, lost to friction in this step
    std::optional<std::int64_t> sticking, sliding;  ///< contacts with friction
    std::optional<std::int64_t> self_contacts;      ///< of the cloth with itself, with a positive multiplier
    std::optional<std::int64_t> remeshed;           ///< splits, merges and flips of remeshing
    std::optional<double> remesh_energy;            ///< J, added by all changes of the mesh in this step
    std::optional<double> sewing_energy;     ///< J, of the springs of seams, and what welding has taken out
    std::optional<std::int64_t> open_pairs;  ///< of vertices that a seam is to join
    double max_strain = 0.0;                 ///< size of the greatest principal strain around any vertex
    std::optional<ConstraintCounts> rows_by_cause;  ///< `feature_rows` by cause, columns rows_<cause>

    /// Whether the cloth touches an obstacle.
    bool is_touching() const
    {
        return contacts > 0 || eol_vertices.value_or(0) > 0 || feature_rows.value_or(0) > 0;
    }
};

/// World position (m) and velocity (m/s) of a material point at one time.
struct ProbeSample {
    Vec3 position = Vec3::Zero();
    Vec3 velocity = Vec3::Zero();
};

/// Name of the column of feature rows with this cause: rows_<cause>.
std::string rows_column(ConstraintCause cause);

/// Header and rows, without a line end. Numbers read back to the same double.
std::string step_header();
std::string format_row(const StepRow& row);
std::string probe_header(const std::vector<std::string>& probe_names);
std::string format_row(double time, const std::vector<ProbeSample>& probes);

/// Appends lines to a CSV file, each in one write(), so that a killed process leaves at most one incomplete
/// line, the last. Throws std::system_error naming the path if writing fails.
class CsvWriter {
  public:
    /// Creates a file with this header, replacing any previous one.
    static CsvWriter create(const std::string& path, const std::string& header);

    /// Continues a file that truncate_csv has cut. Throws InputError unless it has this header and ends with
    /// a complete line.
    static CsvWriter append_to(const std::string& path, const std::string& header);

    CsvWriter(CsvWriter&& other) noexcept;
    CsvWriter& operator=(CsvWriter&&) = delete;
    ~CsvWriter();

    void append(const std::string& row);

  private:
    CsvWriter(const std::string& path, int open_flags);

    std::string path_;
    int descriptor_ = -1;
};

/// Truncates a file to its header and the first `rows` rows. Throws InputError if there are fewer complete
/// rows.
void truncate_csv(const std::string& path, std::int64_t rows);

/// Reads a table of numbers row by row, in constant memory. An incomplete last line is ignored.
class CsvReader {
  public:
    /// Throws InputError if the file cannot be opened or has no header.
    explicit CsvReader(const std::string& path);

    const std::vector<std::string>& names() const { return names_; }

    /// Index of the column with this name. Throws InputError naming the file if there is none.
    std::size_t column(std::string_view name) const;
    bool has_column(std::string_view name) const;

    /// Reads the next row, with NaN for an empty cell; false at the end. Throws InputError naming the line if
    /// a cell is not a number or the row's length differs from the header's.
    bool next(std::vector<double>& cells);

  private:
    double parse(std::string_view cell) const;

    std::string path_;
    std::ifstream in_;
    std::vector<std::string> names_;
    std::int64_t line_ = 1;
};

/// A whole table in memory.
struct CsvTable {
    std::string path;
    std::vector<std::string> names;
    std::vector<std::vector<double>> columns;  ///< NaN for an empty cell

    std::size_t row_count() const { return columns.empty() ? 0 : columns.front().size(); }

    /// Throws InputError naming the file if it has no such column.
    const std::vector<double>& column(std::string_view name) const;
};

CsvTable read_csv(const std::string& path);

}  // namespace arris
