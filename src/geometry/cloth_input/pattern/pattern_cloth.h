// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/cloth/piece_place.h"
#include "geometry/cloth_input/pattern/pattern_mesh.h"

namespace arris {

/// A panel in the plane of all material.
struct PlacedPanel {
    PiecePlace place;   ///< from the pattern's (u, v) to the plane; named as the panel
    double area = 0.0;  ///< m^2, of its faces
    int first_face = 0;
    int face_count = 0;
};

/// Points to be joined, from a seam's beginning to its end.
struct SeamPoints {
    std::vector<std::array<int, 2>> pairs;
    bool is_closed = false;  ///< whether each pair is one vertex
};

/// All edges with the same label, in the plane of all material, m.
struct LabelledLines {
    std::string label;
    std::vector<std::array<Vec2, 2>> lines;
};

/// A cloth of all panels.
struct PatternCloth {
    ClothMesh mesh;
    std::vector<PlacedPanel> panels;
    std::vector<SeamPoints> seams;      ///< in the pattern's order
    std::vector<LabelledLines> labels;  ///< ascending
};

/// Which seams a cloth is sewn at: in the world as placed, or all but ties, whose world positions are then
/// those of one side.
enum class SewnSeams { WhereTouching, All };

/// Two points of a seam touch within this share of the edge length: closing then strains faces by 0.1 % at
/// most, and corners that a file rounds to three digits touch. Raising it sews what is meant to be apart.
inline constexpr double kSeamTouches = 1e-3;

/// Lays panels side by side along u, the first where it is, farther apart than four edge lengths and than the
/// largest panel; sews them at seams whose pairs all touch in the world. `meshes` is of this pattern and edge
/// length (m). Corners of several seams become one vertex.
PatternCloth join_panels(const SewingPattern& pattern, const PatternMesh& meshes, double edge_length,
                         SewnSeams sewn = SewnSeams::WhereTouching);

}  // namespace arris
