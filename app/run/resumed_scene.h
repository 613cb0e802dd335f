// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "app/run/checkpoint.h"
#include "app/scene/run_config.h"

namespace arris {

/// The scene of a checkpoint in `directory`, to end at `until` where that is given. What is left is planned
/// anew where the new end changes the interval that the run stands in.
RunConfig load_resumed(const std::string& directory, const std::optional<double>& until,
                       Checkpoint& checkpoint);

}  // namespace arris
