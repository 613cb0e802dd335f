// SPDX-License-Identifier: GPL-3.0-or-later
// Cloths that cross themselves or an obstacle, 2 cm a cell.
#pragma once

#include <functional>
#include <vector>

#include "geometry/cloth_input/cloth_grid.h"
#include "geometry/untangle/untangle.h"

namespace arris::samples {

inline constexpr double kTangleThickness = 1e-3;  // m

/// Pieces of cloth in one mesh.
struct TangledCloth {
    ClothMesh mesh;
    std::vector<int> first_face;  ///< of each piece

    /// Adds a rectangle, m, with places in the world.
    void add(const Vec2& size, const std::function<Vec3(const Vec2&)>& place,
             GridPattern pattern = GridPattern::Alternating);

    /// The faces of a piece.
    std::vector<Face> piece(int index) const;
};

/// The corner of a sheet (piece 0) is bent up, and pokes through a sheet above (piece 1).
TangledCloth corner_through_sheet();

/// The crest of a fold (piece 0) pokes 1 cm up through a sheet (piece 1).
TangledCloth fold_through_sheet();

/// The rim of a thin tube (piece 1) dips into the wall of a wide one (piece 0), from outside.
TangledCloth tube_into_tube();

/// Two sheets overlap by 6 cm, tilted against each other about a line of the overlap.
TangledCloth crossed_borders();

/// A strip (piece 0) of 4 cm passes straight through a sheet (piece 1) by 3 cm. The contour has one length,
/// wherever along the strip it is.
TangledCloth strip_through_sheet();

/// Two panels in one plane overlap by a sliver of 6 mm.
TangledCloth coplanar_sliver();

/// A sheet lies `depth` (m) below the tops of the shapes below, which have their centres at the origin.
TangledCloth dipped_sheet(double top, double depth);

StartObstacle ball_of_15_cm();  ///< radius
StartObstacle cube_of_20_cm();

/// Asks to untangle the cloth with itself.
UntangleRequest self_request(std::vector<int> held = {});

/// Least distance of two parts of the cloth, from all pairs of their elements.
double least_gap(const std::vector<Vec3>& positions, const std::vector<Face>& first,
                 const std::vector<Face>& second);

}  // namespace arris::samples
