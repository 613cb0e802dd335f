// SPDX-License-Identifier: GPL-3.0-or-later
// Vertices that pins hold, and their targets. A pin takes hold of the vertices in its box at its start, and
// of the nearest vertex where surgery has left none in the box. It holds until its release; vertices that
// come into its box later are held from then on.
//
// A pin moves what it holds like points of a rigid body with placement P(t): x(t) = P(t) origin. From time 0,
// the origin is the initial place of a vertex, which P(0) may move. Later, a pin takes hold of a vertex where
// it is: origin = P(start)^-1 x(start). Where a pin is released, the other pins that hold its vertices take
// hold of them anew, so that no vertex jumps. On an obstacle that deforms each vertex has a placement of its
// own, that of the surface below it.
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

/// Moves vertices that pins hold from time 0 to their places, with the pins' velocities, and records their
/// anchors.
void attach_pins(const Scene& scene, State& state);

/// Updates the anchors after a step from `begin` (s) to `state.time`: for pins that have started or that were
/// released in the step.
void update_anchors(const Scene& scene, double begin, State& state);

}  // namespace arris
