// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/files/csv_table.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <iterator>
#include <limits>
#include <system_error>
#include <utility>

#include "app/files/atomic_file.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

// fmt writes the shortest digits that read back to the same double, in any locale.
std::string cell(double value)
{
    return fmt::format("{}", value);
}
std::string cell(std::int64_t value)
{
    return fmt::format("{}", value);
}
std::string cell(bool value)
{
    return value ? "1" : "0";
}

template <class T>
std::string cell(const std::optional<T>& value)
{
    return value ? cell(*value) : std::string();
}

struct StepColumn {
    const char* name;
    std::string (*cell)(const StepRow&);
};

// The format fixes order and names; append new columns at the end.
const StepColumn kStepColumns[] = {
    {"step", [](const StepRow& row) { return cell(row.step); }},
    {"time", [](const StepRow& row) { return cell(row.time); }},
    {"dt", [](const StepRow& row) { return cell(row.dt); }},
    {"vertices", [](const StepRow& row) { return cell(row.vertices); }},
    {"faces", [](const StepRow& row) { return cell(row.faces); }},
    {"eol_vertices", [](const StepRow& row) { return cell(row.eol_vertices); }},
    {"feature_rows", [](const StepRow& row) { return cell(row.feature_rows); }},
    {"contacts", [](const StepRow& row) { return cell(row.contacts); }},
    {"kinetic_energy", [](const StepRow& row) { return cell(row.kinetic_energy); }},
    {"gravity_energy", [](const StepRow& row) { return cell(row.gravity_energy); }},
    {"stretch_energy", [](const StepRow& row) { return cell(row.stretch_energy); }},
    {"bending_energy", [](const StepRow& row) { return cell(row.bending_energy); }},
    {"material_area", [](const StepRow& row) { return cell(row.material_area); }},
    {"max_penetration", [](const StepRow& row) { return cell(row.max_penetration); }},
    {"crossings", [](const StepRow& row) { return cell(row.crossings); }},
    {"min_angle", [](const StepRow& row) { return cell(row.min_angle); }},
    {"kkt_residual", [](const StepRow& row) { return cell(row.kkt_residual); }},
    {"factorisations", [](const StepRow& row) { return cell(row.factorisations); }},
    {"nlopt_evaluations", [](const StepRow& row) { return cell(row.nlopt_evaluations); }},
    {"move_s", [](const StepRow& row) { return cell(row.seconds.move); }},
    {"contacts_s", [](const StepRow& row) { return cell(row.seconds.contacts); }},
    {"conform_s", [](const StepRow& row) { return cell(row.seconds.conform); }},
    {"transfer_s", [](const StepRow& row) { return cell(row.seconds.transfer); }},
    {"assemble_s", [](const StepRow& row) { return cell(row.seconds.assemble); }},
    {"factorise_s", [](const StepRow& row) { return cell(row.seconds.factorise); }},
    {"solve_s", [](const StepRow& row) { return cell(row.seconds.solve); }},
    {"check_s", [](const StepRow& row) { return cell(row.seconds.check); }},
    {"advance_s", [](const StepRow& row) { return cell(row.seconds.advance); }},
    {"output_s", [](const StepRow& row) { return cell(row.seconds.output); }},
    {"cpu_s", [](const StepRow& row) { return cell(row.cpu_seconds); }},
    {"halved", [](const StepRow& row) { return cell(row.is_halved); }},
    {"solves", [](const StepRow& row) { return cell(row.solves); }},
    {"rewound", [](const StepRow& row) { return cell(row.rewound); }},
    {"yielded", [](const StepRow& row) { return cell(row.yielded); }},
    {"energy_rise", [](const StepRow& row) { return cell(row.energy_rise); }},
    {"eol_pressing", [](const StepRow& row) { return cell(row.eol_pressing); }},
    {"max_strain", [](const StepRow& row) { return cell(row.max_strain); }},
    {"friction_sweeps", [](const StepRow& row) { return cell(row.friction_sweeps); }},
    {"friction_residual", [](const StepRow& row) { return cell(row.friction_residual); }},
    {"friction_work", [](const StepRow& row) { return cell(row.friction_work); }},
    {"sticking", [](const StepRow& row) { return cell(row.sticking); }},
    {"sliding", [](const StepRow& row) { return cell(row.sliding); }},
    {"self_contacts", [](const StepRow& row) { return cell(row.self_contacts); }},
    {"remeshed", [](const StepRow& row) { return cell(row.remeshed); }},
    {"remesh_energy", [](const StepRow& row) { return cell(row.remesh_energy); }},
    {"sewing_energy", [](const StepRow& row) { return cell(row.sewing_energy); }},
    {"open_pairs", [](const StepRow& row) { return cell(row.open_pairs); }},
};  // followed by rows_<cause> for each cause

std::string join(const std::vector<std::string>& cells)
{
    return fmt::format("{}", fmt::join(cells, ","));
}

std::vector<std::string_view> split(std::string_view line)
{
    std::vector<std::string_view> cells;
    for (;;) {
        const std::size_t comma = line.find(',');
        cells.push_back(line.substr(0, comma));
        if (comma == std::string_view::npos) return cells;
        line.remove_prefix(comma + 1);
    }
}

// A line is complete only with its line feed; getline alone would also return an incomplete last line.
bool read_whole_line(std::istream& in, std::string& line)
{
    return std::getline(in, line) && !in.eof();
}

std::size_t find_name(const std::vector<std::string>& names, std::string_view name)
{
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

[[noreturn]] void fail_missing(const std::string& path, std::string_view name)
{
    throw InputError(fmt::format("{}: has no column \"{}\"", path, name));
}

void require_same_header(const std::string& path, const std::string& header)
{
    std::ifstream in(path, std::ios::binary);
    std::string line;
    if (!in) throw InputError(path + ": cannot be opened");
    if (!read_whole_line(in, line) || line != header)
        throw InputError(path + ": its columns differ from the columns of this scene");
    in.seekg(-1, std::ios::end);
    if (in.get() != '\n') throw InputError(path + ": its last line is incomplete");
}

}  // namespace

std::string rows_column(ConstraintCause cause)
{
    return std::string("rows_") + to_string(cause);
}

std::string step_header()
{
    std::vector<std::string> cells;
    for (const StepColumn& column : kStepColumns) cells.push_back(column.name);
    for (std::size_t k = 0; k < kConstraintCauses; ++k)
        cells.push_back(rows_column(static_cast<ConstraintCause>(k)));
    return join(cells);
}

std::string format_row(const StepRow& row)
{
    std::vector<std::string> cells;
    for (const StepColumn& column : kStepColumns) cells.push_back(column.cell(row));
    for (std::size_t k = 0; k < kConstraintCauses; ++k)
        cells.push_back(row.rows_by_cause ? fmt::format("{}", (*row.rows_by_cause)[k]) : std::string());
    return join(cells);
}

std::string probe_header(const std::vector<std::string>& probe_names)
{
    std::vector<std::string> cells = {"time"};
    for (const std::string& name : probe_names)
        for (const char* part : {"_x", "_y", "_z", "_vx", "_vy", "_vz"}) cells.push_back(name + part);
    return join(cells);
}

std::string format_row(double time, const std::vector<ProbeSample>& probes)
{
    std::vector<std::string> cells = {cell(time)};
    for (const ProbeSample& probe : probes)
        for (const Vec3* vector : {&probe.position, &probe.velocity})
            for (int i = 0; i < 3; ++i) cells.push_back(cell((*vector)[i]));
    return join(cells);
}

CsvWriter::CsvWriter(const std::string& path, int open_flags)
    : path_(path), descriptor_(open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | open_flags, 0666))
{
    if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "cannot create " + path);
}

CsvWriter::CsvWriter(CsvWriter&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1))
{
}

CsvWriter::~CsvWriter()
{
    if (descriptor_ >= 0) close(descriptor_);
}

CsvWriter CsvWriter::create(const std::string& path, const std::string& header)
{
    CsvWriter writer(path, O_CREAT | O_TRUNC);
    writer.append(header);
    return writer;
}

CsvWriter CsvWriter::append_to(const std::string& path, const std::string& header)
{
    require_same_header(path, header);
    return CsvWriter(path, 0);
}

void CsvWriter::append(const std::string& row)
{
    assert(row.find('\n') == std::string::npos && "a row is one line");
    write_fully(descriptor_, row + "\n", path_);
}

void truncate_csv(const std::string& path, std::int64_t rows)
{
    std::ifstream in(path, std::ios::binary);
    if (!in)
        throw InputError(
            fmt::format("{}: cannot be opened: {}; resume needs this file, arris run starts the run again",
                        path, std::generic_category().message(errno)));
    std::string line;
    std::uint64_t bytes = 0;
    for (std::int64_t whole = 0; whole <= rows; ++whole) {
        if (!read_whole_line(in, line))
            throw InputError(fmt::format("{}: has {} complete rows, but the run had written {}", path,
                                         std::max<std::int64_t>(whole - 1, 0), rows));
        bytes += line.size() + 1;
    }
    std::filesystem::resize_file(path, bytes);
}

CsvReader::CsvReader(const std::string& path) : path_(path), in_(path, std::ios::binary)
{
    std::string line;
    if (!in_) throw InputError(path + ": cannot be opened");
    if (!read_whole_line(in_, line)) throw InputError(path + ": has no header line");
    for (const std::string_view name : split(line)) names_.emplace_back(name);
}

bool CsvReader::has_column(std::string_view name) const
{
    return find_name(names_, name) < names_.size();
}

std::size_t CsvReader::column(std::string_view name) const
{
    if (!has_column(name)) fail_missing(path_, name);
    return find_name(names_, name);
}

bool CsvReader::next(std::vector<double>& cells)
{
    std::string line;
    if (!read_whole_line(in_, line)) return false;
    ++line_;
    const std::vector<std::string_view> texts = split(line);
    if (texts.size() != names_.size())
        throw InputError(
            fmt::format("{}: line {} has {} cells, not {}", path_, line_, texts.size(), names_.size()));
    cells.clear();
    std::transform(texts.begin(), texts.end(), std::back_inserter(cells),
                   [this](std::string_view text) { return parse(text); });
    return true;
}

double CsvReader::parse(std::string_view text) const
{
    if (text.empty()) return std::numeric_limits<double>::quiet_NaN();
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        throw InputError(fmt::format("{}: line {} has a cell that is not a number", path_, line_));
    return value;
}

const std::vector<double>& CsvTable::column(std::string_view name) const
{
    const std::size_t index = find_name(names, name);
    if (index == names.size()) fail_missing(path, name);
    return columns[index];
}

CsvTable read_csv(const std::string& path)
{
    CsvReader reader(path);
    CsvTable table{path, reader.names(), std::vector<std::vector<double>>(reader.names().size())};
    std::vector<double> cells;
    while (reader.next(cells))
        for (std::size_t i = 0; i < cells.size(); ++i) table.columns[i].push_back(cells[i]);
    return table;
}

}  // namespace arris
