// SPDX-License-Identifier: GPL-3.0-or-later
// What the validation tests share: orders of convergence, and the tables that end up in docs/validation.md.
#pragma once

#include <string>
#include <vector>

namespace arris {

/// Slope of log(error) over log(size) by least squares: the order of convergence. Sizes and errors are
/// positive.
double order_of(const std::vector<double>& sizes, const std::vector<double>& errors);

/// Whether the refinements that take minutes are asked for (environment variable ARRIS_DEEP=1).
bool is_deep();

/// A measured table. When it goes out of scope it is written as Markdown to <name>.md in the folder that
/// ARRIS_VALIDATION_TABLES names (scripts/validation puts it into docs/validation.md), or nowhere without
/// one.
class Table {
  public:
    Table(std::string name, std::vector<std::string> columns);
    ~Table();
    Table(const Table&) = delete;
    Table& operator=(const Table&) = delete;

    void add(std::vector<std::string> cells);  ///< one a column

  private:
    std::string name_;
    std::size_t column_count_;
    std::string text_;
};

}  // namespace arris
