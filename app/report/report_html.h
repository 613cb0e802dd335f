// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "app/report/report.h"

namespace arris {

/// Writes run_dir/report.html atomically: the report with plots of run_dir/steps.csv and, if it exists,
/// run_dir/probes.csv. One page without scripts that opens from disk without a network; titles, names and
/// messages are escaped. Memory is constant in the number of steps. Throws InputError for an invalid table,
/// std::system_error naming the path if writing fails.
void write_report_html(const std::string& run_dir, const RunReport& report);

}  // namespace arris
