// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "app/run/strain_warnings.h"
#include "app/scene/parts/run_config.h"

namespace arris {

/// What the scene itself imposes on its cloth, each as the strain that it causes alone: the start, the
/// distance between pins, the load, the motion of obstacles and pins (moving_causes.h). Returns the cause of
/// a stretch peak, with its remedy, as the end of a sentence; where none of them strains the cloth by 5 %,
/// the greatest of them is named as too small.
std::string explain_stretch(const RunConfig& config, const StrainPeak& peak);

/// As explain_stretch, for a compression. Pins compress cloth if they bring its material together.
std::string explain_compression(const RunConfig& config, const StrainPeak& peak);

}  // namespace arris
