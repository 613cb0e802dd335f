// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "solver/model/scene.h"
#include "solver/model/state.h"

namespace arris {

/// A vertex that a pin holds, and its target at the step's end.
struct PinTarget {
    int vertex;
    std::array<bool, 3> held;  ///< x, y, z
    Vec3 target;               ///< m; meaningful in held directions
    int pin = -1;              ///< index in the scene of the last pin that holds the vertex
};

/// Vertices held during the step that ends at `end` (s), ascending. Where pins overlap, a direction follows
/// the last pin that holds it.
std::vector<PinTarget> find_pin_targets(const Scene& scene, const State& state, double end);

/// Moves held vertices to their targets, in the directions in which they are held.
void hold_in_place(const std::vector<PinTarget>& held, std::vector<Vec3>& world);

/// Moves vertices that pins hold to their places at time 0, with the pins' velocities, and records their
/// anchors.
void attach_pins(const Scene& scene, State& state);

}  // namespace arris
