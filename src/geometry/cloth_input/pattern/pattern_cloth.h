// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/cloth/piece_place.h"
#include "geometry/cloth_input/pattern/pattern_mesh.h"

namespace arris {

/// A panel in the plane of all material.
struct PlacedPanel {
    PiecePlace place;          ///< from the panel's own material, (u, v) or mirrored (-u, v), to the plane
    bool is_mirrored = false;  ///< whether its own material is (-u, v)
    double area = 0.0;         ///< m^2, of its faces
    int first_face = 0;
    int face_count = 0;

    /// The place in the plane of a point (u, v) of the pattern.
    Vec2 to_plane(const Vec2& uv) const { return place.to_plane({is_mirrored ? -uv.x() : uv.x(), uv.y()}); }
};

/// Points to be joined, from a seam's beginning to its end.
struct SeamPoints {
    std::vector<std::array<int, 2>> pairs;
    bool is_closed = false;  ///< whether each pair is one vertex
};

/// Points on all edges, or in all panels, with the same label.
struct LabelledPoints {
    std::string label;
    std::vector<int> points;  ///< ascending
};

/// A cloth of all panels.
struct PatternCloth {
    ClothMesh mesh;
    std::vector<PlacedPanel> panels;
    std::vector<SeamPoints> seams;                    ///< in the pattern's order
    std::vector<LabelledPoints> of_edges, of_panels;  ///< by label, ascending
};

/// Which seams a cloth is sewn at: in the world as placed, or all but ties, whose world positions are then
/// those of one side.
enum class Closing { WhereTouching, All };

/// Two points of a seam touch within this share of the edge length: closing then strains faces by 0.1 % at
/// most, and corners that a file rounds to three digits touch. Raising it sews what is meant to be apart.
inline constexpr double kSeamTouches = 1e-3;

/// Lays panels side by side along u, the first where it is, farther apart than four edge lengths and than the
/// largest panel; sews them at seams whose pairs all touch in the world. `meshes` is of this pattern and edge
/// length (m). Corners of several seams become one vertex.
PatternCloth join_panels(const SewingPattern& pattern, const PatternMesh& meshes, double edge_length,
                         Closing closing = Closing::WhereTouching);

}  // namespace arris
