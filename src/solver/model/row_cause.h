// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "solver/model/state.h"

namespace arris {

/// Why a contact with a sharp feature that presses is a row, where it could be an EOL vertex.
///
/// A contact is a place of the cloth on a feature. Of an edge of the cloth that ends at an EOL vertex of the
/// same feature nothing can be told apart from that vertex within 5 % of its length, as no vertex is put
/// nearer to another, nor within the stand-off, on whose rounding both touch; and where both its ends are
/// such vertices it is the trace itself; so it is where a face that has that edge touches, within 5 % of it,
/// a vertex that the obstacle's mesh has in the middle of a convex edge. The row there holds what the
/// vertex's bound holds, and neither holds the material back: it is no contact of its own (`AtEol`). Farther
/// from the vertex it is one (`BesideEol`).
///
/// Where a fold flies off an edge the cloth behind it lies on one face and goes on beyond its end in the same
/// plane. What presses there does so along the face's normal: it is what the face holds of the cells that
/// reach beyond it, turns the cloth by nothing and holds no material back. A vertex of two velocities would
/// move as an ordinary one does, and be let go at once, as all are where cloth is flat (`FlatBehind`).
enum class RowCause {
    New,           ///< it did not press at the end of the step before: a contact is a row first
    NotCrossing,   ///< no place: the cloth does not pass through its edge's plane, or is not near its wire
    AtEol,         ///< it is the contact of an EOL vertex of that feature, seen from beside it
    BesideEol,     ///< the mesh's place for it is an EOL vertex of that feature, but the cloth touches
                   ///< elsewhere; or it follows too near a fold that has just flown off the feature
    FlatBehind,    ///< it follows a fold that flies off the feature, flat on a face beside that
    NearBorder,    ///< of the cloth: nearer than where a trace may begin, or where it had to end
    BorderAhead,   ///< of the cloth: so fast that it would have to go within a few steps
    Guard,         ///< the mesh it needs would strain the cloth, or an obstacle is in the way
    Quality,       ///< the mesh has no place for it: a corner, another trace, a face too thin
    OffPlane,      ///< where the mesh could have it is off its plane
    Blocked,       ///< what is ahead of its trace could not be cleared
    GivenUp,       ///< with EOL vertices there an attempt at this step had failed
    Released,      ///< it was EOL until this step
    NoDirection,   ///< a saddle corner, or wire or point whose cloth tells no side
    AlongBorder,   ///< the cloth's border leads along the trace, or the feature, within 20 degrees
    EdgeOn,        ///< flat cloth that all but contains the outward direction: no coordinates there
    ClothCorner,   ///< only rows at the cloth's own corners
    OtherFeature,  ///< its vertex is on another feature, or one nearer than a thickness has a trace there
    OtherObstacle  ///< its vertex is on a feature of another obstacle
};
inline constexpr std::size_t kRowCauses = 19;
using RowCounts = std::array<int, kRowCauses>;  ///< by RowCause

/// In the columns of steps.csv.
const char* to_string(RowCause cause);

/// Whether no EOL vertex is wanted there, whatever the mesh: it would have no coordinates, would be off the
/// cloth's border at once, or is there.
bool is_excluded(RowCause cause);

/// Whether such rows count in the share of contacts that are EOL: not excluded, and not in their first step.
bool counts_in_share(RowCause cause);

/// A contact that pressed at the step's start, and why none of EOL vertices has come of it.
struct RefusedContact {
    std::array<std::uint32_t, 3> vertex_ids;  ///< as ActiveContact's, as all that follows
    ContactKind kind;
    std::int32_t obstacle;
    std::int32_t element;  ///< of a vertex's contact it does not count: it slides from face to face
    RowCause cause;
};

}  // namespace arris
