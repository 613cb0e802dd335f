// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "geometry/cloth/cloth_mesh.h"
#include "geometry/obstacle/moving_obstacle.h"

namespace arris {

/// How a start treats the crossings of two surfaces.
enum class StartRule {
    Ignore,     ///< they may cross, as layers of a cloth without contact with itself
    KeepApart,  ///< no move may make them cross; where they cross already, they stay
    Untangle,   ///< where they cross, they come apart
};

/// An obstacle as it stands at time 0.
struct StartObstacle {
    ObstaclePose pose;
    StartRule rule = StartRule::KeepApart;
};

struct UntangleRequest {
    StartRule self = StartRule::Ignore;    ///< of the cloth with itself
    std::vector<StartObstacle> obstacles;  ///< all that the cloth may not pass
    std::vector<int> held;                 ///< vertices that stay, such as pinned ones
    double thickness = 0.0;                ///< m, > 0: gap to reach between surfaces that crossed
};

/// Two faces that cross or touch.
struct CrossingPair {
    int face = -1;      ///< of the cloth
    int obstacle = -1;  ///< index in the request; -1: `other` is a face of the cloth
    int other = -1;

    bool operator==(const CrossingPair&) const = default;
};

struct UntangleReport {
    int crossings_before = 0;        ///< pairs whose rule is Untangle
    std::vector<CrossingPair> left;  ///< of them and of new ones; by face, then the cloth first
    std::vector<int> still_inside;   ///< obstacles to untangle that enclose cloth which crosses no face
    int moves = 0;                   ///< that were made, including those taken back
    int moved_vertices = 0;
    double greatest_displacement = 0.0;  ///< m
    double greatest_strain = 0.0;  ///< greatest change of an edge's length, relative to its length before
};

/// Moves the cloth's vertices so that pairs of faces which cross or touch at the start come apart, and leaves
/// a gap of `thickness` between them where there is room. Each contour, a connected set of such pairs, takes
/// the shortest way out: the part of a surface that it cuts off moves back through the other surface, or the
/// contour slides out over a border (Volino and Magnenat-Thalmann 2006). The cloth around follows, so that
/// strain stays small.
///
/// Only elements on the two sides of a contour may meet on the way; all others are checked as in a step. So
/// no crossing arises elsewhere. Wires and points of obstacles have no sides: cloth that crosses one stays
/// there, and no move passes one.
///
/// A start without such pairs is left as it is, to the bit. Where a contour finds no way out the result is
/// the state with the fewest pairs. The number of moves is bounded. Positions stay finite. The result does
/// not depend on the number of threads.
UntangleReport untangle(const UntangleRequest& request, ClothMesh& mesh);

}  // namespace arris
