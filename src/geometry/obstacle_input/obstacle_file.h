// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "geometry/obstacle/obstacle_mesh.h"
#include "geometry/obstacle_input/repair/vertex_origins.h"

namespace arris {

struct ObstacleFileRequest {
    std::string path;                       ///< .obj, .stl, .ply, .gltf, .glb, .dae, .fbx, .3mf or .3ds
    std::optional<double> metres_per_unit;  ///< overrides the unit that the file declares
    std::optional<char> up;                 ///< 'x', 'y' or 'z'; overrides the up axis that the file declares
    std::vector<std::string> importer;      ///< program (path) and arguments; ends in import_obstacle_command
    std::chrono::milliseconds timeout{120000};  ///< for the whole import
};

struct ObstacleFile {
    ObstacleMesh mesh;                  ///< m, +z up; passes `validate`
    VertexOrigins origins;              ///< of its points among the file's vertices
    std::vector<std::string> warnings;  ///< one sentence for each kind of repair, without the file's name
    std::vector<std::string> notes;     ///< one sentence for each legitimate finding worth knowing
};

/// Reads and repairs (see repair_soup) an obstacle's mesh from an untrusted file. A separate process,
/// `importer`, does the work, so that any failure of the import library ends in an InputError. That process
/// may use `timeout` of wall time, as much CPU time, and memory in proportion to the file's size. (Memory is
/// not limited under address sanitizers, which reserve all of it.) Its reply is checked before use.
///
/// Units and up axis, unless given, are those that the file declares (COLLADA, FBX, 3MF; glTF: metres, y up),
/// else metres and z. An up axis is turned to +z: y by (x, y, z) -> (x, -z, y), x by (-z, y, x). Coordinates
/// of texts and 3MF are double; others are single precision: a warning says where that matters. Polygons are
/// cut by triangulate_polygon; warnings count those that cross themselves, and those that are not flat.
///
/// Throws InputError, one line that begins with the path, for a file that cannot be used. It may be missing,
/// not regular, larger than 2 GB, of another format, damaged, or without usable geometry. Also throws where
/// the import crashed, was too slow or needed too much memory. Thread-safe.
ObstacleFile read_obstacle_file(const ObstacleFileRequest& request);

}  // namespace arris
