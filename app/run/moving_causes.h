// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "app/run/strain_warnings.h"
#include "app/scene/parts/run_config.h"

namespace arris {

/// An obstacle or pin that has moved before a strain peak, or the cloth's own start, as the cause of the
/// peak.
struct MovingCause {
    double strain = 0.0;   ///< estimate of what the motion alone makes; 0 where nothing moves
    bool is_near = false;  ///< whether it is at most two edges of the mesh (`edge`) from the peak
    std::string what;      ///< "ball moves 0.45 m, at up to 20 m/s"
    std::string remedy;    ///< "move it more slowly"
};

/// The motion that strains the cloth most at the peak; one near the peak before others. Two estimates count:
///  - a body that hits a long strip of cloth at speed V strains it by e, V = c sqrt(2 e sqrt(e (1 + e)) -
///  e^2),
///    c the speed of sound in the cloth (Smith, McCrackin, Schiefer 1958);
///  - a body that moves by w across cloth that others hold at a distance L stretches it to sqrt(L^2 + w^2).
MovingCause find_moving_cause(const RunConfig& config, const StrainPeak& peak, double edge);

}  // namespace arris
