// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "app/study/study_file.h"

namespace arris {

/// Fills `telling_keys` and `axis_keys` of a study from its runs.
void find_axes(Study& study);

}  // namespace arris
