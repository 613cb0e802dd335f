// SPDX-License-Identifier: GPL-3.0-or-later
#include "refinement.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string_view>

namespace arris {

namespace {

std::string row(const std::vector<std::string>& cells)
{
    return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

}  // namespace

double order_of(const std::vector<double>& sizes, const std::vector<double>& errors)
{
    const auto n = static_cast<double>(sizes.size());
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
    for (std::size_t k = 0; k < sizes.size(); ++k) {
        const double log_size = std::log(sizes[k]), log_error = std::log(errors[k]);
        x += log_size;
        y += log_error;
        xx += log_size * log_size;
        xy += log_size * log_error;
    }
    return (n * xy - x * y) / (n * xx - x * x);
}

bool is_deep()
{
    const char* value = std::getenv("ARRIS_DEEP");
    return value != nullptr && std::string_view(value) == "1";
}

Table::Table(std::string name, std::vector<std::string> columns)
    : name_(std::move(name)), column_count_(columns.size()), text_(row(columns))
{
    text_ += row(std::vector<std::string>(columns.size(), "---"));
}

void Table::add(std::vector<std::string> cells)
{
    ASSERT_EQ(cells.size(), column_count_);
    text_ += row(cells);
}

Table::~Table()
{
    const char* folder = std::getenv("ARRIS_VALIDATION_TABLES");
    if (folder == nullptr) return;
    std::ofstream file(std::string(folder) + "/" + name_ + ".md");
    file << text_;
    EXPECT_TRUE(file.good()) << "table " << name_ << " cannot be written to " << folder;
}

}  // namespace arris
