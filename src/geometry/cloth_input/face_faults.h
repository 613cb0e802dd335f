// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// Triangles of a cloth file between places (m). Vertices of equal place are one place, whatever their UVs
/// and their numbers in the file.
struct PlacedFaces {
    std::vector<Vec3> places;
    std::vector<int> numbers;  ///< number in the file, from 1, of the first vertex at each place
    std::vector<Face> faces;
    std::vector<Face> corners;  ///< number in the file of each corner's vertex
    std::vector<int> lines;     ///< line of each face in the file

    /// "the face of line 7 (at 1, 1, 0 m)".
    std::string describe(int face) const;
};

// Each function returns one sentence that names lines of the file and says what is allowed, or an empty
// string where nothing is wrong.

/// Faces given twice, in either orientation. Where their corners are different vertices of the file, two
/// layers of cloth coincide.
std::string find_doubled_face(const PlacedFaces& mesh);

/// An edge of more than two faces.
std::string find_branching_edge(const PlacedFaces& mesh);

/// Why triangles of a chart run in different directions in the material: some are turned over against their
/// neighbours, or the chart is folded. `turns` are the triangles' exact orientations, 1 or -1, both of which
/// occur in that chart; no edge may have more than two faces.
std::string explain_turns(const PlacedFaces& mesh, const std::vector<int>& turns);

}  // namespace arris
