// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "app/report/report.h"

namespace arris {

/// Why a contact is a row of the velocity solve and no EOL vertex, for a reader who has not seen the method.
const char* explain(RowCause cause);

/// "98.3 %", whole where it is; "none pressed" where there is no share.
std::string format_share(const std::optional<double>& share);

/// What pressed on sharp features, a row of a table each that is not 0: EOL vertices, and rows by cause.
std::string feature_rows_html(const FeatureTotals& features);

}  // namespace arris
