// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "geometry/cloth/material_region.h"
#include "geometry/cloth/mesh_target.h"
#include "geometry/cloth/piece_place.h"
#include "geometry/obstacle/moving_obstacle.h"
#include "geometry/rigid_motion.h"
#include "physics/elements/effects.h"
#include "physics/elements/materials.h"
#include "solver/model/remeshing.h"
#include "solver/model/sewing.h"

namespace arris {

/// Holds and moves cloth vertices whose material coordinates lie in `material`, in the `held` world
/// directions, from `start` to `release`. After time 0 it takes hold of them where they are (pin_targets.h).
struct Pin {
    MaterialRegion material;
    RigidMotion motion;                                        ///< at absolute times
    std::array<bool, 3> held = {true, true, true};             ///< x, y, z
    double start = 0.0;                                        ///< s
    double release = std::numeric_limits<double>::infinity();  ///< s
    std::optional<int> follows = {};  ///< obstacle (index) that they ride on instead of `motion`

    /// Whether it holds its vertices during a step, or a longer time, from `begin` to `end`.
    bool holds(double begin, double end) const { return start <= begin && begin < release && end <= release; }
};

/// Stands for an obstacle's index where the cloth meets itself.
inline constexpr int kClothItself = -1;

/// Coulomb friction between cloth and obstacles, and between layers of cloth. Coefficients are >= 0.
struct Friction {
    std::vector<double> of_pieces;  ///< one a piece of cloth
    /// By obstacle, in place of the piece's; may be shorter.
    std::vector<std::optional<double>> of_obstacles = {};
    std::optional<double> between_layers = {};  ///< in place of the mean of both pieces'

    double with_obstacle(int obstacle, int piece) const;
    double between(int piece, int other) const;
};

/// Contact of the cloth with itself.
struct ClothContact {
    double thickness;  ///< m, kept between the middle surfaces of two layers
};

/// The simulated scene, const while stepping. An absent effect costs nothing.
struct Scene {
    Materials materials;                    ///< of the pieces of cloth
    std::vector<PiecePlace> pieces = {{}};  ///< the same pieces, for messages
    std::optional<Gravity> gravity;
    std::optional<Wind> wind;
    std::vector<Pull> pulls;
    std::vector<Pin> pins;
    std::vector<MovingObstacle> obstacles;
    std::optional<Friction> friction;
    std::optional<ClothContact> self_contact;
    std::optional<Sewing> sewing;
    std::optional<MeshTarget> eol;  ///< target of the mesh near features; no EOL vertices without it
    std::optional<Remeshing> remesh;
};

/// Piece of cloth at a vertex of the mesh.
int piece_of(const Scene& scene, const ClothMesh& mesh, int vertex);

/// Whether any obstacle has a sharp edge, corner, wire or point.
bool has_features(const Scene& scene);

/// Where something that `pin` holds at `place` at `time` (s) rides on the obstacle that the pin follows;
/// nowhere (element -1) where that is rigid, or where there is none.
SurfacePlace pin_surface(const Scene& scene, const Pin& pin, double time, const Vec3& place);

/// Maps the origin (PinAnchor) of something that `pin` holds, and that rides at a place of a surface, to its
/// place at `time` (s).
Placement pin_placement(const Scene& scene, const Pin& pin, const SurfacePlace& on, double time);

/// Velocity (m/s) just after `time` of something that `pin` holds at `place`.
Vec3 pin_velocity(const Scene& scene, const Pin& pin, const SurfacePlace& on, double time, const Vec3& place);

/// Times after 0 at which the input jumps (motion starts or stops, keyframe, pin, pull): ascending, unique.
/// Steps end on them, and the step after one is implicit Euler.
std::vector<double> input_jumps(const Scene& scene);

}  // namespace arris
