// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "app/report/report.h"

namespace arris {

/// Explains to a user why a contact is a row of the velocity solve and not an EOL vertex.
const char* explain(ConstraintCause cause);

/// "98.3 %", or "no contacts" if there is no share.
std::string format_share(const std::optional<double>& share);

/// Rows of an HTML table: the number of EOL vertices, and of rows by each cause that occurs.
std::string feature_rows_html(const FeatureTotals& features);

}  // namespace arris
