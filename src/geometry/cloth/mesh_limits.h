// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace arris {

// Lengths of the cloth's mesh as shares of its target length (mesh_target.h).

/// Two vertices nearer to each other than this are in each other's way: mesh surgery moves one onto the other
/// or clears as much ahead of a trace. Raising it makes traces rounder and faces around them thinner.
inline constexpr double kCrowded = 0.3;

/// An edge shorter than this is merged. Raising it coarsens the mesh beside traces.
inline constexpr double kShortEdge = 0.5;

/// An edge longer than this is split: four times kShortEdge, so that no split makes a short edge. Neighbours
/// along a trace are no farther apart either.
inline constexpr double kLongEdge = 2.0;

}  // namespace arris
