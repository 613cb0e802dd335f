// SPDX-License-Identifier: GPL-3.0-or-later
// Pins, pulls and probes: the parts of the material that they name.
#pragma once

#include "app/scene/keys/scene_document.h"
#include "app/scene/parts/run_config.h"

namespace arris {

/// Gives pins, pulls and probes their places in the plane of all pieces. Throws InputError for pieces, panels,
/// vertices and labels that are not there.
void place_in_material(const SceneDocument& document, RunConfig& config);

/// Throws InputError for a pin, pull or probe that meets no cloth.
void check_meetings(const SceneDocument& document, const RunConfig& config);

/// Warns of keyframes that move the cloth from its placement at time 0.
void warn_of_first_keyframes(const SceneDocument& document, RunConfig& config);

}  // namespace arris
