// SPDX-License-Identifier: GPL-3.0-or-later
// The elastica, by shooting: the reference for clamped strips. Lengths are in units of the strip's length.
//
//   theta'' = -(1 + eps) [G (1 - s) cos(theta) + P cos(theta)],   theta(0) = 0, theta'(1) = 0
//   x' = (1 + eps) cos(theta),  y' = (1 + eps) sin(theta),  eps = c [G (1 - s) + P] sin(theta)
//
// theta is the angle below the horizontal. The loads are downward: the weight G = rho g L^3 / D, and the load
// at the tip P = p L^2 / D (force p per width). c = D / (E L^2) lets the strip stretch as the cloth does; c =
// 0 is the classic elastica.
#pragma once

namespace arris {

struct ElasticaLoad {
    double weight = 0.0;         ///< G
    double tip = 0.0;            ///< P
    double extensibility = 0.0;  ///< c
};

struct ElasticaTip {
    double x, y;   ///< y downward
    double angle;  ///< rad
};

/// The branch that leaves the straight strip as the load grows (others exist).
ElasticaTip solve_elastica(const ElasticaLoad& load);

/// The weight G (no other load) under which the tip has this y / x.
double find_elastica_weight(double tip_ratio, double extensibility);

}  // namespace arris
