// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/report/report.h"
#include "app/run/checkpoint.h"
#include "app/scene/parts/run_config.h"

namespace arris {

/// Warnings that only the end of a run can give: strains that cloth does not bear, friction off its law and,
/// of a finished run, obstacles that the cloth never touched, if it touched none.
std::vector<std::string> warn_at_end(const RunConfig& config, const RunProgress& progress, RunStatus status);

}  // namespace arris
