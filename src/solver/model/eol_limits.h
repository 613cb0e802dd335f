// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers that decide which contacts become EOL vertices and how their material may flow. A "cell" is the
// mesh's target length at the place. "Notes" are headings of docs/research-notes.md with the measurements.
#pragma once

#include "geometry/cloth/mesh_limits.h"

namespace arris {

// ---- Thresholds to become and to stay an EOL vertex (sites/eol_decision.h) ----

/// A length, in cells, around an EOL vertex.
struct CellsAround {
    double sliding;  ///< for a vertex that slides along its feature
    double fixed;    ///< for a vertex at a corner or a bend of a wire
};

/// Room along the trace from a new vertex to the cloth's border; around a fixed one to borders on any side.
/// An EOL vertex stays with kStayRatio of it. Around a fixed one also to the corners of features finer than
/// the cells. Raising it leaves more constraints in place of EOL vertices near borders.
inline constexpr CellsAround kRoom = {.sliding = kCrowded, .fixed = 0.5};

/// Distance from a feature, in thicknesses, within which cloth lies on the feature: slightly more than the
/// mitre. A vertex becomes EOL within this distance. Raising it treats contacts beside a feature as contacts
/// on it.
inline constexpr double kOnFeature = 2.5;

/// Distance from its feature, in cells, up to which a fold that flies off stays EOL. kAstrayCells applies
/// where the fold moves in another direction than the cloth that flows over it. Raising either costs energy
/// when the fold is released. Notes: "How far a fold is held".
inline constexpr double kFlyingCells = 1.0;
inline constexpr double kAstrayCells = 0.3;

/// Length, in cells, past the free end of a wire over which a fold on the wire may lead on, in line with it,
/// to the cloth's border. Without it the rope of rope_over_wire_test.cpp, on a wire that ends inside its
/// borders, slides by .19 of the closed form. Raising it keeps longer folds straight and in their plane that
/// have no support there: without a limit, cloth of 24 cells on a wire of half its width needs 2.1
/// factorisations a step in place of 1.0.
inline constexpr double kPastEnd = 4.0;

/// Likewise, in thicknesses, past a corner where other wires go on: only for borders flush with it. Raising
/// it leads folds on into the corner's other wires.
inline constexpr double kPastJoinedEnd = 0.1;

/// Consecutive steps without pressing before a vertex may be released: contact that chatters is still
/// contact.
inline constexpr int kIdleSteps = 3;

/// Cosine of 3 degrees: cloth is flat where its normals are within this angle of their mean. Releasing a
/// vertex there costs less than 0.05 % of the kinetic energy around it. Lowering this cosine releases folds
/// that still turn the cloth.
inline constexpr double kFlat = 0.9986;

/// Degrees between a trace and the cloth's border, below which an EOL vertex on the border has no sound
/// coordinates.
inline constexpr double kLeastCrossing = 20.0;

/// Largest distance of a new vertex from its edge's plane, in thicknesses: a vertex inserted farther off
/// would stay off the plane. Also the distance within which an edge that begins or ends near the plane
/// serves.
inline constexpr double kOffPlane = 0.1;

// ---- Bends of wires (sites/bend_sites.h) ----

/// Distance in thicknesses by which a chord may miss a bend; beyond it the bend gets a vertex of its own. A
/// whole thickness is too much: faces beside a fold's top pass the wire nearer than the top does. Notes:
/// "Bends of wires".
inline constexpr double kMissedByChord = 0.3;

/// Cells. A fixed vertex nearer to a bend counts as the bend's vertex; a sliding one nearer moves to the
/// bend. Raising either leaves bends without a vertex exactly on them.
inline constexpr CellsAround kBesideBend = {.sliding = kShortEdge, .fixed = 0.2};
// ---- Flow of material through EOL vertices ----

/// Share of a face's material that one step may take. Raising it makes faces too small for a reliable strain.
inline constexpr double kMostFaceTaken = 0.6;

/// Steps of its own flow that must be clear ahead of a vertex. Raising them releases more vertices. Notes:
/// "Room ahead of a sliding vertex".
struct ClearSteps {
    double edge;  ///< on a convex edge
    double wire;  ///< on wires and sheet borders, where the two sides swing
    double tip;   ///< at a tip, where a pleat stands in the way and merges more easily the nearer it is
};
inline constexpr ClearSteps kClearSteps = {.edge = 4.0, .wire = 1.0 / kMostFaceTaken, .tip = 1.0};

/// Flow over a convex edge, m/s, above which a fold off its edge moves along the face on which the cloth
/// arrives. Slower cloth that shakes or hangs between corners returns. Notes: "Which way the fold is led".
inline constexpr double kFreeFlow = 1.0;

/// Speed, m/s, at which a vertex moves in position alone: out to its stand-off, round a wire or round a tip.
/// Raising it does work on the cloth.
inline constexpr double kMendingSpeed = 0.1;

/// Share of the angle still to go by which an outward direction at a wire or tip turns in a step, as the
/// cloth shakes. Raising it lets the direction shake with the cloth.
inline constexpr double kTurnPerStep = 0.5;

}  // namespace arris
