// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers that steer which contacts are EOL vertices and what their flow may do. "Cell" is the target
// length of the mesh there. "Notes" are the headings of docs/research-notes.md with the measurements.
#pragma once

#include "geometry/cloth/mesh_limits.h"

namespace arris {

// ---- Who is EOL: thresholds to enter and to stay (sites/eol_decision.h) ----

/// Room, in cells, from a vertex to where the cloth's border ends its trace. An EOL vertex stays with half
/// the room that a new one needs, so that it does not come and go. Raising either leaves more rows near
/// borders.
struct BorderRoom {
    double sliding;  ///< of a vertex that slides along its feature
    double fixed;    ///< of one at a corner or a bend of a wire, which the border may come to from any side
};
inline constexpr BorderRoom kRoomToEnter = {.sliding = kCrowded, .fixed = 0.5};
inline constexpr BorderRoom kRoomToStay = {.sliding = 0.15, .fixed = 0.3};

/// Distance from a feature, in thicknesses, within which cloth lies on it: the mitre and a little. A vertex
/// enters within it. Raising it takes contacts beside a feature for contacts on it.
inline constexpr double kOnFeature = 2.5;

/// Distance from its feature, in cells, up to which a fold that flies off stays EOL: in general, and where it
/// is led otherwise than the cloth that flows over it. Raising either costs energy when the fold is released.
/// Notes: "How far a fold is held".
inline constexpr double kFlyingCells = 1.0;
inline constexpr double kAstrayCells = 0.3;

/// Steps in a row without pressing, before which no vertex is released: contact that chatters is still
/// contact.
inline constexpr int kIdleSteps = 3;

/// Cosine of 3 degrees: cloth whose normals are within that of their mean is flat. Releasing a vertex there
/// costs less than 5e-4 of the kinetic energy around it. Lowering it releases folds that still turn the
/// cloth.
inline constexpr double kFlat = 0.9986;

/// Degrees between a trace and the cloth's border, below which an EOL vertex on the border has no sound
/// coordinates.
inline constexpr double kLeastCrossing = 20.0;

/// Distance of a new vertex from its edge's plane, in thicknesses: off the plane it would stay off.
inline constexpr double kOffPlane = 0.1;

// ---- Bends of wires (sites/bend_sites.h) ----

/// Distance in thicknesses by which a chord may miss a bend; beyond that the bend gets a vertex of its own. A
/// whole thickness is too much: faces beside a fold's top pass the wire nearer than the top does. Notes:
/// "Bends of wires".
inline constexpr double kMissedByChord = 0.3;

/// Cells: a fixed vertex nearer than the first is taken for the bend's; a sliding one nearer than the second
/// moves there.
inline constexpr double kFixedBeside = 0.2;
inline constexpr double kSlidingBeside = 0.5;

// ---- Flow of material through EOL vertices ----

/// Share of a face's material that one step may take. Raising it makes faces that strain cannot be judged on.
inline constexpr double kMostFaceTaken = 0.6;

/// Steps of its own flow that must be clear ahead of a vertex: in general; at a tip, where a pleat stands in
/// the way that merges the more easily the nearer it is; on wires and sheet borders, where the two sides
/// swing. Raising them releases more vertices. Notes: "Room ahead of a sliding vertex".
inline constexpr double kClearSteps = 4.0;
inline constexpr double kTipSteps = 1.0;
inline constexpr double kWireSteps = 1.0 / kMostFaceTaken;

/// Flow over a convex edge, m/s, from which on a fold off its edge is led along the face that the cloth comes
/// on. Slower cloth that shakes or hangs between corners comes back. Notes: "Which way the fold is led".
inline constexpr double kFreeFlow = 1.0;

/// Speed, m/s, at which a vertex is moved in position alone: out to its stand-off, round a wire, round a tip.
/// Raising it does work on the cloth.
inline constexpr double kMendingSpeed = 0.1;

}  // namespace arris
