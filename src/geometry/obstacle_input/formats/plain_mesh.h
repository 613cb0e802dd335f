// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// The shape in a file of a plain format (OBJ, STL, PLY), with the file's values in double precision. Indices
/// count from 0 and are in range.
struct PlainMesh {
    std::vector<Vec3> points;
    std::vector<int> lines;          ///< line of each point in the file; empty for a binary file
    std::vector<int> corners;        ///< points of all polygons, one polygon after the other
    std::vector<int> corner_counts;  ///< of each polygon, at least 3
    std::vector<std::array<int, 2>> segments;
    std::vector<int> lone_points;
    bool is_single = false;  ///< the file holds its coordinates in single precision
    std::vector<std::string> warnings;

    void add_polygon(const std::vector<int>& points_of_it)
    {
        corners.insert(corners.end(), points_of_it.begin(), points_of_it.end());
        corner_counts.push_back(static_cast<int>(points_of_it.size()));
    }
};

/// Whether files with this extension (lower case, without the dot) are read by read_plain_mesh.
bool is_plain_format(std::string_view extension);

/// Reads a file of a plain format. Throws InputError, without the file's name, and with line, vertex or face
/// where known (see read_obj, read_stl, read_ply). Also for a file without faces, lines or points, and for an
/// element with a point that is not finite.
PlainMesh read_plain_mesh(std::string_view extension, std::string_view bytes);

}  // namespace arris
