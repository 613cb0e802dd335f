// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "app/scene/parts/run_config.h"

namespace arris {

/// An effect that a run does not simulate, and what its absence would show in this scene.
struct MissingEffect {
    std::string name;  ///< as in report.json
    std::string sign;  ///< "cloth starts folded by 180 degrees, and its sides may pass through each other"
};

/// Effects whose absence shows, by simple rules on the scene at time 0 and the motion of its pins. The rules
/// find obvious cases only: an empty list is no promise.
/// self_contact: pieces of cloth; cloth that starts folded back on itself, falls edge-on onto an obstacle,
/// hangs from one place, hangs down on both sides of something narrow, is drawn together by pins, or reaches
/// around a corner of an obstacle without a pin that holds it to the end.
/// friction: cloth that no pin holds to the end over an edge or a slope; an obstacle that moves along under
/// the cloth.
/// gravity, bending, eol: absent by the scene's choice, where that is often an oversight.
std::vector<MissingEffect> find_missing_effects(const RunConfig& config);

}  // namespace arris
