// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "solver/eol_coordinates.h"
#include "solver/state.h"

namespace arris {

/// Why a contact with a sharp feature that presses is a row, where it could be an EOL vertex.
enum class RowCause {
    New,           ///< it did not press at the end of the step before: a contact is a row first
    NotCrossing,   ///< no place: the cloth does not pass through its edge's plane, or is not near its wire
    BesideEol,     ///< an EOL vertex of that feature is at its place, or at an end of its edge
    NearBorder,    ///< of the cloth: it would have to go at once
    Guard,         ///< the mesh it needs would strain the cloth, or an obstacle is in the way
    Quality,       ///< the mesh has no place for it: a corner, another trace, a face too thin
    OffPlane,      ///< where the mesh could have it is off its plane
    Blocked,       ///< what is ahead of its trace could not be cleared
    GivenUp,       ///< with EOL vertices there an attempt at this step had failed
    Released,      ///< it was EOL until this step, or until the cloth is off its wire or point
    NoDirection,   ///< as EolRefusal
    AlongBorder,   ///< alike
    EdgeOn,        ///< alike
    ClothCorner,   ///< alike
    OtherFeature,  ///< its vertex is on another feature, or one nearer than a thickness has a trace there
};
inline constexpr std::size_t kRowCauses = 15;
using RowCounts = std::array<int, kRowCauses>;  ///< by RowCause

/// In the columns of steps.csv.
const char* to_string(RowCause cause);

/// Whether a vertex there would have no coordinates, whatever the mesh.
bool is_without_coordinates(RowCause cause);

RowCause cause_of(EolRefusal refusal);

/// A contact that pressed at the step's start, and why none of EOL vertices has come of it.
struct RefusedContact {
    std::array<std::uint32_t, 3> vertex_ids;  ///< as ActiveContact's, as all that follows
    ContactKind kind;
    std::int32_t obstacle;
    std::int32_t element;  ///< of a vertex's contact it does not count: it slides from face to face
    RowCause cause;
};

}  // namespace arris
