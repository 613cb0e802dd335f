// SPDX-License-Identifier: GPL-3.0-or-later
// A vertex on a sharp feature has three unknowns like any other: away from the feature (c), along it (a), and
// the material's flow over it (s); on a corner, or where a wire turns, c and two of flow. So contact is the
// bound c >= ..., and the system stays positive definite where the cloth is flat, where the world's and the
// material's motion across the feature are one and the same.
#pragma once

#include <optional>
#include <vector>

#include "geometry/feature_frame.h"
#include "geometry/feature_path.h"
#include "geometry/mesh_topology.h"
#include "geometry/rigid_motion.h"
#include "solver/state.h"

namespace arris {

/// Thicknesses from a feature, within which cloth lies on it: the mitre and a little.
inline constexpr double kOnFeature = 2.5;

/// One EOL vertex during a step: xdot = drift + basis u, Xdot = material_basis u, u = (c, a, s) or
/// (c, s1, s2).
struct EolCoordinates {
    int vertex;
    int entry;           ///< in State::eol
    FeatureFrame frame;  ///< at the step's start, in the obstacle's frame
    Vec3 carried;        ///< where riding on the obstacle takes it by the step's end, world
    Mat3 basis;          ///< first column: the outward direction at the step's end
    Mat23 material_basis;
    int side;      ///< EolVertex::side from now on
    Vec3 opening;  ///< change of u, (1, ...), that opens the gap with the least kinetic energy
};

/// The cloth around each vertex: what EOL coordinates are made of. Made anew where the mesh changes.
struct ClothStars {
    MeshTopology topology;
    VertexFaces faces;
    std::vector<std::array<int, 2>> border_neighbours;  ///< of a border vertex, ascending; -1 elsewhere
};
ClothStars make_stars(int vertex_count, const std::vector<Face>& faces);

/// Why a vertex cannot be EOL though a feature presses on it.
enum class EolRefusal {
    NoDirection,  ///< a saddle corner, or wire or point whose cloth tells no side
    AlongBorder,  ///< the trace meets the cloth's border at less than 20 degrees
    EdgeOn,       ///< flat cloth that all but contains the outward direction: material and world coincide
    ClothCorner   ///< only rows at the cloth's own corners
};

/// The coordinates of EOL vertex `entry` of the state, or why it can have none. `positions` are the cloth's
/// in the obstacle's frame, which is at `end` when the step of `dt` (s) ends. `thickness`: of the cloth, m.
struct EolPlacing {
    std::optional<EolCoordinates> coordinates;
    EolRefusal refusal = EolRefusal::NoDirection;  ///< where there are none
};
EolPlacing place_eol_vertex(const Obstacle& obstacle, double thickness, const State& state, int entry,
                            const ClothStars& stars, const std::vector<Vec3>& positions, const Placement& end,
                            double dt = 0.0);

/// The same of an obstacle that stays where it is, at `now`; looks at the cloth around the vertex only.
EolPlacing place_eol_vertex(const Obstacle& obstacle, double thickness, const State& state, int entry,
                            const ClothStars& stars, const Placement& now);

/// Of all entries of the state, obstacles being where they are at its time.
std::vector<EolPlacing> place_eol_vertices(const std::vector<Obstacle>& obstacles, double thickness,
                                           const State& state, const ClothStars& stars);

/// Whether it stays where it is along its feature, and material flows along it, too: on a corner, or where a
/// wire turns.
bool is_fixed(const EolVertex& eol);

/// The point of the obstacle's mesh at which a fixed vertex is held; -1 of one that slides.
int held_point(const Obstacle& obstacle, const EolVertex& eol);

/// Unit, of the feature that the vertex is on, in the obstacle's frame; zero on a corner.
Vec3 feature_tangent(const Obstacle& obstacle, const EolVertex& eol);

bool is_on_convex_edge(const Obstacle& obstacle, const EolVertex& eol);

/// An EOL vertex and where it is in its obstacle's frame.
struct PlacedEol {
    const EolVertex& eol;
    Vec3 place;
};

/// Whether two EOL vertices joined by an edge of the cloth have the feature along it: they are on one
/// polyline, or at its end, and it goes from one to the other nearly straight.
bool is_trace_edge(const Obstacle& obstacle, const PlacedEol& a, const PlacedEol& b);

/// Whether two EOL vertices on one convex edge are on one line along it: of a fold that has flown off and of
/// a trace behind it, which is on the edge, they are not. True of all others: where a polyline turns nothing
/// tells which way they have gone.
bool is_of_one_strand(const Obstacle& obstacle, const PlacedEol& a, const PlacedEol& b);

/// The cloth's edges that lie along features at the state's time: the entries in State::eol of their ends,
/// ascending.
std::vector<std::array<int, 2>> find_trace_edges(const std::vector<Obstacle>& obstacles, const State& state,
                                                 const ClothStars& stars);

/// EOL vertices that have gone along their polyline past an end of their edge are on the next one from now
/// on. At the state's time.
void follow_features(const std::vector<Obstacle>& obstacles, State& state);

}  // namespace arris
