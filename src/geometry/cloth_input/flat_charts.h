// SPDX-License-Identifier: GPL-3.0-or-later
// Material coordinates of a flat mesh without UVs. A mesh in one plane is its own chart. Of a mesh whose
// pieces lie in different planes, such as layers, every piece is its own chart, and the charts are laid side
// by side.
#pragma once

#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// The chart of one piece: the u that it covers, m, and its first face.
struct FlatChart {
    int first_face;
    double least_u, greatest_u;
};

/// The charts of a flat mesh.
struct FlatCharts {
    std::vector<Vec2> material;     ///< m, one a vertex
    std::vector<FlatChart> pieces;  ///< laid side by side, in the order of their first vertices; empty for a
                                    ///< mesh in one plane
    int curved_at = -1;             ///< a vertex off the plane of its piece, which is curved; -1 without one
    double off_plane = 0.0;         ///< m, that vertex's distance from the plane
};

/// Lays out a mesh whose faces have area. Each chart is seen from the side on which its largest face is
/// counter-clockwise. u is along x if possible, so that a horizontal mesh keeps its x and y. Laid side by
/// side, the first chart stays, and each next one is moved along u alone: it begins a tenth of the widest
/// chart beyond the last.
FlatCharts lay_flat(const std::vector<Vec3>& world, const std::vector<Face>& faces);

}  // namespace arris
