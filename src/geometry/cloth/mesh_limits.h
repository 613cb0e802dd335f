// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace arris {

// Limits on lengths in the cloth's mesh, relative to its target length (mesh_target.h).

/// Two vertices nearer to each other than this are too close. Mesh surgery moves one onto the place of the
/// other, and clears this much ahead of a trace. Raising it makes traces rounder and faces around them
/// thinner.
inline constexpr double kCrowded = 0.3;

/// An edge shorter than this is merged. Raising it coarsens the mesh beside traces.
inline constexpr double kShortEdge = 0.5;

/// An edge longer than this is split. The value is four times kShortEdge, so that no split makes a short
/// edge. It also limits the distance between neighbours along a trace.
inline constexpr double kLongEdge = 2.0;

/// Share of an edge, from an end that cannot move, within which surgery does not split it. Raising it leaves
/// more contacts near vertices without an EOL vertex, lowering it makes thin faces.
inline constexpr double kSplitFromEnd = 0.05;

}  // namespace arris
