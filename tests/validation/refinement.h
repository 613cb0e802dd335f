// SPDX-License-Identifier: GPL-3.0-or-later
// Orders of convergence and the tables of docs/measured/validation.md, shared by the validation tests.
#pragma once

#include <string>
#include <vector>

namespace arris {

/// Slope of log(error) over log(size) by least squares: the order of convergence. Sizes and errors are
/// positive.
double order_of(const std::vector<double>& sizes, const std::vector<double>& errors);

/// Whether the environment variable ARRIS_DEEP=1 asks for the refinements that take minutes.
bool is_deep();

/// A measured table. Its destructor writes <name>.md in the folder that ARRIS_VALIDATION_TABLES names, or
/// nothing if that variable is not set. scripts/validation puts the tables into docs/measured/validation.md.
class Table {
  public:
    Table(std::string name, std::vector<std::string> columns);
    ~Table();
    Table(const Table&) = delete;
    Table& operator=(const Table&) = delete;

    void add(std::vector<std::string> cells);  ///< one cell for each column

  private:
    std::string name_;
    std::size_t column_count_;
    std::string text_;
};

}  // namespace arris
