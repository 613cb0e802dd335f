// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "solver/scene.h"
#include "solver/state.h"
#include "solver/time_integration.h"

namespace arris {

/// A vertex that a pin holds, and where it must be at the step's end.
struct HeldVertex {
    int vertex;
    std::array<bool, 3> held;  ///< x, y, z
    Vec3 target;               ///< m; meaningful in held directions
};

/// Vertices held during the step that ends at `end` (s), ascending. Where pins overlap, a direction follows
/// the last pin that holds it.
std::vector<HeldVertex> find_held_vertices(const Scene& scene, const State& state, double end);

/// A vertex and a plane it must not pass: gap = distance left to the stand-off, m.
struct Contact {
    int vertex;
    Vec3 normal;     ///< unit, out of the obstacle
    double gap_now;  ///< at q_k
    double gap;      ///< at q~, history flattened
};

/// Contacts with the scene's floor: every vertex has one, as a bound costs nothing until it is met. Flattens
/// the history in `prediction` along the normal where the predicted position has passed the stand-off or the
/// contact was active, so that gap(q~) = gap(q_k) and the normal part of v~ is v_k's. Otherwise what a vertex
/// brought into an impact would be extrapolated through it, and it would rebound.
std::vector<Contact> find_contacts(const Scene& scene, const State& state, Prediction& prediction);

}  // namespace arris
