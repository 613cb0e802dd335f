// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "app/report/report.h"

namespace arris {

/// Whether the run ended as asked, and why not; whether anything passed through anything; how many warnings.
/// Plain sentences for someone who reads nothing else.
std::string verdict(const RunReport& report);

/// Whether the cloth was ever inside or beyond an obstacle, or beyond itself.
bool has_passed_through(const StepTotals& totals);

}  // namespace arris
