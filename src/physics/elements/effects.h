// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <limits>
#include <optional>

#include "geometry/cloth/material_box.h"
#include "geometry/vectors.h"

namespace arris {

struct Gravity {
    Vec3 acceleration = Vec3(0.0, 0.0, -9.81);  ///< m/s^2
};

/// Multiplies the wind by 1 + amplitude sin(2 pi frequency t + phase(seed)).
struct Gust {
    double amplitude = 0.0;
    double frequency = 0.0;  ///< Hz
    long seed = 0;
};

struct Wind {
    Vec3 velocity = Vec3::Zero();  ///< m/s
    double air_density = 1.2;      ///< kg/m^3
    double drag = 1.0;
    std::optional<Gust> gust;
};

/// A force spread over a box of material between two times.
struct Pull {
    MaterialBox material;
    Vec3 force = Vec3::Zero();  ///< N in total
    double start = 0.0;         ///< s
    double stop = std::numeric_limits<double>::infinity();

    /// Whether the force acts on a step from `begin` to `end`. Steps end on `start` and `stop`.
    bool acts_between(double begin, double end) const { return begin >= start && end <= stop; }
};

}  // namespace arris
