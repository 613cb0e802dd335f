// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "app/report/report.h"

namespace arris {

/// run_dir/report.html: the report for a person, with plots of run_dir/steps.csv and, where it is there,
/// run_dir/probes.csv. One page without scripts that opens from disk without a network; titles, names and
/// messages are shown as text whatever they hold. Constant memory in the number of steps; whole or absent.
/// InputError if a table is not one, std::system_error naming the path where the disk refuses.
void write_report_html(const std::string& run_dir, const RunReport& report);

}  // namespace arris
