// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/export/export_frames.h"

namespace arris {

/// Reads run_dir/report.json, or the checkpoint of a run that was killed before its first report. Throws
/// InputError naming the file if run_dir holds no run, the report is invalid, or the run writes no frames.
ExportOptions read_export_options(const std::string& run_dir);

/// A warning where the file of the run's obstacles is missing, so that an export is without them.
std::vector<std::string> warn_of_missing_files(const std::string& run_dir);

}  // namespace arris
