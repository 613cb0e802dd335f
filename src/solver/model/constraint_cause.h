// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "solver/model/state.h"

namespace arris {

/// The reason why a pressing contact with a sharp feature is a constraint and not an EOL vertex.
///
/// A contact is a place of the cloth on a feature. Near an EOL vertex of the same feature it is no contact of
/// its own (`AtEol`): its constraint and the vertex's bound keep the same distance, and neither holds the
/// material back. On an edge of the cloth that ends at such a vertex, this holds within 5 % of the edge's
/// length: no vertex is inserted nearer to another. It also holds within the stand-off, where rounding
/// decides which of the two touches. If both ends are such vertices, the edge is the trace, and this holds
/// everywhere on it. A face with that trace edge may touch a vertex of the obstacle's mesh in the middle of a
/// convex edge: within 5 % of the trace, this counts too. Farther from the vertex a contact is one of its own
/// (`BesideEol`).
///
/// Where a fold flies off an edge, the cloth behind the fold lies on one face and reaches beyond the face's
/// end in the same plane. A contact there presses along the face's normal: the face carries the cells that
/// reach beyond it. This contact neither turns the cloth nor holds material back (`FlatBehind`). An EOL
/// vertex there would move like an ordinary vertex and be released at once, as all are where the cloth is
/// flat.
enum class ConstraintCause {
    New,          ///< did not press at the end of the step before: a contact is first a constraint
    NotCrossing,  ///< no place: the cloth does not cross the edge's plane, or is not near the wire
    AtEol,        ///< is the contact of an EOL vertex of that feature, found from beside it
    BesideEol,   ///< its place on the mesh is an EOL vertex of that feature, but the cloth touches elsewhere;
                 ///< or it follows too near a fold that has just flown off the feature
    FlatBehind,  ///< follows a fold that flies off the feature, flat on a face beside it
    Unresolved,  ///< the feature is finer than the cells, which cannot follow it
    NearBorder,  ///< border of the cloth: nearer than where a trace may begin, or where it had to end
    BorderAhead,   ///< border of the cloth: so fast that the vertex would be released within a few steps
    Guard,         ///< the mesh change would strain the cloth, or an obstacle is in the way
    Quality,       ///< the mesh has no place: a corner, a pin, another trace, a face too thin
    OffPlane,      ///< the mesh's only place is off the edge's plane
    Blocked,       ///< cloth ahead of its trace could not be cleared
    Gathering,     ///< the cloth is compressed along the feature, so that it wants to leave it in pleats
    GivenUp,       ///< an attempt at this step had failed with EOL vertices there
    Released,      ///< was EOL until this step
    NoDirection,   ///< a saddle corner, or a wire or point where the cloth's side is unknown
    AlongBorder,   ///< the cloth's border leads along the trace or the feature, within 20 degrees
    EdgeOn,        ///< flat cloth that almost contains the outward direction: no coordinates
    ClothCorner,   ///< at a corner of the cloth, where all contacts are constraints
    OtherFeature,  ///< its vertex is on another feature, or another feature within a thickness has a trace
                   ///< there
    OtherObstacle  ///< its vertex is on a feature of another obstacle
};
inline constexpr std::size_t kConstraintCauses = static_cast<std::size_t>(ConstraintCause::OtherObstacle) + 1;
using ConstraintCounts = std::array<int, kConstraintCauses>;  ///< by ConstraintCause

/// Name in the columns of steps.csv.
const char* to_string(ConstraintCause cause);

/// Whether no EOL vertex is possible or wanted there, whatever the mesh: without coordinates, at once off the
/// cloth's border, on flat cloth, finer than the cells, where it gathers, or because there is one already.
bool is_excluded(ConstraintCause cause);

/// Whether constraints with this cause count in the EOL share: neither excluded nor in their first step.
bool counts_in_share(ConstraintCause cause);

/// A contact that pressed at the step's start, and why it did not become an EOL vertex.
struct RefusedContact {
    ContactVertexIds vertex_ids;  ///< this and the next three members as in ActiveContact
    ContactKind kind;
    std::int32_t obstacle;
    std::int32_t element;  ///< not compared for a vertex's contact, which slides from face to face
    ConstraintCause cause;
};

}  // namespace arris
