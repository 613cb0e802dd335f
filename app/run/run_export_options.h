// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "app/export/export_frames.h"

namespace arris {

/// Read from run_dir/report.json, or from the checkpoint of a run that was killed before it had one.
/// InputError naming the file if run_dir holds no finished or stopped run, the report is not one, or the run
/// was asked for no frames.
ExportOptions read_export_options(const std::string& run_dir);

}  // namespace arris
