// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "app/run/checkpoint.h"

namespace arris {

/// Describes the first invalid value of a checkpoint as read; empty if there is none.
std::string find_defect(const Checkpoint& checkpoint);

}  // namespace arris
